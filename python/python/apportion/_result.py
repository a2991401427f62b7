"""Results: indices as numbers, tables and charts."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import _engine


class Index(NamedTuple):
    """An index with the ends of its 95 % interval, NaN where there is none."""

    estimate: float
    low: float
    high: float

    @classmethod
    def of(cls, record: Mapping[str, Any] | None) -> "Index":
        """From a record of the JSON file."""
        record = record or {}
        numbers = (record.get(key) for key in ("estimate", "low", "high"))
        return cls(*(np.nan if number is None else float(number) for number in numbers))


class Indices(Mapping[str, Index]):
    """An index for each factor or group, by name. As an array it is the estimates, in the order of the factors."""

    def __init__(self, entries: dict[Any, Index]):
        self._entries = entries

    def __getitem__(self, name: Any) -> Index:
        return self._entries[name]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return self.estimates if dtype is None else self.estimates.astype(dtype)

    def __repr__(self) -> str:
        lines = (f"{name}: {index.estimate:.4g} [{index.low:.4g}, {index.high:.4g}]" for name, index in self._entries.items())
        return "\n".join(lines)

    @property
    def names(self) -> list[Any]:
        return list(self._entries)

    @property
    def estimates(self) -> np.ndarray:
        """The estimates, in the order of the factors."""
        return self._column(0)

    @property
    def low(self) -> np.ndarray:
        """Lower ends of the intervals."""
        return self._column(1)

    @property
    def high(self) -> np.ndarray:
        """Upper ends of the intervals."""
        return self._column(2)

    def _column(self, place: int) -> np.ndarray:
        return np.array([index[place] for index in self._entries.values()], dtype=float)


class Document:
    """What was found: in words, as a page, as charts and as the JSON that holds every number."""

    def __init__(self, document: _engine.Document):
        self._document = document
        self._parsed: dict[str, Any] | None = None

    def __repr__(self) -> str:
        return self._document.text()

    def _repr_html_(self) -> str:
        lead = "".join(f"<p>{html.escape(line)}</p>" for line in self._document.lead)
        charts = self._document.charts()
        return f"<div>{lead}{self._table_html()}{charts[0][1] if charts else ''}</div>"

    def _table_html(self) -> str:
        """The indices as a table; only results of runs have one."""
        return ""

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        return {"text/plain": repr(self), "text/html": self._repr_html_()}

    @property
    def lead(self) -> list[str]:
        """What decides, in sentences."""
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
        """The whole page, with nothing to load from anywhere."""
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


class OutputResult:
    """The indices of one output."""

    def __init__(self, record: Mapping[str, Any]):
        self.record = record

    def __repr__(self) -> str:
        return f"<output {self.name}: first-order\n{self.first_order}\ntotal\n{self.total}>"

    @property
    def name(self) -> str:
        return self.record["name"]

    @property
    def unit(self) -> str:
        return self.record["unit"]

    @property
    def mean(self) -> float:
        return self.record["mean"]

    @property
    def variance(self) -> float:
        return self.record["variance"]

    @property
    def runs_failed(self) -> int:
        return self.record["runs_failed"]

    @property
    def warnings(self) -> list[str]:
        """What a careful reader should know."""
        return self.record["warnings"]

    @property
    def reason(self) -> str | None:
        """Why there are no indices, if there are none."""
        return self.record["reason"]

    @property
    def first_order(self) -> Indices:
        """First-order indices S of the factors."""
        return self._indices("indices", "first_order")

    @property
    def total(self) -> Indices:
        """Total indices ST of the factors."""
        return self._indices("indices", "total")

    @property
    def shapley(self) -> Indices:
        """Shapley effects of the factors, which sum to 1; empty if there are none."""
        records = [record for record in self.record["indices"] or [] if "shapley" in record]
        return Indices({record["factor"]: Index.of(record["shapley"]) for record in records})

    @property
    def measures(self) -> dict[str, Indices]:
        """Other measures than Sobol' indices by their names, of the factors; empty without `measures=["delta", ...]`."""
        factors = (self.record.get("measures") or {"factors": []})["factors"]
        names = factors[0]["measures"] if factors else []
        return {name: Indices({of["input"]: Index.of(of["measures"][name]) for of in factors}) for name in names}

    @property
    def shapley_groups(self) -> Indices:
        """Shapley effects of the groups and of the factors that have none, which sum to 1; empty without `shapley_players="groups"`."""
        records = self.record.get("shapley_groups") or []
        return Indices({record["player"]: Index.of(record["shapley"]) for record in records})

    @property
    def second_order(self) -> Indices:
        """Second-order indices by pairs of factors; empty if they were not asked for."""
        records = self.record["second_order"] or []
        return Indices({tuple(record["factors"]): Index.of(record["index"]) for record in records})

    def groups(self, kind: str = "total") -> Indices:
        """Joint indices of the groups; `kind` is "first_order" or "total"."""
        return self._indices("groups", kind)

    def subsets(self, kind: str = "first_order") -> Indices:
        """Joint indices of the subsets asked for; first-order ones are closed indices."""
        return self._indices("subsets", kind)

    @property
    def noise(self) -> Mapping[str, Index] | None:
        """Of a stochastic model the `first_order` and `total` index of its noise, and the `mean_share` of the variance that the
        mean over the noise has."""
        record = self.record.get("noise")
        return record and {key: Index.of(record[key]) for key in ("first_order", "total", "mean_share")}

    def of_mean(self, kind: str = "first_order") -> Indices:
        """Indices of the mean over the noise, of its own variance; total ones where they were asked for (`noise={"mean_totals": True}`), or the
        joint index with the noise (`subsets=[["x1", "seed"], ...]`)."""
        if kind not in ("first_order", "total"):
            raise ValueError(f'kind={kind!r}: expected "first_order" or "total"')
        records = (self.record.get("noise") or {}).get("of_mean", [])
        return Indices({record["name"]: Index.of(record[kind]) for record in records if record[kind] is not None})

    def _indices(self, of: str, kind: str) -> Indices:
        if kind not in ("first_order", "total"):
            raise ValueError(f'kind={kind!r}: expected "first_order" or "total"')
        name = {"indices": "factor", "groups": "group", "subsets": "factors"}[of]
        entries = {}
        for record in self.record[of] or []:
            key = record.get(name, record.get("name"))
            entries[tuple(key) if isinstance(key, list) else key] = Index.of(record[kind])
        return Indices(entries)

    def to_frame(self) -> Any:
        """A row per factor, as a `pandas.DataFrame`."""
        pandas = _needed("pandas", "to_frame")
        columns: dict[str, Any] = {}
        kinds = {"first_order": self.first_order, "total": self.total, "shapley": self.shapley}
        for kind, indices in ((kind, indices) for kind, indices in kinds.items() if len(indices) or kind != "shapley"):
            columns |= {kind: np.asarray(indices), f"{kind}_low": indices.low, f"{kind}_high": indices.high}
        return pandas.DataFrame(columns, index=pandas.Index(self.first_order.names, name="factor"))


