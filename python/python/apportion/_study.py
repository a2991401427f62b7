"""Studies: what is asked, and the runs that answer it."""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _engine, _toml
from ._distributions import Factor, Seed
from ._engine import RunError, StudyError
from ._executors import called_elsewhere
from ._functions import Call, expanded
from ._repeated import RepeatedCall, outputs_of, taken_out
from ._result import Document, Result

# Keys of `Study` by the table of the study file that they belong to.
_DESIGN = ("sampler", "base_samples", "replicates", "plain_rows", "budget_runs", "seed", "max_runs")
_ANALYSIS = (
    "estimators",
    "second_order",
    "subsets",
    "shapley",
    "shapley_method",
    "shapley_players",
    "measures",
    "aggregate",
    "dummy",
    "intervals",
    "surrogate",
    "resamples",
    "threshold",
    "failures",
    "max_failed",
)
# Rows of a vectorised function that show what it returns.
_PROBED = 2


class Study:
    """A model, the factors whose influence is asked for, and how many runs answer it.

    `model` is a function of Python, the name of a model of the engine ("ishigami", "afm", ...), or None if the outputs are
    computed elsewhere: see `sample` and `analyse`. `factors` maps names to distributions; a pair (min, max) is uniform.

    `outputs` are names, or a mapping from names to units. An output may be a series, with several values a row: an array of
    (rows, values), or of (values,) where `vectorised=False`, in a dict or tuple of outputs or as the only one that `outputs`
    names. The mapping says of its axis what is to be known: `outputs={"infected": {"axis": "day", "unit": "%"}}`, with
    `axis_unit`, and `positions` (all, or the first one and the step).

    `noise="seed"` gives a stochastic model a seed with every row, as its last argument or by that name;
    `noise={"mean_totals": True}` adds the total indices of the mean over it, one more run of each base sample for each factor,
    and `noise={"repetitions": 8}` calls the function so often for each row: its outputs are then `y_mean` and `y_variance`.

    Keywords are the keys of a study file: `base_samples`, `sampler`, `replicates`, `seed`, `budget_runs`, `max_runs`,
    `target`, `budget` (seconds), `accuracy`; `second_order`, `subsets`, `shapley`, `shapley_method`, `shapley_players`,
    `measures`, `estimators`, `intervals`, `surrogate`,
    `threshold`, `dummy`, `aggregate`, `resamples`, `failures`, `max_failed`; and its tables: `afm={...}`, `function={...}`,
    `expression={...}`, `fidelity={...}`. Factors that depend on each other, by a Gaussian copula:
    `dependence={("a", "b"): 0.6}`, Pearson's correlations, or a list of tables as in a study file, as in
    `[{"factors": ["a", "b"], "correlation": 0.6, "measure": "spearman"}]`; as an array of joint measurements has them, a row
    each: `[{"factors": ["a", "b"], "measurements": array, "copula": "kernel"}]`.
    """

    def __init__(
        self,
        model: Callable[..., Any] | str | None,
        factors: Mapping[str, Any] | None = None,
        *,
        outputs: Sequence[str] | Mapping[str, str] | str | None = None,
        name: str = "study",
        title: str | None = None,
        vectorised: bool = True,
        call: str | None = None,
        accuracy: float | None = None,
        target: float | None = None,
        budget: float | None = None,
        noise: str | Mapping[str, Any] | None = None,
        **options: Any,
    ):
        if isinstance(outputs, str):
            outputs = [outputs]
        made = {key: Factor.of(value) for key, value in (factors or {}).items()}
        repetitions = 1
        if isinstance(noise, Mapping):
            if callable(model):
                noise, repetitions = taken_out(noise)
            # The engine makes a factor of it, behind all others.
            options["noise"] = noise = {"name": "seed", **noise}
            stated, made = dict(made), {**made, noise["name"]: Seed()}
        else:
            made |= {} if noise is None else {noise: Seed()}
            stated = made
        table: dict[str, Any] = {"name": name, "title": title, "accuracy": accuracy}
        design = {key: options.pop(key, None) for key in _DESIGN}
        design |= {"target": None if target is None else {"half_width": target}}
        design |= {"budget": None if budget is None else f"{budget} s"}
        analysis = {key: options.pop(key, None) for key in _ANALYSIS}
        options["dependence"] = _dependence(options.get("dependence"), made)
        self._call: Call | RepeatedCall | None = None
        if callable(model):
            quantiles = {place: f.quantile for place, f in enumerate(made.values()) if f.quantile is not None}
            names = list(outputs) if outputs is not None else None
            lengths = _lengths(outputs) if isinstance(outputs, Mapping) else None
            self._call = Call(
                model, list(made), vectorised=vectorised, style=call, outputs=names, lengths=lengths, quantiles=quantiles
            )
            if repetitions > 1:
                self._call = RepeatedCall(self._call, list(made).index(noise["name"]), repetitions)
                outputs = outputs_of(outputs)
        elif any(factor.quantile is not None for factor in made.values()):
            raise StudyError("factors by their quantile functions serve functions of Python alone")
        table["model"] = "external" if callable(model) or model is None else model
        if isinstance(outputs, Mapping):
            options["external"] = {"outputs": _stated(outputs, {})}
        elif outputs is not None:
            table["outputs"] = list(outputs)
        elif table["model"] == "external":
            table["outputs"] = ["y"]
        tables = {"design": _said(design), "analysis": _said(analysis), **options}
        tables = {key: value for key, value in tables.items() if value}
        tables["factor"] = [{"name": key, **factor.keys} for key, factor in stated.items()]
        self._table = {**_said(table), **tables}
        self._study = self._parsed()
        # Rows that the function was tried with, and its answer.
        self._first: tuple[np.ndarray, np.ndarray] | None = None

    def _parsed(self) -> _engine.Study:
        table = {key: value for key, value in self._table.items() if value != []}
        return _engine.Study.parse(_toml.dumps(table), f"{self._table['name']}.toml", [])

    @classmethod
    def load(cls, path: str | os.PathLike[str], **overrides: Any) -> "Study":
        """The study of a file of the program, with changes by dotted keys: `load(path, **{"design.seed": 1})`."""
        return cls._of(_engine.Study.load(os.fspath(path), _overridden(overrides)))

    @classmethod
    def parse(cls, text: str, name: str = "study", **overrides: Any) -> "Study":
        """The study of a text in the format of study files."""
        return cls._of(_engine.Study.parse(text, f"{name}.toml", _overridden(overrides)))

    @classmethod
    def _of(cls, study: _engine.Study) -> "Study":
        made = cls.__new__(cls)
        made._table, made._call, made._study, made._first = {}, None, study, None
        return made

    def __repr__(self) -> str:
        factors = ", ".join(name for name, _ in self._study.factors)
        return f"<apportion.Study {self.name!r}: {self.runs} runs of {factors}>"

    @property
    def name(self) -> str:
        """Its name, after which files are called."""
        return self._study.name

    @property
    def factors(self) -> list[str]:
        """Names of the factors, in order."""
        return [name for name, _ in self._study.factors]

    @property
    def outputs(self) -> list[str]:
        """Names of the outputs, in order; of a function, once it has been called."""
        return [name for name, _ in self._study.outputs]

    @property
    def runs(self) -> int:
        """Model runs of the design; the first ones, if the run goes on until a target."""
        return self._study.runs

    @property
    def source(self) -> str:
        """The study file."""
        return self._study.source

    def sample(self) -> np.ndarray:
        """The points of all runs, (rows, factors) in the units of the factors."""
        points = self._study.sample(0, self._study.runs)
        return self._call.rows(points) if self._call is not None else points

    def analyse(self, outputs: Any) -> Result:
        """The result from outputs at the points of `sample`, in their order: (rows,) or (rows, outputs), or a mapping from
        names to (rows,), or to (rows, values) of a series. NaN says that a run failed."""
        if self._study.grows:
            raise StudyError("a study with an accuracy or a target chooses its runs as they go on: give it base_samples")
        if isinstance(outputs, Mapping):
            parts = {name: np.asarray(y, dtype=float) for name, y in outputs.items()}
            names = expanded(list(parts), {name: y.shape[1] for name, y in parts.items() if y.ndim == 2})
            outputs = np.column_stack(list(parts.values()))
        else:
            outputs = np.asarray(outputs, dtype=float)
            outputs = outputs.reshape(len(outputs), -1)
            names = None
        if names is None and outputs.shape[1] != len(self.outputs):
            names = [f"y{k + 1}" for k in range(outputs.shape[1])]
        if names is not None and names != self.outputs:
            if not self._study.is_external or "outputs" not in self._table or self._table["outputs"] != ["y"]:
                raise StudyError(f"the outputs are {names}, and those of the study are {self.outputs}")
            self._table["outputs"] = names
            self._study = self._parsed()
        return Result(self._study.analyse(np.ascontiguousarray(outputs)))

    def evaluate(self, points: Any) -> np.ndarray:
        """The outputs of the model at `points` (rows, factors), in their units: (rows, outputs), NaN where a run failed."""
        points = np.atleast_2d(np.asarray(points, dtype=float))
        failed: list[tuple[int, str]]
        if self._call is None:
            values, of_outputs = self._study.evaluate(points)
            failed = [(row, reason) for row, _, reason in of_outputs]
        else:
            self._learn()
            values, failed = self._call.evaluate(points)
        if failed:
            rows = len({row for row, _ in failed})
            warnings.warn(f"{rows} of {len(points)} rows failed: {failed[0][1]}", stacklevel=2)
        return values

    def run(
        self,
        *,
        threads: int = 0,
        executor: Any = None,
        in_flight: int | None = None,
        journal: str | os.PathLike[str] | None = None,
        resume: str = "if-there",
        progress: bool | Callable[[int, int], None] | None = None,
    ) -> Result:
        """Runs the study and estimates its indices.

        `threads`: of the engine; 0 for one per core. `executor`: any executor of `concurrent.futures` or of its kind, which
        gets blocks of rows, `in_flight` at a time. `journal`: a file that keeps what is evaluated; the same call goes on
        where it was interrupted (`resume` may also be "require", "retry-failed" or "never"). `progress`: True for a bar by
        tqdm, a function of (done, total), False for nothing; by default a bar, if tqdm is there and somebody looks.
        """
        stop = _engine.Stop()
        function = self._function(stop, executor, in_flight)
        path = None if journal is None else os.fspath(journal)
        with _Progress(progress, self.name) as bar:
            result = self._study.run(
                function, stop, threads=threads, journal=path, resume=resume, progress=bar.callback, message=_say
            )
        return Result(result)

    def screen(
        self,
        trajectories: int = 32,
        *,
        levels: int | None = None,
        derivatives: bool = False,
        seed: int | None = None,
        threads: int = 0,
    ) -> Document:
        """Elementary effects: which of many factors matter, for a few runs each. Radial (Campolongo et al. 2011), or with
        `levels` the trajectories of Morris (1991) on a grid; with `derivatives` short steps, for the mean squares of derivatives and
        what total indices are at most (Sobol' and Kucherenko 2009)."""
        if derivatives and levels is not None:
            raise StudyError("levels are of no account to derivatives: leave out one of them")
        stop = _engine.Stop()
        function = self._function(stop, None, None)
        document = self._study.screen(
            function,
            stop,
            trajectories=trajectories,
            levels=levels,
            derivatives=derivatives,
            seed=seed,
            threads=threads,
            progress=None,
        )
        return Document(document)

    def sweep(self, *factors: str, points: int = 101, against: str | None = None) -> Document:
        """One factor at a time over its range, every other at its nominal value; all of them if none is named."""
        stop = _engine.Stop()
        return Document(self._study.sweep(self._function(stop, None, None), stop, list(factors), points, against))

    def _function(self, stop: _engine.Stop, executor: Any, in_flight: int | None) -> dict[str, Any] | None:
        """What the engine calls."""
        if self._call is None:
            if executor is not None:
                raise StudyError("executors serve functions of Python; models of the engine run on its own threads")
            if self._study.is_external:
                raise StudyError("the study has no model: evaluate its sample() and pass the outputs to analyse()")
            return None
        self._learn()
        call, workers = self._here, 0
        if executor is not None:
            call, workers = called_elsewhere(executor, self._call, stop, in_flight)
        takes_its_time = executor is not None or not self._call.vectorised
        version = self._call.fingerprint()
        return {"call": call, "version": version, "workers": workers, "takes_its_time": takes_its_time}

    def _here(self, columns: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Calls the function on columns (factors, rows); the row that showed what it returns is not asked again."""
        assert self._call is not None
        x = columns.T
        if self._first is not None and not self._call.vectorised and np.array_equal(x, self._first[0]):
            return self._first[1], []
        return self._call.evaluate(x)

    def _learn(self) -> None:
        """Calls the function once, which shows the names of its outputs; its exceptions are the caller's."""
        call = self._call
        if call is None or self._first is not None:
            return
        x = self._study.sample(0, _PROBED if call.vectorised else 1)
        self._first = (x, call.probe(x))
        if call.columns == self.outputs:
            return
        if call.lengths:
            stated = self._table.pop("external", {"outputs": {}})["outputs"]
            stated = {name: stated.get(name, "1") for name in call.outputs or []}
            self._table.pop("outputs", None)
            self._table["external"] = {"outputs": _stated(stated, call.lengths)}
        else:
            self._table["outputs"] = call.outputs
        self._study = self._parsed()


def analyse(model: Callable[..., Any] | str | None, factors: Mapping[str, Any] | None = None, **options: Any) -> Result:
    """Runs a study and estimates its indices: `Study(model, factors, ...)` and its `run(...)` in one call."""
    running = ("threads", "executor", "in_flight", "journal", "resume", "progress")
    of_run = {key: options.pop(key) for key in running if key in options}
    return Study(model, factors, **options).run(**of_run)


def _lengths(outputs: Mapping[str, Any]) -> dict[str, int | None]:
    """Of the outputs that are series how many values they have, as far as that is said."""
    lengths: dict[str, int | None] = {}
    for name, of in outputs.items():
        if isinstance(of, Mapping) and set(of) - {"unit"}:
            positions = np.atleast_1d(of.get("positions", ()))
            lengths[name] = of.get("length", len(positions) if len(positions) > 2 else None)
    return lengths


def _stated(outputs: Mapping[str, Any], lengths: Mapping[str, int | None]) -> dict[str, Any]:
    """The outputs of the study file; a series whose length is not known yet has two values."""
    lengths = {**{name: length or 2 for name, length in _lengths(outputs).items()}, **lengths}
    stated: dict[str, Any] = {}
    for name, of in outputs.items():
        if name not in lengths:
            stated[name] = of
            continue
        of = {"unit": of} if isinstance(of, str) else dict(of)
        positions = of.pop("positions", None)
        of |= {} if positions is None else {"positions": np.asarray(positions, dtype=float).tolist()}
        stated[name] = {**of, "length": lengths[name]}
    return stated


def _dependence(asked: Any, factors: Mapping[str, Factor]) -> list[dict[str, Any]]:
    """The tables of `dependence`, from these or from correlations by pairs of factors."""
    if asked is None:
        return []
    if isinstance(asked, Mapping) and "factors" in asked:
        asked = [asked]
    elif isinstance(asked, Mapping):
        asked = [{"factors": list(pair), "correlation": correlation} for pair, correlation in asked.items()]
    tables = [dict(table) for table in asked]
    for table in tables:
        for key in ("correlation", "measurements"):
            if hasattr(table.get(key), "__array__"):
                table[key] = np.asarray(table[key], dtype=float).tolist()
        by_quantile = [n for n in table.get("factors", ()) if n in factors and factors[n].quantile is not None]
        is_measured = "file" in table or "measurements" in table
        if by_quantile and table.get("measure", "pearson") == "pearson" and not is_measured:
            raise StudyError(
                f"{', '.join(by_quantile)}: Pearson's correlations of factors by their quantile functions are not known: expected "
                'measure="spearman", "kendall" or "normal"'
            )
    return tables


def _said(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if value is not None}


def _overridden(overrides: Mapping[str, Any]) -> list[str]:
    return [f"{key}={_toml._value(value)}" for key, value in overrides.items()]


def _say(line: str) -> None:
    if line.startswith("warning: "):
        warnings.warn(line.removeprefix("warning: "), stacklevel=4)
    else:
        print(line, file=sys.stderr)


class _Progress:
    """Tells how far a run has come."""

    def __init__(self, asked: bool | Callable[[int, int], None] | None, name: str):
        self.asked, self.name = asked, name
        self.begun = time.monotonic()
        self.bar: Any = None
        self.make: Any = None
        if asked is True or asked is None and _is_watched():
            try:
                from tqdm.auto import tqdm

                self.make = tqdm
            except ImportError:
                if asked is True:
                    raise ImportError("progress=True needs tqdm: pip install tqdm") from None

    @property
    def callback(self) -> Callable[[int, int, int, int], None] | None:
        if callable(self.asked):
            return lambda done, total, failed, recalled: self.asked(done, total)  # type: ignore[operator, misc]
        return self._draw if self.make is not None else None

    def _draw(self, done: int, total: int, failed: int, recalled: int) -> None:
        # Short runs need no bar.
        if self.bar is None and time.monotonic() - self.begun < 1.0:
            return
        if self.bar is None:
            self.bar = self.make(total=total, desc=self.name, unit="run", unit_scale=True)
        self.bar.total = total
        self.bar.update(done - self.bar.n)

    def __enter__(self) -> "_Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or bool(getattr(sys.stderr, "isatty", lambda: False)())
