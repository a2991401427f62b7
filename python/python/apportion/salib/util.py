"""SALib's problems with their points, outputs and results, and problems from files."""

from __future__ import annotations

import csv
import importlib
import inspect
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np

from .._engine import StudyError
from .._indices import needed
from .plotting.bar import plot

_PACKAGE = __name__.rpartition(".")[0]


def confidence(level: float) -> float:
    """The quantile of the normal distribution by which standard deviations are half widths of intervals."""
    if not 0 < level < 1:
        raise StudyError(f"conf_level must be between 0 and 1, not {level!r}")
    return NormalDist().inv_cdf(0.5 + level / 2)


class ResultDict(dict[str, Any]):
    """What an analysis returns: arrays by their keys."""

    def to_df(self) -> Any:
        """A row per factor or group, as a `pandas.DataFrame`."""
        columns = {key: values for key, values in self.items() if key != "names"}
        return needed("pandas", "to_df").DataFrame(columns, index=self["names"])

    def plot(self, ax: Any = None) -> Any:
        """Bars of every frame of `to_df`, on `ax` of matplotlib, or an array of as many as there are frames; returns the axes."""
        frames = self.to_df()
        if not isinstance(frames, list):
            return plot(frames, ax=ax)
        if ax is None:
            ax = needed("matplotlib.pyplot", "plot").subplots(1, len(frames))[1]
        for frame, part in zip(frames, ax):
            plot(frame, ax=part)
        return ax


