"""Results: as text, as a page, as tables and charts."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from . import _engine
from ._indices import Index, Indices, OutputResult, SeriesResult, needed


class Document:
    """A result: as text, as a page, as charts and as the JSON with all numbers."""

    def __init__(self, document: _engine.Document):
        self._document = document
        self._parsed: dict[str, Any] | None = None

    def __repr__(self) -> str:
        return self._document.text()

    def _repr_html_(self) -> str:
        lead = "".join(f"<p>{html.escape(line)}</p>" for line in self._document.lead)
        charts = self._document.charts()
        return f"<div>{lead}{self._table_html()}{charts[0][1] if charts else ''}</div>"

    def __reduce__(self) -> Any:
        raise TypeError("only results of runs can be pickled: use to_json() or save() for this one")

    def __copy__(self) -> "Document":
        return type(self)(self._document)

    def __deepcopy__(self, memo: Any) -> "Document":
        return type(self)(self._document)

    def _table_html(self) -> str:
        """The indices as a table; only results of runs have one."""
        return ""

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        return {"text/plain": repr(self), "text/html": self._repr_html_()}

    @property
    def lead(self) -> list[str]:
        """The main result, in sentences."""
        return self._document.lead

    def to_json(self) -> str:
        """The JSON that the program writes; its format is described in the documentation of the program."""
        return self._document.json()

    def to_dict(self) -> dict[str, Any]:
        """The same, parsed."""
        if self._parsed is None:
            self._parsed = json.loads(self._document.json())
        return self._parsed

    def to_html(self) -> str:
        """The whole page, without external files."""
        return self._document.html()

    def charts(self) -> dict[str, str]:
        """The charts of the page as SVG, by their titles."""
        return dict(self._document.charts())

    def tables(self) -> dict[str, list[dict[str, str]]]:
        """The tables that the program writes as CSV, by their names: a dict for each row."""
        files = self._document.tables()
        return {Path(name).stem: list(csv.DictReader(io.StringIO(text))) for name, text in files if name.endswith(".csv")}

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Writes the page, JSON, CSV and charts to `folder`, and returns the path of the page."""
        return Path(self._document.save(os.fspath(folder)))


# Tables, and rows of each, that stand in a notebook.
_TABLES, _ROWS = 4, 30


def _words(index: Index) -> str:
    bounds = "" if np.isnan(index.low) else f" [{index.low:.4f}, {index.high:.4f}]"
    return f"{index.estimate:.4f}{bounds}"


