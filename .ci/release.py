#!/usr/bin/env python3
"""Makes the files of a release in the folder `dist`, and tries them (RELEASING.md; `just release` does all of it for this system).

    python3 .ci/release.py check [--tag v0.1.0]   one version everywhere, a section of CHANGELOG.md, nothing uncommitted
    python3 .ci/release.py program [TARGET]       the program with licences and completions, as .tar.gz or .zip
    python3 .ci/release.py wheel [TARGET]         the Python package
    python3 .ci/release.py try [--python PYTHON]  what `dist` has for this system: installed in fresh places, and run there
    python3 .ci/release.py finish                 SBOM of the crates, notes, SHA256SUMS

TARGET is a target of rustc, by default that of this system. Programs and wheels of Linux are linked by zig: they run on glibc 2.17
(manylinux2014) or on musl 1.2, wherever they were built. maturin, zig and auditwheel come from PyPI, into an environment of their own.
"""

import argparse
import gzip
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import venv
import zipfile
from pathlib import Path

from licences import licences

ROOT = Path(__file__).resolve().parent.parent
DIST = ROOT / "dist"
TARGET_DIR = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
TOOLS = ["maturin>=1.9,<2", "ziglang>=0.13", "cargo-zigbuild>=0.20"]
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
GLIBC = 17
WINDOWS = os.name == "nt"


def run(*command, **options):
    print("+", *command, file=sys.stderr)
    return subprocess.run([str(part) for part in command], check=True, text=True, **options)


def output(*command, **options):
    return run(*command, stdout=subprocess.PIPE, **options).stdout


def host():
    return re.search(r"^host: (.*)$", output("rustc", "-vV"), re.MULTILINE).group(1)


def environment_at(folder, packages):
    """A new Python environment with the packages; its folder of programs."""
    scripts = folder / ("Scripts" if WINDOWS else "bin")
    if not scripts.exists():
        venv.create(folder, with_pip=True)
    run(scripts / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages)
    return scripts


def builder(target):
    """The environment of a build, after a look at what it needs."""
    if shutil.which("rustup") and target not in output("rustup", "target", "list", "--installed").split():
        sys.exit(f"the standard library of {target} is missing: rustup target add {target}")
    scripts = environment_at(TARGET_DIR / "release-tools", TOOLS)
    home = os.environ.get("CARGO_HOME", Path.home() / ".cargo")
    return {
        **os.environ,
        "PATH": os.pathsep.join([str(scripts), os.environ["PATH"]]),
        "RUSTFLAGS": f"--remap-path-prefix={ROOT}=. --remap-path-prefix={home}=cargo",
        "SOURCE_DATE_EPOCH": commit_time(),
    }


def commit_time():
    return output("git", "log", "-1", "--format=%ct", cwd=ROOT).strip()


def check(tag):
    said = {
        "CITATION.cff": re.search(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE).group(1),
        "codemeta.json": json.loads((ROOT / "codemeta.json").read_text(encoding="utf-8"))["version"],
        "CHANGELOG.md": VERSION if notes() else "no section",
        "the tag": tag.removeprefix("v") if tag else VERSION,
    }
    wrong = [f"Cargo.toml has version {VERSION}, {place} {version}" for place, version in said.items() if version != VERSION]
    if output("git", "status", "--porcelain", cwd=ROOT):
        wrong.append("there are uncommitted changes")
    run("cargo", "metadata", "--locked", "--format-version", "1", "--no-deps", cwd=ROOT, stdout=subprocess.DEVNULL)
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"version {VERSION} everywhere")


