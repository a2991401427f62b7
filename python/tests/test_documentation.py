"""What the README, the pages of the book and the README of this package show of Python, runs.

The comments above blocks are those of `tests/documents/book.rs`, which runs everything else on the pages.
"""

import re
from pathlib import Path

import pytest

import apportion as ap

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "python/README.md").read_text(encoding="utf-8")
BLOCK = re.compile(
    r"(?:^<!-- (?P<comment>[^\n]*) -->\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE
)


def blocks(page):
    return [found.groupdict(default="") for found in BLOCK.finditer(page.read_text(encoding="utf-8"))]


def is_script(block):
    return block["language"] == "python" and not block["comment"]


PAGES = [ROOT / "README.md", ROOT / "python/README.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES = [page for page in PAGES if any(map(is_script, blocks(page)))]


def is_shown(shown, printed):
    """A line `...` stands for any lines, `[..]` in a line for anything."""
    parts = []
    for line in shown.splitlines():
        parts.append(r"(?:.*\n)*?" if line == "..." else re.escape(line.rstrip()).replace(r"\[\.\.\]", ".*") + r"[ ]*\n")
    return re.fullmatch("".join(parts), printed) is not None


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "studies").symlink_to(ROOT / "studies")
    names: dict = {"__name__": "__main__"}
    printed = None
    for block in blocks(page):
        if block["comment"].startswith("file: "):
            (tmp_path / block["comment"].removeprefix("file: ")).write_text(block["text"], encoding="utf-8")
        elif is_script(block):
            try:
                exec(compile(block["text"], page.name, "exec"), names)
            except ModuleNotFoundError as missing:
                pytest.skip(str(missing))
            printed = capsys.readouterr().out
        elif block["comment"] == "output" and printed is not None:
            assert is_shown(block["text"], printed), f"shown:\n{block['text']}\nprinted:\n{printed}"
        else:
            printed = None


def test_the_first_example_of_the_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = re.findall("```python\n(.*?)```", README, re.DOTALL)[0]
    names: dict = {}
    exec(compile(code, "README.md", "exec"), names)
    assert (tmp_path / "folder" / "study.html").is_file()
    assert abs(names["result"].total["x1"].estimate - 0.5576) < 2e-3


def test_every_name_of_the_pages_exists():
    code = "".join(block["text"] for page in PAGES for block in blocks(page) if block["language"] == "python")
    code += "".join(re.findall("`([^`]+)`", README))
    for name in set(re.findall(r"\bap\.(\w+)", code)):
        assert hasattr(ap, name), name
    for name in re.search(r"## Distributions\n\n(.*?);", README, re.DOTALL).group(1).replace("`", "").split(","):
        assert name.strip() in ap.__all__, name
    assert all(hasattr(ap, name) for name in ap.__all__)
    assert all(getattr(ap, name).__doc__ for name in ap.__all__ if callable(getattr(ap, name)))
