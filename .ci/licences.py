#!/usr/bin/env python3
"""Prints the licences of the crates that are compiled into a package of the workspace for a target, each text once.

    python3 .ci/licences.py apportion-web wasm32-unknown-unknown > assets/web/LICENCES.txt
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HEAD = """Works of others that are compiled in, and their licences: the Rust standard library (MIT OR Apache-2.0,
https://github.com/rust-lang/rust), and these crates."""
NAMES = ("licen", "copying", "copyright", "notice")


def output(*command):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, cwd=ROOT).stdout


def texts(package):
    """The files of a crate about its licence; of a choice with MIT, that of MIT."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name.lower().startswith(NAMES))
    others = [path for path in files if "apache" not in path.name.lower()]
    files = others if "MIT" in package["license"] and others else files
    return [path.read_text(encoding="utf-8").strip() for path in files]


def licences(package, target):
    tree = output("cargo", "tree", "--locked", "-p", package, "-e", "normal", "--prefix", "none", "--target", target, "-f", "{p}")
    linked = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    metadata = json.loads(output("cargo", "metadata", "--locked", "--format-version", "1"))
    crates_of = {}
    for package in sorted(metadata["packages"], key=lambda package: package["name"]):
        if package["source"] and (package["name"], "v" + package["version"]) in linked:
            crate = f"{package['name']} {package['version']} ({package['license']}), {package['repository']}"
            for text in texts(package) or ["(the crate has no text of its licence)"]:
                # The same but for line breaks.
                crates_of.setdefault(" ".join(text.split()), (text, []))[1].append(crate)
    parts = ["\n".join(crates) + "\n\n" + text for text, crates in crates_of.values()]
    return f"\n\n{'-' * 80}\n\n".join([HEAD, *parts]) + "\n"


if __name__ == "__main__":
    sys.stdout.write(licences(*sys.argv[1:]))
