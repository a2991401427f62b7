"""Runs SALib's own tests on `apportion.salib`: python salib_suite.py FOLDER, the folder of SALib's sources.

What the package has comes from it, all else from SALib itself, which must be installed. `salib_suite.txt` lists the tests that do not
pass, with the reason of each: another one that fails is an error, and so is one of them that passes.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

LISTED = Path(__file__).with_suffix(".txt")
# Of SALib's command line, and of methods that the package refuses.
NOT_OURS = ("test_cli*", "test_hdmr.py", "test_discrepancy.py", "test_ff.py", "test_analyze_delta.py", "test_analyze_fast.py", "test_analyze_pawn.py")
IMPORT = re.compile(r"^( *)from SALib([.\w]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)


def redirected(found):
    """An import of several names of SALib, each from the package if it has it."""
    indent, module, names = found.groups()
    lines = []
    for name in re.sub(r"#.*", "", names).strip("()").replace("\n", " ").split(","):
        if name.strip():
            ours, theirs = (f"from {package}{module} import {name.strip()}" for package in ("apportion.salib", "SALib"))
            lines += ["try:", f"    {ours}", "except ImportError:", f"    {theirs}"]
    return "\n".join(indent + line for line in lines)


def failed(sources):
    """The tests that fail, and how many there are."""
    with tempfile.TemporaryDirectory() as folder:
        tests, report = Path(folder, "tests"), Path(folder, "report.xml")
        shutil.copytree(sources / "tests", tests, ignore=shutil.ignore_patterns(*NOT_OURS))
        for test in tests.rglob("*.py"):
            test.write_text(IMPORT.sub(redirected, test.read_text(encoding="utf-8")), encoding="utf-8")
        command = [sys.executable, "-m", "pytest", "-q", "-W", "ignore", "-p", "no:cacheprovider", f"--rootdir={folder}", f"--junitxml={report}", "--tb=line", tests]
        # They read files of the sources.
        subprocess.run(command, cwd=sources, env={**os.environ, "MPLBACKEND": "Agg"})
        cases = list(xml.parse(report).getroot().iter("testcase"))
    names = {f"{case.get('classname').removeprefix('tests.')}.{case.get('name')}": case for case in cases}
    return {name for name, case in names.items() if case.find("failure") is not None or case.find("error") is not None}, len(names)


def main():
    lines = [line.split(maxsplit=1)[0] for line in LISTED.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    found, count = failed(Path(sys.argv[1]))
    print(f"{count - len(found)} of {count} tests pass, {len(lines)} are listed as others")
    new, gone = sorted(found - set(lines)), sorted(set(lines) - found)
    print("\n".join([f"fails: {name}" for name in new] + [f"passes, and is listed: {name}" for name in gone]))
    sys.exit(bool(new or gone))


if __name__ == "__main__":
    main()