class Result(Document):
    """The indices of a study, with their intervals.

    `first_order`, `total` and so on are those of the only output; with several, `result["name"]` is one of them.
    """

    @property
    def outputs(self) -> dict[str, OutputResult]:
        """Every output, by name."""
        return {record["name"]: OutputResult(record) for record in self.to_dict()["outputs"]}

    @property
    def series(self) -> dict[str, SeriesResult]:
        """The outputs that are series, by name; their values are `outputs` as well."""
        outputs = list(self.outputs.values())
        records = self.to_dict().get("series", [])
        ends = [(record["first_output"], record["first_output"] + len(record["positions"])) for record in records]
        return {of["name"]: SeriesResult(of, outputs[first:end]) for of, (first, end) in zip(records, ends)}

    def __getitem__(self, output: str) -> OutputResult:
        outputs = self.outputs
        if output not in outputs:
            raise KeyError(f"{output!r}: the outputs are {', '.join(outputs)}")
        return outputs[output]

    def __iter__(self) -> Iterator[str]:
        """The names of the outputs."""
        return iter(self.outputs)

    def __len__(self) -> int:
        """The number of outputs."""
        return len(self.outputs)

    def __contains__(self, output: object) -> bool:
        return output in self.outputs

    def __reduce__(self) -> Any:
        return _from_json, (self.to_json(),)

    def _table_html(self) -> str:
        columns = {"first-order": "first_order", "total": "total", "Shapley effect": "shapley"}
        tables = []
        for output in list(self.outputs.values())[:_TABLES]:
            shown = {label: getattr(output, kind) for label, kind in columns.items() if len(getattr(output, kind))}
            if not shown:
                continue
            names = sorted(output.total, key=lambda name: -output.total[name].estimate)[:_ROWS]
            head = "".join(f"<th>{label}</th>" for label in shown)
            rows = (
                f"<tr><th>{html.escape(name)}</th>{''.join(f'<td>{_words(of[name])}</td>' for of in shown.values())}</tr>"
                for name in names
            )
            caption = f"<caption>{html.escape(output.name)}, with 95 % intervals</caption>"
            tables.append(f"<table>{caption}<tr><th></th>{head}</tr>{''.join(rows)}</table>")
        return "".join(tables)

    def _only(self) -> OutputResult:
        outputs = self.outputs
        if len(outputs) != 1:
            raise ValueError(f"there are several outputs: choose one, as in result[{next(iter(outputs))!r}]")
        return next(iter(outputs.values()))

    @property
    def first_order(self) -> Indices:
        """First-order indices S of the factors."""
        return self._only().first_order

    @property
    def total(self) -> Indices:
        """Total indices ST of the factors."""
        return self._only().total

    @property
    def shapley(self) -> Indices:
        """Shapley effects of the factors: shares of the variance that sum to 1 even where factors depend on each other. There are
        some with `shapley=True` (of up to 8 factors from all subsets, of up to 100 along random permutations), and by default of up
        to 4 factors that depend on each other."""
        return self._only().shapley

    @property
    def measures(self) -> dict[str, Indices]:
        """Other measures than Sobol' indices by their names, with `measures=["delta", "pawn_median", ...]`."""
        return self._only().measures

    @property
    def shapley_groups(self) -> Indices:
        """Shapley effects of the groups, and of the factors that have none, with `shapley_players="groups"`: they sum to 1."""
        return self._only().shapley_groups

    @property
    def second_order(self) -> Indices:
        """Second-order indices by pairs of factors."""
        return self._only().second_order

    def groups(self, kind: str = "total") -> Indices:
        """Joint indices of the groups."""
        return self._only().groups(kind)

    def subsets(self, kind: str = "first_order") -> Indices:
        """Joint indices of the subsets asked for."""
        return self._only().subsets(kind)

    @property
    def runs(self) -> int:
        """Model runs."""
        return self.to_dict()["provenance"]["model_runs"]

    @property
    def wall_seconds(self) -> float:
        """Time that the runs took."""
        return self.to_dict()["provenance"]["wall_seconds"]

    @property
    def warnings(self) -> list[str]:
        """What a careful reader should know, of all outputs."""
        return [warning for output in self.outputs.values() for warning in output.warnings]

    def to_frame(self) -> Any:
        """A row per factor, and per output if there are several, as a `pandas.DataFrame`."""
        outputs = self.outputs
        frames = {name: output.to_frame() for name, output in outputs.items()}
        if len(frames) == 1:
            return next(iter(frames.values()))
        return needed("pandas", "to_frame").concat(frames, names=["output"])

    def to_xarray(self) -> Any:
        """The indices as an `xarray.Dataset` over output, factor and bound (estimate, low, high), NaN for outputs
        that have none."""
        xarray = needed("xarray", "to_xarray")
        outputs = list(self.outputs.values())
        factors = next((output.first_order.names for output in outputs if len(output.first_order)), [])
        none = Index.of(None)
        data = {}
        for kind in ("first_order", "total"):
            rows = [[getattr(output, kind).get(name, none) for name in factors] for output in outputs]
            data[kind] = ("output", "factor", "bound"), np.array(rows, dtype=float).reshape(len(outputs), len(factors), 3)
        coordinates = {
            "output": [output.name for output in outputs],
            "factor": factors,
            "bound": ["estimate", "low", "high"],
        }
        return xarray.Dataset(data, coordinates)

    def plot(self, output: str | None = None, ax: Any = None) -> Any:
        """Bars of first-order and total indices with their intervals, on `ax` of matplotlib; returns the axes."""
        return (self._only() if output is None else self[output]).plot(ax)


def load_result(path: str | os.PathLike[str]) -> Result:
    """The result of a JSON file that `save` or the program has written."""
    return _from_json(Path(path).read_text(encoding="utf-8"))


def _from_json(text: str) -> Result:
    return Result(_engine.read_result(text))
