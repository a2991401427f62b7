"""Checks that a folder holds everything `apportion reproduce` promises, and that every file parses."""

import csv
import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

folder = Path(sys.argv[1])
frictions = ["coulomb", "hk", "lugre"]
groups = {"dimensional": 4, "environmental": 4, "general": 8}


def no_constant(name):
    raise ValueError(f"{name} is not JSON")


for group, factors in groups.items():
    for friction in frictions:
        path = folder / f"{friction}-{group}.json"
        result = json.loads(path.read_text(), parse_constant=no_constant)
        assert (result["format"], result["version"]) == ("apportion-result", 1), path
        assert len(result["factors"]) == factors, path
        (output,) = result["outputs"]
        assert output["runs_failed"] == 0, path
        assert len(output["indices"]) == factors, path
        for share in ("share_first_order", "share_total"):
            assert abs(sum(index[share] for index in output["indices"]) - 100) < 1e-6, path
        assert len(output["groups"]) == (2 if group == "general" else 0), path

figures = sorted((folder / "charts").glob("*.svg"))
assert len(figures) == 33, [figure.stem for figure in figures]
for figure in figures:
    assert ElementTree.parse(figure).getroot().tag.endswith("svg"), figure
    png = figure.with_suffix(".png").read_bytes()
    assert png.startswith(b"\x89PNG\r\n\x1a\n") and len(png) > 10_000, figure

for name, rows in {"claims": 25, "percentages": 4 * 4 * 16}.items():
    with open(folder / f"{name}.csv", newline="") as file:
        assert len(list(csv.DictReader(file))) == rows, name
json.loads((folder / "claims.json").read_text(), parse_constant=no_constant)
assert "<h1>" in (folder / "index.html").read_text()

with open(folder / "shares.csv", newline="") as file:
    rows = list(csv.DictReader(file))
assert len(rows) == 3 * sum(groups.values()), len(rows)
assert {row["published"] for row in rows if row["published"]} == {"76", "74", "26", "80", "12", "5", "3"}
print(f"{folder}: 9 results, {len(figures)} figures, {len(rows)} shares, claims and percentages: all there, all parse")
