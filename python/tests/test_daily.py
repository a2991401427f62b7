"""Scripts of daily tasks, each run as a user runs it."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = sorted((Path(__file__).parent / "daily").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_daily_task(script):
    for package in ("scipy", "pandas", "matplotlib"):
        pytest.importorskip(package)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr


def test_there_are_ten():
    assert len(SCRIPTS) == 10
