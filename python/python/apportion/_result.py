"""Results: as text, as a page, as tables and charts."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np

from . import _engine
from ._indices import Index, Indices, OutputResult, SeriesResult, Shown, WithIndices, axes, bars, dataset, needed, together
from ._warnings import warn

_Document = TypeVar("_Document", bound="Document")
# Outputs whose indices stand in a notebook.
_OUTPUTS = 4
# Columns of text, whatever their content.
_TEXTS = ("output", "factor", "input", "unit", "output_unit", "failure")
# What is shown of screenings and of given data, by the columns of their tables.
_SHOWN = {"mu_star": "mu*", "sigma": "sigma", "first_order": "S_1", "surrogate_total": "S_T"}


class Document(Shown):
    """A result: as text, as a page, as charts and as the JSON with all numbers."""

    def __init__(self, document: _engine.Document):
        self._document = document
        self._parsed: dict[str, Any] | None = None

    def __repr__(self) -> str:
        return self._document.text()

    def _repr_html_(self) -> str:
        lead = "".join(f"<p>{html.escape(line)}</p>" for line in self._document.lead)
        charts = self._document.charts()
        return f"<div>{lead}{super()._repr_html_()}{charts[0][1] if charts else ''}</div>"

    def __reduce__(self) -> Any:
        return _of_json, (type(self), self.to_json(), self._document.name)

    def __copy__(self) -> "Document":
        return type(self)(self._document)

    def __deepcopy__(self, memo: Any) -> "Document":
        return type(self)(self._document)

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

    def to_frame(self) -> Any:
        """The tables as one `pandas.DataFrame`: a row per output and factor, or of a sweep per factor, value and output."""
        pandas = needed("pandas", "to_frame")
        frames = []
        for rows in self.tables().values():
            columns = {"factor" if key == "input" else key: _typed(key, [row[key] for row in rows]) for key in rows[0]}
            frame = pandas.DataFrame(columns)
            frames.append(frame.set_index(["factor", "value", "output"] if "value" in frame else ["output", "factor"]))
        return pandas.concat(frames, axis=1)

    def plot(self, output: str | None = None, ax: Any = None) -> Any:  # type: ignore[override]
        """Bars of the indices of an output with their intervals, or of a sweep lines of it from the least to the greatest value of
        each factor, on `ax` of matplotlib; returns the axes."""
        tables = self._tables()
        output = _chosen(output, tables)
        if tables[output]:
            return bars(ax, output, tables[output])
        curves: dict[str, list[float]] = {}
        for row in next(iter(self.tables().values())):
            if row["output"] == output:
                curves.setdefault(row["factor"], []).append(float(row["output_value"] or "nan"))
        ax = axes(ax, (6.0, 3.6))
        for factor, curve in curves.items():
            ax.plot(np.linspace(0, 1, len(curve)), curve, label=factor)
        ax.set(xlabel="factors, from the least value to the greatest", ylabel=output)
        ax.legend()
        return ax

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        tables: dict[str, dict[str, dict[str, Index]]] = {}
        for row in (row for rows in self.tables().values() for row in rows):
            of = tables.setdefault(row["output"], {})
            for key, label in _SHOWN.items():
                if f"{key}_low" in row:
                    index = Index(*(float(row[column] or "nan") for column in (key, f"{key}_low", f"{key}_high")))
                    of.setdefault(label, {})[row.get("factor") or row["input"]] = index
        return {output: {label: Indices(of) for label, of in shown.items()} for output, shown in tables.items()}

    @property
    def warnings(self) -> list[str]:
        """What a careful reader should know, of all outputs."""
        record = self.to_dict()
        return [*record.get("warnings", []), *(text for of in record.get("outputs", []) for text in of["warnings"])]

    def warned(self: _Document) -> _Document:
        """The document, with every warning of it warned of."""
        warn(*self.warnings)
        return self

    @property
    def failures(self) -> dict[str, int]:
        """How many runs failed, by their reasons, the commonest first; of an output alone, see there."""
        runs: dict[str, int] = {}
        for of in (of for output in self.to_dict().get("outputs", []) for of in output.get("failures", [])):
            runs[of["reason"]] = max(of["runs"], runs.get(of["reason"], 0))
        return dict(sorted(runs.items(), key=lambda item: -item[1]))

    def save(
        self, folder: str | os.PathLike[str], *, charts: Sequence[Literal["svg", "png", "pdf"]] = ("svg",), width: str | None = None
    ) -> Path:
        """Writes the page, JSON, CSV and charts to `folder`, and returns the path of the page. For papers the `charts` may also be
        "png" and "pdf", of the `width` of a column such as "88mm"."""
        return Path(self._document.save(os.fspath(folder), list(charts), width))


# Outputs up to which each warning is told.
_WARNED = 10


class Result(WithIndices, Document):
    """The indices of a study, with their intervals.

    `first_order`, `total` and so on are those of the only output; with several, `result["name"]` is one of them.
    """

    @property
    def outputs(self) -> dict[str, OutputResult]:
        """Every output, by name."""
        threshold = self.to_dict()["provenance"]["threshold"]
        return {record["name"]: OutputResult(record, threshold) for record in self.to_dict()["outputs"]}

    @property
    def aggregate(self) -> OutputResult | None:
        """The indices of all outputs together, with `aggregate=True`."""
        record = self.to_dict()["aggregate"]
        return record and together("all outputs", record)

    @property
    def series(self) -> dict[str, SeriesResult]:
        """The outputs that are series, by name; their values are `outputs` as well."""
        outputs = list(self.outputs.values())
        records = self.to_dict().get("series", [])
        ends = [(record["first_output"], record["first_output"] + len(record["positions"])) for record in records]
        return {of["name"]: SeriesResult(of, outputs[first:end]) for of, (first, end) in zip(records, ends)}

    def __getitem__(self, output: str) -> OutputResult:
        outputs = self.outputs
        return outputs[_chosen(output, outputs)]

    def __iter__(self) -> Iterator[str]:
        """The names of the outputs."""
        return iter(self.outputs)

    def __len__(self) -> int:
        """The number of outputs."""
        return len(self.outputs)

    def __contains__(self, output: object) -> bool:
        return output in self.outputs

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        series = list(self.series.values())
        of_series = {value.name for of in series for value in of.values}
        alone = [output for name, output in self.outputs.items() if name not in of_series]
        parts = [*([self.aggregate] if self.aggregate else []), *series, *alone[:_OUTPUTS]]
        tables = {caption: shown for part in parts for caption, shown in part._tables().items()}
        return tables | ({f"{len(alone) - _OUTPUTS} more outputs: result[name]": {}} if len(alone) > _OUTPUTS else {})

    def _whole(self) -> SeriesResult | None:
        """The series, where it is all that there is."""
        series = list(self.series.values())
        return series[0] if len(series) == 1 and len(series[0].values) == len(self.outputs) else None

    def _one(self) -> Mapping[str, Any]:
        whole = self._whole()
        return together(whole.name, whole.record).record if whole is not None else self[_chosen(None, self.outputs)].record

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

    def warned(self) -> Result:
        """The result, with its warnings warned of: of many outputs the first of each kind, and how many outputs have one."""
        kinds: dict[str, list[str]] = {}
        for record in self.to_dict()["outputs"]:
            for code, text in {of["code"]: of["text"] for of in record["warnings"]}.items():
                kinds.setdefault(code, []).append(f"{record['name']}: {text}")
        if len(self.outputs) <= _WARNED:
            return super().warned()
        warn(*(f"{of[0]} (a warning of this kind for {len(of)} of {len(self.outputs)} outputs)" for of in kinds.values()))
        return self

    def to_frame(self) -> Any:
        """A row per factor, and per output if there are several, as a `pandas.DataFrame`."""
        frames = {output.name: output.to_frame() for output in (*self.outputs.values(), *filter(None, [self.aggregate]))}
        if len(frames) == 1:
            return next(iter(frames.values()))
        return needed("pandas", "to_frame").concat(frames, names=["output"])

    def to_xarray(self) -> Any:
        """The indices as an `xarray.Dataset` over output, factor and bound (estimate, low, high), NaN for outputs
        that have none."""
        return dataset(list(self.outputs.values()), "output", list(self.outputs))

    def plot(self, output: str | None = None, ax: Any = None) -> Any:  # type: ignore[override]
        """Bars of the indices of an output with their intervals, or lines of the only series, on `ax` of matplotlib; returns the axes."""
        whole = self._whole() if output is None else None
        return whole.plot(ax=ax) if whole is not None else self[_chosen(output, self.outputs)].plot(ax)


def load_result(path: str | os.PathLike[str]) -> Result:
    """The result of a JSON file that `save` or the program has written."""
    return _of_json(Result, Path(path).read_text(encoding="utf-8"), "")


def _of_json(of: type[_Document], text: str, name: str) -> _Document:
    return of(_engine.read_document(text, name))


def _typed(key: str, cells: list[str]) -> list[Any]:
    """Cells of a column of CSV as numbers or truth values, if all are."""
    if key in _TEXTS:
        return cells
    if set(cells) <= {"true", "false"}:
        return [cell == "true" for cell in cells]
    for read in (int, lambda cell: float(cell or "nan")):
        try:
            return [read(cell) for cell in cells]
        except ValueError:
            pass
    return cells


def _chosen(output: str | None, outputs: Collection[str]) -> str:
    """The output, or the only one there is."""
    if output is None and len(outputs) != 1:
        raise ValueError(f"there are several outputs: choose one, such as {next(iter(outputs))!r}")
    output = next(iter(outputs)) if output is None else output
    if output not in outputs:
        raise KeyError(f"{output!r}: the outputs are {', '.join(outputs)}")
    return output