class ProblemSpec(dict[str, Any]):
    """A problem with its points, outputs and results, and a method for each sampler and analysis:

        sp = ProblemSpec({"names": ["a", "b"], "bounds": [[0, 1], [0, 1]], "outputs": ["y"]})
        sp.sample_sobol(1024).evaluate(f).analyze_sobol()

    `f` gets all points, (rows, factors), and returns (rows,) or (rows, outputs). With several outputs, `analysis` has a result for
    each name.
    """

    def __init__(self, *args: Any, **entries: Any):
        super().__init__(*args, **entries)
        for key in ("names", "bounds"):
            if key not in self:
                raise StudyError(f"the problem has no {key!r}")
        self["num_vars"] = len(self["names"])
        self["groups"] = self.get("groups") or self["names"]
        self._samples: Any = None
        self._results: Any = None
        self._analysis: Any = None

    def __getattr__(self, name: str) -> Any:
        kind, _, method = name.partition("_")
        if kind not in ("sample", "analyze") or not method:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        method = "fast_sampler" if name == "sample_fast" else method
        try:
            module = importlib.import_module(f"{_PACKAGE}.{kind}.{method}")
        except ModuleNotFoundError as error:
            raise AttributeError(f"{name}: there is no {error.name}") from None
        return partial(getattr(self, kind), getattr(module, kind))

    def __dir__(self) -> list[str]:
        kinds = {kind: importlib.import_module(f"{_PACKAGE}.{kind}").__all__ for kind in ("sample", "analyze")}
        return [*super().__dir__(), *(f"{kind}_{method}" for kind, methods in kinds.items() for method in methods)]

    @property
    def samples(self) -> Any:
        """The points, (rows, factors)."""
        return self._samples

    @samples.setter
    def samples(self, points: np.ndarray) -> None:
        if np.ndim(points) != 2 or points.shape[1] != self["num_vars"]:
            raise StudyError(f"points of shape {np.shape(points)}: expected (rows, {self['num_vars']})")
        self._samples, self._results = points, None

    @property
    def results(self) -> Any:
        """The outputs, (rows,) or (rows, outputs)."""
        return self._results

    @results.setter
    def results(self, outputs: np.ndarray) -> None:
        count = 1 if np.ndim(outputs) == 1 else outputs.shape[1]
        names = self.get("outputs") or (["Y"] if count == 1 else [f"Y{k + 1}" for k in range(count)])
        if len(names) != count or (self._samples is not None and len(outputs) != len(self._samples)):
            rows = "rows" if self._samples is None else len(self._samples)
            raise StudyError(f"outputs of shape {np.shape(outputs)}: expected ({rows}, {len(names)}), of {', '.join(names)}")
        self["outputs"] = names
        self._results = outputs

    @property
    def analysis(self) -> Any:
        """The result, or with several outputs the results by their names."""
        return self._analysis

    def sample(self, func: Callable[..., Any], *args: Any, **keywords: Any) -> ProblemSpec:
        """Takes the points that `func` makes of the problem."""
        self.samples = func(self, *args, **keywords)
        self._analysis = None
        return self

    def set_samples(self, samples: np.ndarray) -> ProblemSpec:
        """Takes points that are there, (rows, factors)."""
        self.samples = samples
        return self

    def set_results(self, results: np.ndarray) -> ProblemSpec:
        """Takes outputs that are there, (rows,) or (rows, outputs)."""
        self.results = results
        return self

    def evaluate(self, func: Callable[..., Any], *args: Any, nprocs: int | None = 1, **keywords: Any) -> ProblemSpec:
        """Takes the outputs of `func` at the points, which is called with as many parts of them as there are `nprocs` processes,
        None for one per core."""
        if self._samples is None:
            raise StudyError("there are no points: call a sampler before, as sample_sobol(1024)")
        call = partial(_call, func, args, keywords)
        if nprocs == 1:
            self.results = call(self._samples)
            return self
        with ProcessPoolExecutor(nprocs) as executor:
            parts = np.array_split(self._samples, nprocs or os.cpu_count() or 1)
            self.results = np.concatenate(list(executor.map(call, parts)))
        return self

    def evaluate_parallel(
        self, func: Callable[..., Any], *args: Any, nprocs: int | None = None, **keywords: Any
    ) -> ProblemSpec:
        """`evaluate` in processes, by default one per core."""
        return self.evaluate(func, *args, nprocs=nprocs, **keywords)

    def analyze(self, func: Callable[..., Any], *args: Any, nprocs: int | None = None, **keywords: Any) -> ProblemSpec:
        """Takes what `func` makes of the problem, the points if it has an argument `X`, and each output; `nprocs` has no effect."""
        if self._results is None:
            raise StudyError("there are no outputs: call evaluate() before, or set_results()")
        if "X" in inspect.signature(func).parameters:
            keywords["X"] = self._samples
        outputs = self["outputs"]
        columns = np.reshape(self._results, (len(self._results), len(outputs))).T
        found = {name: func(self, *args, Y=column, **keywords) for name, column in zip(outputs, columns)}
        self._analysis = found if len(found) > 1 else found[outputs[0]]
        return self

    def _found(self) -> dict[str, ResultDict]:
        if self._analysis is None:
            raise StudyError("there is no result: call an analysis before, as analyze_sobol()")
        return self._analysis if len(self["outputs"]) > 1 else {self["outputs"][0]: self._analysis}

    def to_df(self) -> Any:
        """The frames of the result, or a list of those of each output."""
        frames = [found.to_df() for found in self._found().values()]
        return frames if len(frames) > 1 else frames[0]

    def plot(self, **keywords: Any) -> Any:
        """Bars of the result; with several outputs a row of axes for each. Returns the axes of matplotlib."""
        found = self._found()
        if len(found) == 1:
            return next(iter(found.values())).plot(**keywords)
        frames = next(iter(found.values())).to_df()
        columns = len(frames) if isinstance(frames, list) else 1
        rows = needed("matplotlib.pyplot", "plot").subplots(len(found), columns, layout="constrained", squeeze=False)[1]
        for (name, of), row in zip(found.items(), rows):
            of.plot(ax=row if columns > 1 else row[0], **keywords)
            row[0].set_title(name)
        return rows if columns > 1 else rows[:, 0]

    def heatmap(self, metric: str | None = None, index: Any = None, title: str | None = None, ax: Any = None) -> Any:
        """Colours of the indices of an output, the first one if none is named, by factors; returns the axes of matplotlib."""
        return importlib.import_module(f"{_PACKAGE}.plotting.heatmap").heatmap(self, metric, index, title, ax)

    def __str__(self) -> str:
        parts = []
        if self._samples is not None:
            parts.append(f"Samples:\n\t{self['num_vars']} parameters: {self['names']}\n\t{len(self._samples)} samples\n")
        if self._results is not None:
            parts.append(
                f"Outputs:\n\t{len(self['outputs'])} outputs: {self['outputs']}\n\t{len(self._results)} evaluations\n"
            )
        if self._analysis is not None:
            parts.append("Analysis:\n")
            for name, of in self._found().items():
                frames = of.to_df()
                parts += [f"{name}:\n"] * (len(self["outputs"]) > 1)
                parts += [f"{frame}\n" for frame in (frames if isinstance(frames, list) else [frames])]
        return "".join(parts) or "ProblemSpec has neither samples, evaluations nor results."


def _call(func: Callable[..., Any], args: tuple[Any, ...], keywords: dict[str, Any], points: np.ndarray) -> Any:
    return func(points, *args, **keywords)


def read_param_file(filename: str | os.PathLike[str], delimiter: str | None = None) -> dict[str, Any]:
    """The problem of a file with a line per factor: name, lower bound, upper bound, and perhaps group (or NA) and distribution.

    The `delimiter` is found if it is not said; lines that begin with # are comments.
    """
    text = Path(filename).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    try:
        dialect = csv.Sniffer().sniff("\n".join(lines)[:1024], delimiters=delimiter)
        rows = [[*row, *[None] * 5] for row in csv.reader(lines, dialect)]
        bounds = [[float(end or "") for end in row[1:3]] for row in rows]
    except (csv.Error, ValueError):
        raise StudyError(
            f"{filename}: expected lines of name, lower and upper bound, perhaps group and distribution"
        ) from None
    names = [row[0] for row in rows]
    groups = [row[0] if row[3] in (None, "NA") else row[3] for row in rows]
    dists = [row[4] or "unif" for row in rows]
    return {
        "names": names,
        "bounds": bounds,
        "num_vars": len(names),
        "groups": None if groups == names else groups,
        "dists": None if set(dists) == {"unif"} else dists,
    }
