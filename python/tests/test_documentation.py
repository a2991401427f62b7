"""What the README shows, runs."""

import re
from pathlib import Path

import apportion as ap

README = (Path(__file__).resolve().parents[1] / "README.md").read_text(encoding="utf-8")


def test_the_first_example_of_the_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = re.findall("```python\n(.*?)```", README, re.DOTALL)[0]
    names: dict = {}
    exec(compile(code, "README.md", "exec"), names)
    assert (tmp_path / "folder" / "study.html").is_file()
    assert abs(names["result"].total["x1"].estimate - 0.5576) < 2e-3


def test_every_name_of_the_readme_is_there():
    code = "".join(re.findall("```python\n(.*?)```", README, re.DOTALL)) + "".join(re.findall("`([^`]+)`", README))
    for name in set(re.findall(r"\bap\.(\w+)", code)):
        assert hasattr(ap, name), name
    for name in re.search(r"## Distributions\n\n(.*?);", README, re.DOTALL).group(1).replace("`", "").split(","):
        assert name.strip() in ap.__all__, name
    assert all(hasattr(ap, name) for name in ap.__all__)
    assert all(getattr(ap, name).__doc__ for name in ap.__all__ if callable(getattr(ap, name)))