def notes():
    """The section of this version in CHANGELOG.md, without its heading and relative links."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    section = re.search(rf"^## {re.escape(VERSION)}\b[^\n]*\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    return re.sub(r"\[([^\]]*)\]\((?!https?:)[^)]*\)", r"\1", section.group(1)).strip() + "\n" if section else ""


def program(target):
    environment = builder(target)
    build = ["cargo", "build"] if "linux" not in target else ["cargo", "zigbuild"]
    linked = f"{target}.2.{GLIBC}" if target.endswith("linux-gnu") else target
    run(*build, "--locked", "--profile", "dist", "-p", "apportion-cli", "--bin", "apportion", "--target", linked, cwd=ROOT, env=environment)
    name = "apportion.exe" if "windows" in target else "apportion"
    built = TARGET_DIR / target / "dist" / name
    folder = f"apportion-{VERSION}-{target}"
    files = {name: built, "README.md": ROOT / "README.md", "CHANGELOG.md": ROOT / "CHANGELOG.md"}
    files |= {f"licenses/{path.name}": path for path in sorted((ROOT / "python/licenses").iterdir()) if path.is_symlink()}
    DIST.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        files["licenses/OTHERS.txt"] = Path(scratch) / "others"
        files["licenses/OTHERS.txt"].write_text(licences("apportion-cli", target), encoding="utf-8")
        for shell in ("bash", "zsh", "fish", "powershell"):
            path = Path(scratch) / shell
            try:
                path.write_text(output(built, "completions", shell), encoding="utf-8")
            except OSError as error:
                print(f"no completions: this system does not run {target}: {error}", file=sys.stderr)
                break
            files[f"completions/apportion.{shell}"] = path
        archive = DIST / (folder + (".zip" if "windows" in target else ".tar.gz"))
        pack(archive, folder, files)
    print(f"wrote {archive.relative_to(ROOT)}, {archive.stat().st_size} bytes")


def pack(archive, folder, files):
    if archive.suffix == ".zip":
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
            for name, path in files.items():
                packed.write(path, f"{folder}/{name}")
        return

    time = int(commit_time())

    def plain(entry):
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = ""
        entry.mtime = time
        entry.mode = 0o755 if entry.name.endswith("/apportion") else 0o644
        return entry

    with gzip.GzipFile(archive, "wb", mtime=time) as compressed, tarfile.open(fileobj=compressed, mode="w") as packed:
        for name, path in files.items():
            packed.add(path.resolve(), f"{folder}/{name}", filter=plain)


def wheel(target):
    options = []
    if "linux" in target:
        options = ["--zig", "--compatibility", "manylinux2014" if target.endswith("gnu") else "musllinux_1_2"]
    # Git ignores it.
    (ROOT / "python/licenses/OTHERS.txt").write_text(licences("apportion-python", target), encoding="utf-8")
    run("maturin", "build", "--profile", "dist", "--locked", "--manifest-path", "python/Cargo.toml", "--out", DIST, "--target", target,
        *options, cwd=ROOT, env=builder(target))  # fmt: skip


def is_of_this_system(name):
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    if name.endswith(".whl"):
        name = name.replace("win_amd64", "windows_x86_64").replace("macosx", "darwin").replace("arm64", "aarch64")
        system = {"Linux": "manylinux" if platform.libc_ver()[0] == "glibc" else "musllinux"}.get(platform.system())
    else:
        system = {"Linux": "linux-gnu" if platform.libc_ver()[0] == "glibc" else "linux-musl"}.get(platform.system())
    return machine in name and (system or platform.system().lower()) in name


def try_all(python):
    tried = [path for path in sorted(DIST.glob("apportion-*")) if is_of_this_system(path.name)]
    if not tried:
        sys.exit("nothing in `dist` is of this system")
    for path in tried:
        with tempfile.TemporaryDirectory() as scratch:
            (try_wheel if path.suffix == ".whl" else try_program)(path, Path(scratch), python)
        print(f"tried {path.name}")


def try_program(path, scratch, _):
    shutil.unpack_archive(path, scratch)
    (folder,) = scratch.iterdir()
    assert "Permission is hereby granted" in (folder / "licenses/OTHERS.txt").read_text(encoding="utf-8")
    binary = folder / ("apportion.exe" if WINDOWS else "apportion")
    needed = [int(minor) for minor in re.findall(rb"GLIBC_2\.(\d+)", binary.read_bytes())]
    if max(needed, default=0) > GLIBC:
        sys.exit(f"{path.name} needs glibc 2.{max(needed)}, 2.{GLIBC} is promised")
    bare = {key: value for key, value in os.environ.items() if key in ("SYSTEMROOT", "TEMP", "TMP")}
    assert output(binary, "--version", env=bare).split() == ["apportion", VERSION]
    run(binary, "run", ROOT / "studies/ishigami.toml", "--base-samples", "1024", "--out", "out", cwd=scratch, env=bare, stdout=subprocess.DEVNULL)
    result = json.loads((scratch / "out/ishigami.json").read_text(encoding="utf-8"))
    assert result["provenance"]["apportion_version"] == VERSION
    assert (scratch / "out/ishigami.html").exists()


TRIAL = """
import apportion as ap, numpy as np
factors = {name: (-np.pi, np.pi) for name in ("x1", "x2", "x3")}
result = ap.analyse(lambda x1, x2, x3: np.sin(x1) + 7 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1), factors, base_samples=1024)
assert abs(result.total["x1"].estimate - 0.5576) < 1e-3, result.total
"""


def try_wheel(path, scratch, python):
    if "linux" in path.name:
        scripts = environment_at(TARGET_DIR / "auditwheel", ["auditwheel>=6"])
        shown = output(scripts / "python", "-m", "auditwheel", "show", path)
        print(shown)
        fits = re.search(r'platform\s+tag:\s+"(?:manylinux_2_(\d+)|musllinux)', shown)
        if not fits or int(fits[1] or 0) > GLIBC:
            sys.exit(f"{path.name} needs a newer system than manylinux2014, which is promised")
    run(python, "-m", "venv", scratch / "fresh")
    fresh = scratch / "fresh" / ("Scripts" if WINDOWS else "bin") / "python"
    run(fresh, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", path)
    run(fresh, "-c", TRIAL, cwd=scratch)
    assert list(scratch.glob("fresh/**/apportion-*.dist-info/licenses/**/OTHERS.txt")), f"{path.name} has no licences of others"


def sbom():
    """The crates in the program and in the package for Python, in CycloneDX."""
    metadata = json.loads(output("cargo", "metadata", "--locked", "--format-version", "1", cwd=ROOT))
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    packages = {package["id"]: package for package in metadata["packages"]}
    lock = tomllib.loads((ROOT / "Cargo.lock").read_text(encoding="utf-8"))["package"]
    checksums = {(entry["name"], entry["version"]): entry.get("checksum") for entry in lock}

    def linked(node):
        return [dependency["pkg"] for dependency in node["deps"] if any(kind["kind"] is None for kind in dependency["dep_kinds"])]

    waiting = [key for key, package in packages.items() if package["name"] in ("apportion-cli", "apportion-python")]
    reached = set()
    while waiting:
        key = waiting.pop()
        if key not in reached:
            reached.add(key)
            waiting += linked(nodes[key])

    def reference(key):
        return f"pkg:cargo/{packages[key]['name']}@{packages[key]['version']}"

    components = []
    for key in sorted(reached, key=reference):
        package = packages[key]
        component = {"type": "library", "name": package["name"], "version": package["version"], "bom-ref": reference(key), "purl": reference(key)}
        if package["license"]:
            component["licenses"] = [{"expression": package["license"].replace("/", " OR ")}]
        if checksum := checksums[package["name"], package["version"]]:
            component["hashes"] = [{"alg": "SHA-256", "content": checksum}]
        components.append(component)
    dependencies = [{"ref": reference(key), "dependsOn": sorted(map(reference, linked(nodes[key])))} for key in sorted(reached, key=reference)]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "name": "apportion", "version": VERSION}},
        "components": components,
        "dependencies": dependencies,
    }


def finish():
    DIST.mkdir(exist_ok=True)
    (DIST / f"apportion-{VERSION}.cdx.json").write_text(json.dumps(sbom(), indent=1) + "\n", encoding="utf-8")
    (DIST / "NOTES.md").write_text(notes(), encoding="utf-8")
    files = [path for path in sorted(DIST.iterdir()) if path.name not in ("NOTES.md", "SHA256SUMS")]
    sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files)
    (DIST / "SHA256SUMS").write_text(sums, encoding="utf-8", newline="\n")
    print(sums, end="")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("check").add_argument("--tag")
    for name in ("program", "wheel"):
        commands.add_parser(name).add_argument("target", nargs="?")
    commands.add_parser("try").add_argument("--python", default=sys.executable)
    commands.add_parser("finish")
    options = parser.parse_args()
    match options.command:
        case "check":
            check(options.tag)
        case "program":
            program(options.target or host())
        case "wheel":
            wheel(options.target or host())
        case "try":
            try_all(options.python)
        case "finish":
            finish()


if __name__ == "__main__":
    main()