class SeriesResult:
    """The indices of an output that is a series of values along an axis."""

    def __init__(self, record: Mapping[str, Any], values: list[OutputResult]):
        self.record = record
        self.values = values

    def __repr__(self) -> str:
        return f"<series {self.name}: {len(self.values)} values along {self.axis}; total\n{self.total_of_all}>"

    @property
    def name(self) -> str:
        return self.record["name"]

    @property
    def axis(self) -> str:
        """What the axis is called."""
        return self.record["axis"]

    @property
    def positions(self) -> np.ndarray:
        """Where the values stand on the axis, in `axis_unit`."""
        return np.array(self.record["positions"])

    @property
    def axis_unit(self) -> str:
        return self.record["axis_unit"]

    @property
    def first_order(self) -> dict[str, np.ndarray]:
        """First-order indices against the axis: for each factor an array of (values, 3), estimate and ends of its interval;
        NaN where a value has none."""
        return self._against("first_order")

    @property
    def total(self) -> dict[str, np.ndarray]:
        """Total indices against the axis, as `first_order`."""
        return self._against("total")

    @property
    def first_order_of_all(self) -> Indices:
        """First-order indices of the whole series, each value counted by its variance (Gamboa et al. 2014)."""
        return _of_factors(self.record["indices"], "first_order")

    @property
    def total_of_all(self) -> Indices:
        """Total indices of the whole series."""
        return _of_factors(self.record["indices"], "total")

    @property
    def directions(self) -> list[dict[str, Any]]:
        """Main directions: the `share` of the variance of all values in percent, the `loadings`, what a standard deviation of the
        score adds to every value, and the indices of the score, `first_order` and `total`."""
        records = self.record["directions"] or []
        kinds = ("first_order", "total")
        return [
            {"share": of["share"], "loadings": np.array(of["loadings"])} | {k: _of_factors(of["indices"], k) for k in kinds}
            for of in records
        ]

    def _against(self, kind: str) -> dict[str, np.ndarray]:
        indices = [getattr(value, kind) for value in self.values]
        names = next((list(of) for of in indices if len(of)), [])
        none = Index.of(None)
        return {name: np.array([of.get(name, none) for of in indices], dtype=float) for name in names}


def _of_factors(records: Any, kind: str) -> Indices:
    return Indices({record["factor"]: Index.of(record[kind]) for record in records or []})


class Result(Document):
    """The indices of a study, and how well they are known.

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
        return _needed("pandas", "to_frame").concat(frames, names=["output"])

    def to_xarray(self) -> Any:
        """The indices as an `xarray.Dataset` over output, factor and bound (estimate, low, high)."""
        xarray = _needed("xarray", "to_xarray")
        outputs = list(self.outputs.values())
        data = {
            kind: (("output", "factor", "bound"), [[list(index) for index in getattr(o, kind).values()] for o in outputs])
            for kind in ("first_order", "total")
        }
        coordinates = {
            "output": [output.name for output in outputs],
            "factor": outputs[0].first_order.names,
            "bound": ["estimate", "low", "high"],
        }
        return xarray.Dataset(data, coordinates)

    def plot(self, output: str | None = None, ax: Any = None) -> Any:
        """Bars of first-order and total indices with their intervals, on `ax` of matplotlib; returns the axes."""
        pyplot = _needed("matplotlib.pyplot", "plot")
        of = self._only() if output is None else self[output]
        if ax is None:
            _, ax = pyplot.subplots(figsize=(6.0, 0.45 * len(of.total) + 1.2), layout="constrained")
        places = np.arange(len(of.total))
        for indices, shift, label in ((of.first_order, -0.19, "first-order"), (of.total, 0.19, "total")):
            values = np.asarray(indices)
            errors = np.nan_to_num(np.abs([values - indices.low, indices.high - values]))
            ax.barh(places + shift, values, 0.36, xerr=errors, label=label, error_kw={"elinewidth": 1, "capsize": 2})
        ax.set_yticks(places, [str(name) for name in of.total])
        ax.invert_yaxis()
        ax.set_xlabel(f"Sobol' indices of {of.name}")
        ax.legend()
        return ax


def load_result(path: str | os.PathLike[str]) -> Result:
    """The result of a JSON file that `save` or the program has written."""
    return Result(_engine.read_result(Path(path).read_text(encoding="utf-8")))


def _needed(module: str, what: str) -> Any:
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        raise ImportError(f"{what} needs {package}: pip install {package}") from error
