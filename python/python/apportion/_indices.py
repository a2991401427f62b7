"""The indices of outputs, as numbers and tables."""

from __future__ import annotations

import html
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from . import _engine

# Rows of a table that stand in a notebook.
_ROWS = 30


class _Bounds(NamedTuple):
    estimate: float
    low: float
    high: float


class Index(_Bounds):
    """An index with the ends of its 95 % interval, NaN where there is none. As a number it is the estimate."""

    __slots__ = ()
    # Numbers of NumPy leave the operation to this class.
    __array_ufunc__ = None

    def __float__(self) -> float:
        return self.estimate

    def __format__(self, spec: str) -> str:
        return format(self.estimate, spec) if spec else str(self)

    def __lt__(self, other: Any) -> bool:
        return self.estimate < float(other)

    def __le__(self, other: Any) -> bool:
        return self.estimate <= float(other)

    def __gt__(self, other: Any) -> bool:
        return self.estimate > float(other)

    def __ge__(self, other: Any) -> bool:
        return self.estimate >= float(other)

    def __add__(self, other: Any) -> float:  # type: ignore[override]
        return self.estimate + float(other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> float:
        return self.estimate - float(other)

    def __rsub__(self, other: Any) -> float:
        return float(other) - self.estimate

    def __mul__(self, other: Any) -> float:  # type: ignore[override]
        return self.estimate * float(other)

    __rmul__ = __mul__  # type: ignore[assignment]

    def __truediv__(self, other: Any) -> float:
        return self.estimate / float(other)

    @classmethod
    def of(cls, record: Mapping[str, Any] | None) -> "Index":
        """From a record of the JSON file."""
        record = record or {}
        numbers = (record.get(key) for key in ("estimate", "low", "high"))
        return cls(*(np.nan if number is None else float(number) for number in numbers))


class Shown:
    """Something with indices: its tables and charts, in notebooks too."""

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        """The columns of each table by their labels, by its caption: indices or probabilities; none where there are no indices."""
        raise NotImplementedError

    def _cells(self, most: int) -> Iterator[tuple[str, list[str], list[list[str]]]]:
        """Caption, head and rows of each table, of at most so many rows."""
        for caption, shown in self._tables().items():
            first = shown.get("S_T", next(iter(shown.values()), {}))
            names = sorted(first, key=lambda name: -float(first[name]))
            if len(names) > most:
                caption = f"{caption}: the {most} largest of {len(names)}"
            rows = [[_label(name), *(_words(of[name]) if name in of else "" for of in shown.values())] for name in names[:most]]
            yield caption, ["", *shown], rows

    def to_frame(self) -> Any:
        """The indices as a `pandas.DataFrame`."""
        raise NotImplementedError

    def to_xarray(self) -> Any:
        """The columns of `to_frame` over its rows, as an `xarray.Dataset`."""
        needed("xarray", "to_xarray")
        return self.to_frame().to_xarray()

    def to_markdown(self) -> str:
        """The indices with the half widths of their 95 % intervals, as tables of Markdown."""
        tables = []
        for caption, head, rows in self._cells(sys.maxsize):
            lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows] if rows else []
            tables.append("\n".join([caption, "", *(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |" for row in lines)]))
        return "\n\n".join(tables)

    def to_latex(self) -> str:
        """The indices with the half widths of their 95 % intervals, as tables of LaTeX."""
        tables = []
        for caption, head, rows in self._cells(sys.maxsize):
            lines = [f"{' & '.join(map(_latex, row))} \\\\" for row in (head, *rows)]
            body = [f"\\begin{{tabular}}{{l{'r' * (len(head) - 1)}}}", lines[0], "\\hline", *lines[1:], "\\end{tabular}"]
            tables.append("\n".join([f"% {caption}", *(body if rows else [])]))
        return "\n\n".join(tables)

    def plot(self, ax: Any = None) -> Any:
        """Bars of the indices with their intervals, on `ax` of matplotlib; returns the axes."""
        return bars(ax, *next(iter(self._tables().items())))

    def _repr_html_(self) -> str:
        tables = []
        for caption, head, rows in self._cells(_ROWS):
            lines = ["".join(f"<{tag}>{html.escape(cell)}</{tag}>" for tag, cell in zip(_TAGS, row)) for row in rows]
            heads = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
            body = "".join(f"<tr>{line}</tr>" for line in (heads, *lines))
            caption = html.escape(caption)
            tables.append(f"<table><caption>{caption}</caption>{body}</table>" if rows else f"<p>{caption}</p>")
        return "".join(tables)


# Of the cells of a row.
_TAGS = ("th", *["td"] * 64)


def _label(name: Any) -> str:
    return ", ".join(name) if isinstance(name, tuple) else str(name)


def _words(value: Any) -> str:
    """An index or a probability, as in the text of a result."""
    if isinstance(value, Index):
        return _engine.in_words(*value)
    return "< 0.001" if value < 0.001 else "> 0.999" if value > 0.999 else f"{value:.3f}"


def _latex(cell: str) -> str:
    cell = re.sub(r"([&%#_{}$])", r"\\\1", cell.replace("\\", " ")).replace("−", "$-$")
    return re.sub(r"([±<>])", lambda sign: {"±": r"$\pm$"}.get(sign[0], f"${sign[0]}$"), re.sub(r"\bS\\_(\w)", r"$S_\1$", cell))


class Indices(Shown, Mapping[str, Index]):
    """An index for each factor or group, by name. As an array it is the estimates, in the order of the factors."""

    def __init__(self, entries: dict[Any, Index]):
        self._entries = entries

    def __getitem__(self, name: Any) -> Index:
        try:
            return self._entries[name if name in self._entries else _turned(name)]
        except (KeyError, TypeError):
            there = ", ".join(map(repr, self._entries)) or "none"
            raise KeyError(f"no index of {name!r}: there are {there}") from None

    def __contains__(self, name: Any) -> bool:
        return name in self._entries or _turned(name) in self._entries

    def __iter__(self) -> Iterator[Any]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return self.estimates if dtype is None else self.estimates.astype(dtype)

    def __repr__(self) -> str:
        return "\n".join(f"{_label(name)}: {_words(index)}" for name, index in self._entries.items())

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

    def to_frame(self) -> Any:
        """A row for each with `estimate`, `low` and `high`, as a `pandas.DataFrame`; of pairs under both names."""
        pandas = needed("pandas", "to_frame")
        names = list(self._entries)
        is_of_pairs = bool(names) and all(isinstance(name, tuple) and len(name) == 2 for name in names)
        pairs = ["factor", "second factor"]
        index = (
            pandas.MultiIndex.from_tuples(names, names=pairs)
            if is_of_pairs
            else pandas.Index(names, name="factor", tupleize_cols=False)
        )
        return pandas.DataFrame({"estimate": self.estimates, "low": self.low, "high": self.high}, index=index)

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        return {"index": {"index": self}}

    def _column(self, place: int) -> np.ndarray:
        return np.array([index[place] for index in self._entries.values()], dtype=float)


def _turned(name: Any) -> Any:
    """A pair of names in the other order."""
    return name[::-1] if isinstance(name, tuple) and len(name) == 2 else name


_KINDS = ("first_order", "total", "interaction")
_PROBABILITIES = ("probability_first", "probability_above_threshold")
# What is not known of several outputs together.
_TOGETHER = {"unit": "1", "mean": np.nan, "variance": np.nan, "runs_failed": 0, "warnings": [], "second_order": [], "noise": None}


class WithIndices:
    """The indices of an output, of the only one, or of the only series as a whole."""

    def _one(self) -> Mapping[str, Any]:
        """Its record in the JSON file."""
        raise NotImplementedError

    @property
    def first_order(self) -> Indices:
        """First-order indices S of the factors."""
        return self._indices("indices", "first_order")

    @property
    def total(self) -> Indices:
        """Total indices ST of the factors."""
        return self._indices("indices", "total")

    @property
    def interaction(self) -> Indices:
        """S_T - S_1 of the factors; empty where they depend on each other."""
        return self._indices("indices", "interaction")

    @property
    def probability_first(self) -> dict[str, float]:
        """The probability of each factor that its total index is the largest, P(largest)."""
        return self._numbers("probability_first")

    @property
    def probability_above_threshold(self) -> dict[str, float]:
        """The probability of each factor that its total index is above the `threshold` of the study, P(S_T > t)."""
        return self._numbers("probability_above_threshold")

    @property
    def shapley(self) -> Indices:
        """Shapley effects of the factors or groups: shares of the variance that sum to 1 even where factors depend on each other.
        There are some of up to 8 factors with `shapley=True`, and by default of up to 4 factors that depend on each other."""
        records = [record for record in self._one()["indices"] or [] if "shapley" in record]
        return Indices({record["factor"]: Index.of(record["shapley"]) for record in records})

    @property
    def measures(self) -> dict[str, Indices]:
        """Other measures than Sobol' indices by their names, of the factors; empty without `measures=["delta", ...]`."""
        factors = (self._one().get("measures") or {"factors": []})["factors"]
        names = factors[0]["measures"] if factors else []
        return {name: Indices({of["input"]: Index.of(of["measures"][name]) for of in factors}) for name in names}

    @property
    def second_order(self) -> Indices:
        """Second-order indices by pairs of factors; empty if they were not requested."""
        records = self._one()["second_order"] or []
        return Indices({tuple(record["factors"]): Index.of(record["index"]) for record in records})

    def groups(self, kind: str = "total") -> Indices:
        """Joint indices of the groups; `kind` is "first_order" or "total"."""
        return self._indices("groups", kind)

    def subsets(self, kind: str = "first_order") -> Indices:
        """Joint indices of the requested subsets; first-order ones are closed indices."""
        return self._indices("subsets", kind)

    @property
    def noise(self) -> Mapping[str, Index] | None:
        """Of a stochastic model the `first_order` and `total` index of its noise, and the `mean_share` of the variance that the
        mean over the noise has."""
        record = self._one().get("noise")
        return record and {key: Index.of(record[key]) for key in ("first_order", "total", "mean_share")}

    def of_mean(self, kind: str = "first_order") -> Indices:
        """Indices of the mean over the noise, of its own variance; total ones if requested (`noise={"mean_totals": True}`), or the
        joint index with the noise (`subsets=[["x1", "seed"], ...]`)."""
        if kind not in ("first_order", "total"):
            raise ValueError(f'kind={kind!r}: expected "first_order" or "total"')
        records = (self._one().get("noise") or {}).get("of_mean", [])
        return Indices({record["factor"]: Index.of(record[kind]) for record in records if record[kind] is not None})

    def _indices(self, of: str, kind: str) -> Indices:
        if kind not in _KINDS:
            raise ValueError(f'kind={kind!r}: expected "first_order" or "total"')
        records = [record for record in self._one().get(of) or [] if record.get(kind) is not None]
        names = [tuple(record["factors"]) if of == "subsets" else record["factor"] for record in records]
        return Indices(dict(zip(names, (Index.of(record[kind]) for record in records))))

    def _numbers(self, key: str) -> dict[str, float]:
        return {of["factor"]: of[key] for of in self._one()["indices"] or [] if of.get(key) is not None}


class OutputResult(WithIndices, Shown):
    """The indices of one output."""

    def __init__(self, record: Mapping[str, Any], threshold: float = 0.05):
        self.record = record
        self.threshold = threshold

    def _one(self) -> Mapping[str, Any]:
        return self.record

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
        """Warnings about the indices; of failed runs with the commonest exception."""
        kinds: dict[str, int] = {}
        for reason, runs in self.failures.items():
            kinds[reason.split(":")[0]] = kinds.get(reason.split(":")[0], 0) + runs
        commonest = max(kinds, key=lambda kind: kinds[kind], default="")
        why = f"; most often {commonest} ({kinds[commonest]} runs)" if kinds else ""
        return [of["text"] + why * (of["code"] == "runs-failed") for of in self.record["warnings"]]

    @property
    def failures(self) -> dict[str, int]:
        """How many runs failed, by their reasons, the commonest first."""
        runs = {of["reason"]: of["runs"] for of in self.record.get("failures", [])}
        return dict(sorted(runs.items(), key=lambda item: -item[1]))

    @property
    def reason(self) -> str | None:
        """The reason if there are no indices."""
        reason = self.record["reason"]
        return reason and reason["text"]

    def to_frame(self) -> Any:
        """A row per factor, and per group and subset if there are some, whose `kind` then tells them apart, as a
        `pandas.DataFrame`: indices with the ends of their intervals, probabilities and measures."""
        pandas = needed("pandas", "to_frame")
        rows: dict[str, dict[str, Any]] = {}
        has_kinds = bool(self.record.get("groups") or self.record.get("subsets"))
        for of, name in {"indices": "factor", "groups": "group", "subsets": "subset"}.items():
            for record in self.record.get(of) or []:
                row: dict[str, Any] = {"kind": name} if has_kinds else {}
                shown = {kind: Index.of(record[kind]) for kind in (*_KINDS, "shapley") if record.get(kind) is not None}
                measures = self.measures if of == "indices" else {}
                shown |= {kind: of_all[record["factor"]] for kind, of_all in measures.items() if record["factor"] in of_all}
                for kind, index in shown.items():
                    row |= {kind: index.estimate, f"{kind}_low": index.low, f"{kind}_high": index.high}
                rows[record["factor"]] = row | {key: record[key] for key in _PROBABILITIES if record.get(key) is not None}
        return pandas.DataFrame(list(rows.values()), index=pandas.Index(list(rows), name="factor", dtype=object))

    def to_xarray(self) -> Any:
        """The indices as an `xarray.Dataset` over factor and bound (estimate, low, high)."""
        return dataset([self], "output", [self.name]).isel(output=0)

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        shown: dict[str, Mapping[Any, Any]] = {"S_1": self.first_order, "S_T": self.total, "S_T − S_1": self.interaction}
        shown |= {"P(largest)": self.probability_first, f"P(S_T > {self.threshold:g})": self.probability_above_threshold}
        shown = {label: of for label, of in {**shown, "Shapley effect": self.shapley}.items() if of}
        tables = {f"Sobol' indices of {self.name}" + f": {self.reason}" * (not shown): shown}
        return tables | ({f"Measures of {self.name}": dict(self.measures)} if self.measures else {})


def together(name: str, record: Mapping[str, Any]) -> OutputResult:
    """The indices of several outputs together."""
    return OutputResult({**_TOGETHER, **record, "name": name, "noise": None})


class SeriesResult(Shown):
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
        """The name of the axis."""
        return self.record["axis"]

    @property
    def positions(self) -> np.ndarray:
        """The positions of the values on the axis, in `axis_unit`."""
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
        return together(self.name, self.record).first_order

    @property
    def total_of_all(self) -> Indices:
        """Total indices of the whole series."""
        return together(self.name, self.record).total

    def to_frame(self) -> Any:
        """A row for each value and factor with first-order and total index, as a `pandas.DataFrame`."""
        pandas = needed("pandas", "to_frame")
        frames = {position: value.to_frame() for position, value in zip(self.positions, self.values)}
        return pandas.concat(frames, names=[self.axis])

    def to_xarray(self) -> Any:
        """The indices as an `xarray.Dataset` over the axis, factor and bound (estimate, low, high)."""
        return dataset(self.values, self.axis, self.positions)

    def _tables(self) -> dict[str, dict[str, Mapping[Any, Any]]]:
        return together(f"{self.name} as a whole", self.record)._tables()

    def plot(self, kind: str = "total", ax: Any = None) -> Any:  # type: ignore[override]
        """Lines of the "first_order" or "total" indices against the axis with their intervals; returns the axes of matplotlib."""
        ax = axes(ax, (6.0, 3.6))
        for name, values in self._against(kind).items():
            (line,) = ax.plot(self.positions, values[:, 0], label=name)
            ax.fill_between(self.positions, values[:, 1], values[:, 2], color=line.get_color(), alpha=0.2, linewidth=0)
        ax.set_xlabel(self.axis if self.axis_unit in ("", "1") else f"{self.axis} ({self.axis_unit})")
        ax.set_ylabel(f"{kind.replace('_', '-')} index of {self.name}")
        ax.legend()
        return ax

    def _against(self, kind: str) -> dict[str, np.ndarray]:
        indices = [getattr(value, kind) for value in self.values]
        names = next((list(of) for of in indices if len(of)), [])
        none = Index.of(None)
        return {name: np.array([of.get(name, none) for of in indices], dtype=float) for name in names}


def dataset(outputs: Sequence[OutputResult], dimension: str, coordinate: Any) -> Any:
    """First-order and total indices over `dimension`, factor and bound, as an `xarray.Dataset`; NaN for outputs that have none."""
    factors = next((output.first_order.names for output in outputs if len(output.first_order)), [])
    none, data = Index.of(None), {}
    for kind in ("first_order", "total"):
        rows = [[getattr(output, kind).get(name, none) for name in factors] for output in outputs]
        data[kind] = (dimension, "factor", "bound"), np.array(rows, dtype=float).reshape(len(outputs), len(factors), 3)
    coordinates = {dimension: coordinate, "factor": factors, "bound": ["estimate", "low", "high"]}
    return needed("xarray", "to_xarray").Dataset(data, coordinates)


def bars(ax: Any, caption: str, columns: Mapping[str, Mapping[Any, Any]]) -> Any:
    """Bars of indices by their labels, on the axes or new ones."""
    shown = {label: of for label, of in columns.items() if isinstance(of, Indices) and label != "S_T − S_1"}
    names = next((indices.names for indices in shown.values()), [])
    ax = axes(ax, (6.0, 0.45 * len(names) + 1.2))
    places, height = np.arange(len(names)), 0.76 / max(len(shown), 1)
    for number, (label, indices) in enumerate(shown.items()):
        values = indices.estimates
        errors = np.nan_to_num(np.abs([values - indices.low, indices.high - values]))
        shift = (number - (len(shown) - 1) / 2) * height
        ax.barh(places + shift, values, 0.95 * height, xerr=errors, label=label, error_kw={"elinewidth": 1, "capsize": 2})
    ax.set_yticks(places, [_label(name) for name in names])
    ax.invert_yaxis()
    ax.set_xlabel(caption)
    if len(shown) > 1:
        ax.legend()
    return ax


def axes(ax: Any, size: tuple[float, float]) -> Any:
    """The axes, or new ones of that size in inches."""
    return ax or needed("matplotlib.pyplot", "plot").subplots(figsize=size, layout="constrained")[1]


def needed(module: str, what: str) -> Any:
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        raise ImportError(f"{what} needs {package}: pip install {package}") from error
