"""Studies: what is asked, and the runs that answer it."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from . import _engine, _toml
from ._answers import AnswerError, NoAnswer, expanded
from ._checks import MAX_SEED, MAX_THREADS, whole
from ._distributions import Seed
from ._engine import RunError, StudyError
from ._executors import called_elsewhere, workers_of
from ._functions import Call, reason_of, unnamed, with_hint
from ._identity import name_of
from ._keys import (
    RUN,
    AnalysisOptions,
    DesignOptions,
    Estimator,
    Failures,
    IndicesOf,
    Intervals,
    Measure,
    Resume,
    Sampler,
    StudyOptions,
    Style,
    Surrogate,
    dependence_tables,
    factors_of,
    lengths_of,
    overridden,
    refuse_unknown,
    said,
    stated_outputs,
)
from ._progress import Progress, say
from ._repeated import RepeatedCall, outputs_of, taken_out
from ._result import Document, Result
from ._tables import in_order, named, numbers, placed, series_name
from ._warnings import warn

if TYPE_CHECKING:
    from typing_extensions import Unpack

# Base points at which a function is tried, until it answers.
_TRIED = 8
_MAX_TRAJECTORIES, _MAX_LEVELS, _MAX_POINTS = 2**32, 2**16, 10**6


class Study:
    """A model, the factors to compare, and the number of model runs.

    The keywords are those of `analyse` that are not about the run.
    """

    def __init__(
        self,
        model: Callable[..., Any] | str | None,
        factors: Mapping[str, Any] | None = None,
        **keywords: Unpack[StudyOptions],
    ):
        refuse_unknown(keywords, StudyOptions.__annotations__)
        options: dict[str, Any] = said(keywords)
        vectorised, outputs, call = options.pop("vectorised", True), options.pop("outputs", None), options.pop("call", None)
        vectorised = options.pop("vectorized", vectorised)
        self._version: str | None = options.pop("version", None)
        self._is_long_by_default = callable(model) and not vectorised and not {"base_samples", "runs", "accuracy"} & set(options)
        if isinstance(options.get("seed"), np.random.Generator):
            options["seed"] = int(options["seed"].integers(2**63 - 1))
        if "max_time" in options:
            options["max_time"] = f"{options['max_time']} s"
        noise = options.pop("noise", None)
        if isinstance(outputs, str):
            outputs = [outputs]
        made = factors_of(factors)
        repetitions = 1
        if isinstance(noise, Mapping):
            if callable(model):
                noise, repetitions = taken_out(noise)
            # The engine makes a factor of it, behind all others.
            options["noise"] = {"name": "seed", **noise}
            noise = str(options["noise"]["name"])
            stated, made = dict(made), {**made, noise: Seed()}
        else:
            made |= {} if noise is None else {noise: Seed()}
            stated = made
        options["dependence"] = dependence_tables(options.get("dependence"), made)
        self._call: Call | RepeatedCall | None = None
        if callable(model):
            quantiles = {place: f.quantile for place, f in enumerate(made.values()) if f.quantile is not None}
            names = list(outputs) if outputs is not None else None
            lengths = lengths_of(outputs) if isinstance(outputs, Mapping) else None
            self._call = Call(
                model, list(made), vectorised=vectorised, style=call, outputs=names, lengths=lengths, quantiles=quantiles
            )
            if repetitions > 1:
                self._call = RepeatedCall(self._call, list(made).index(str(noise)), repetitions)
                outputs = outputs_of(outputs)
        elif any(factor.quantile is not None for factor in made.values()):
            raise StudyError("factors by their quantile functions work only with functions of Python")
        table: dict[str, Any] = {"model": "external" if callable(model) or model is None else model, "name": "study"}
        if isinstance(outputs, Mapping):
            table["outputs"] = stated_outputs(outputs, {})
        elif outputs is not None:
            table["outputs"] = list(outputs)
        elif table["model"] == "external":
            table["outputs"] = [unnamed(made)]
        for key, of in {"design": DesignOptions, "analysis": AnalysisOptions}.items():
            table[key] = {name: options.pop(name) for name in of.__annotations__ if name in options}
        factor = [{"name": key, **factor.keys} for key, factor in stated.items()]
        self._table = {key: value for key, value in {**table, **options, "factor": factor}.items() if value not in ({}, [])}
        self._parse()
        # Rows that a function of one row was tried with, as bytes, and its answers or why there is none; None before.
        self._tried: dict[bytes, np.ndarray | str] | None = None

    def _parse(self) -> None:
        self._made_from = _text_of(self._table)
        self._study = _parsed(self._made_from)

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in vars(self).items() if key != "_study"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._study = _engine.Study.parse(*self._made_from)

    @classmethod
    def load(cls, path: str | os.PathLike[str], **overrides: Any) -> "Study":
        """The study of a file of the program, with changes by dotted keys: `load(path, **{"design.seed": 1})`."""
        path, changes = os.fspath(path), overridden(overrides)
        study = _engine.Study.load(path, changes)
        return cls._of(study, (study.source, os.path.abspath(path), changes))

    @classmethod
    def parse(cls, text: str, name: str = "study", **overrides: Any) -> "Study":
        """The study of a text in the format of study files."""
        made_from = (text, f"{name}.toml", overridden(overrides))
        return cls._of(_engine.Study.parse(*made_from), made_from)

    @classmethod
    def _of(cls, study: _engine.Study, made_from: tuple[str, str, list[str]]) -> "Study":
        made = cls.__new__(cls)
        made._table, made._call, made._study, made._made_from, made._tried = {}, None, study, made_from, None
        made._is_long_by_default, made._version = False, None
        return made

    def __repr__(self) -> str:
        factors = ", ".join(name for name, _ in self._study.factors)
        return f"<apportion.Study {self.name!r}: {self.runs} runs of {factors}>"

    @property
    def name(self) -> str:
        """Its name, which is also that of its files."""
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
        points = self._study.sample(0, self._study.runs, 1)
        return self._call.rows(points) if self._call is not None else points

    def analyse(self, outputs: Any) -> Result:
        """The result from outputs at the points of `sample`, in their order: (rows,) or (rows, outputs), or a mapping or frame of
        (rows,) by the names of the outputs, in any order, in a mapping also of (rows, values) of a series. Names that the study does
        not state are those of the frame, or of a `pandas.Series`. NaN, masked and missing values mean a failed run."""
        if self._study.grows:
            raise StudyError("a study with an accuracy or limits chooses its rows during the run: set base_samples instead")
        # The names of the outputs are unknown.
        is_unnamed = self._study.is_external and self._table.get("outputs") == [unnamed(self.factors)]
        outputs = in_order(outputs)
        columns = named(outputs, "the outputs have")
        if columns is None:
            y = numbers(outputs, "the outputs are")
            if y.ndim == 0 or y.size == 0:
                raise StudyError(f"outputs of shape {y.shape}: expected {self.runs} rows, (rows,) or (rows, outputs)")
            y = y.reshape(len(y), -1)
            if y.shape[1] != len(self.outputs) and not is_unnamed:
                raise StudyError(f"outputs of shape {y.shape}: expected ({self.runs}, {len(self.outputs)}), of {', '.join(self.outputs)}")
            names = self.outputs if y.shape[1] == len(self.outputs) else [f"y{k + 1}" for k in range(y.shape[1])]
            names = [series_name(outputs) or names[0]] if is_unnamed and len(names) == 1 else names
            columns = dict(zip(names, y.T))
        else:
            columns = self._split(columns)
        study = self._study
        if is_unnamed and set(columns) != set(self.outputs):
            study = _parsed(_text_of({**self._table, "outputs": list(columns)}))
        names = [name for name, _ in study.outputs]
        return _with_warnings(Result(study.analyse(np.column_stack(placed(columns, names, "the outputs come")))))

    def _split(self, columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """The columns of the engine: those of series one by one."""
        split: dict[str, np.ndarray] = {}
        for name, y in columns.items():
            if y.ndim not in (1, 2) or len(y) != self.runs:
                raise StudyError(f"the output {name} has the shape {y.shape}: expected ({self.runs},), or ({self.runs}, values)")
            of = expanded([name], {name: y.shape[1]}) if y.ndim == 2 else [name]
            split |= zip(of, y.reshape(len(y), -1).T)
        if not split:
            raise StudyError("the outputs have no columns")
        return split

    def evaluate(self, points: Any) -> np.ndarray:
        """The outputs of the model at `points`, in the units of the factors: (rows, outputs), NaN where a run failed.

        `points` are an array of (rows, factors), or a mapping or frame whose columns have the names of the factors, in any order.
        """
        columns = named(points, "the points have")
        if columns is None:
            points = np.atleast_2d(numbers(points, "the points are"))
        else:
            points = np.column_stack(placed(columns, self.factors, "the points come"))
        if points.ndim != 2 or points.shape[1] != len(self.factors):
            raise StudyError(f"points of shape {points.shape}: expected (rows, {len(self.factors)}), of {', '.join(self.factors)}")
        failed: list[tuple[int, str]]
        if self._call is None:
            values, of_outputs = self._study.evaluate(points)
            failed = [(row, reason) for row, _, reason in of_outputs]
        else:
            self._learn()
            values, failed = self._call.evaluate(points)
        if failed:
            rows = len({row for row, _ in failed})
            warn(f"{rows} of {len(points)} rows failed: {failed[0][1]}")
        return values

    def run(
        self,
        *,
        threads: int = 0,
        executor: Any = None,
        in_flight: int | None = None,
        journal: str | os.PathLike[str] | None = None,
        resume: Resume = "if-there",
        progress: bool | Callable[[int, int], None] | None = None,
    ) -> Result:
        """Runs the study and estimates its indices. Warnings of the result are Python warnings; if no output has an index, because all
        runs failed or it does not vary, a `RunError` states the reason, and its `result` has the rest.

        `threads`: of the engine; 0 for one per core. `executor`: any executor of `concurrent.futures` or of its kind, which
        gets blocks of rows, `in_flight` at a time. `journal`: a file that keeps evaluated runs; the same call resumes
        an interrupted run (`resume` may also be "require", "retry-failed" or "never"). `progress`: True for a bar by
        tqdm, or a line a minute without it, a function of (done, total), False for nothing; by default True, if the output is
        interactive.
        """
        threads = whole("threads", threads, 0, MAX_THREADS)
        stop = _engine.Stop()
        function = self._function(stop, executor, in_flight, journal is not None)
        if self._is_long_by_default:
            say(f"{self.name}: {self.runs} runs of the function; fewer with base_samples=, runs= or accuracy=")
        path = None if journal is None else os.fspath(journal)
        with Progress(progress, self.name) as bar:
            result = self._study.run(
                function, stop, threads=threads, journal=path, resume=resume, progress=bar.callback, message=say
            )
        return _with_warnings(Result(result))

    def screen(
        self,
        trajectories: int = 32,
        *,
        levels: int | None = None,
        seed: int | None = None,
        threads: int = 0,
        executor: Any = None,
        in_flight: int | None = None,
        journal: str | os.PathLike[str] | None = None,
        resume: Resume = "if-there",
        progress: bool | Callable[[int, int], None] | None = None,
    ) -> Document:
        """Elementary effects: screening of many factors, with a few runs each. Radial (Campolongo et al. 2011), or with
        `levels` the trajectories of Morris (1991) on a grid. `executor`, `in_flight`, `journal`, `resume` and `progress` are those
        of `run`."""
        trajectories = whole("trajectories", trajectories, 1, _MAX_TRAJECTORIES)
        levels = None if levels is None else whole("levels", levels, 2, _MAX_LEVELS)
        seed = None if seed is None else whole("seed", seed, 0, MAX_SEED)
        threads = whole("threads", threads, 0, MAX_THREADS)
        stop = _engine.Stop()
        function = self._function(stop, executor, in_flight, journal is not None)
        # A trajectory at a time for each thread.
        threads = function["workers"] if function is not None and executor is not None else threads
        path = None if journal is None else os.fspath(journal)
        with Progress(progress, self.name) as bar:
            kept: dict[str, Any] = {"journal": path, "resume": resume, "progress": bar.callback, "message": say}
            document = self._study.screen(
                function, stop, trajectories=trajectories, levels=levels, seed=seed, threads=threads, **kept
            )
        return Document(document).warned()

    def sweep(
        self,
        *factors: str,
        points: int = 101,
        executor: Any = None,
        journal: str | os.PathLike[str] | None = None,
        resume: Resume = "if-there",
        progress: bool | Callable[[int, int], None] | None = None,
    ) -> Document:
        """Sweeps one factor at a time over its range, with all others at nominal values; every factor if none is named. `executor`,
        `journal`, `resume` and `progress` are those of `run`."""
        points = whole("points", points, 2, _MAX_POINTS)
        stop = _engine.Stop()
        function = self._function(stop, executor, is_kept=journal is not None)
        path = None if journal is None else os.fspath(journal)
        with Progress(progress, self.name) as bar:
            kept: dict[str, Any] = {"journal": path, "resume": resume, "progress": bar.callback, "message": say}
            document = self._study.sweep(function, stop, list(factors), points, **kept)
        return Document(document).warned()

    def _function(
        self, stop: _engine.Stop, executor: Any = None, in_flight: int | None = None, is_kept: bool = False
    ) -> dict[str, Any] | None:
        """What the engine calls."""
        if self._call is None:
            if executor is not None:
                raise StudyError("executors work only with functions of Python; models of the engine run on its own threads")
            if self._study.is_external:
                raise StudyError("the study has no model: evaluate its sample() and pass the outputs to analyse()")
            return None
        if executor is not None:
            in_flight = workers_of(executor, in_flight)
        version = self._call.identity(self._version) if is_kept else self._version or name_of(self._call.function)
        self._learn()
        call, workers = self._here, 0
        if executor is not None:
            call, workers = called_elsewhere(executor, self._call, stop), in_flight or 1
        is_slow = executor is not None or not self._call.vectorised
        return {"call": call, "version": version, "workers": workers, "is_slow": is_slow}

    def _here(self, columns: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Calls the function on columns (factors, rows); what it was tried with counts as the first call of these rows."""
        assert self._call is not None
        x = columns.T
        tried = self._tried or {}
        known = [(row, tried.pop(of.tobytes())) for row, of in enumerate(x) if of.tobytes() in tried] if tried else []
        if not known:
            return self._call.evaluate(self._call.rows(x))
        values = np.full((len(x), len(self._call.columns)), np.nan)
        others = np.setdiff1d(np.arange(len(x)), [row for row, _ in known])
        failures: list[tuple[int, str]] = []
        if len(others):
            values[others], failed = self._call.evaluate(self._call.rows(x[others]))
            failures = [(int(others[row]), reason) for row, reason in failed]
        for row, answer in known:
            if isinstance(answer, str):
                failures.append((row, answer))
            else:
                values[row] = answer
        return values, sorted(failures)

    def _learn(self) -> None:
        """Calls the function until it shows the names of its outputs, at rows of several base points: rows that fail before have
        failed. If all do, the first exception is the caller's."""
        call = self._call
        if call is None or self._tried is not None:
            return
        tried: dict[bytes, np.ndarray | str] = {}
        first: Exception | None = None
        has_answered = False
        # As many rows as factors would hide a function of one row in an array.
        count = (2 if len(call.names) != 2 else 3) if call.vectorised else 1
        rows_per_point = self._study.rows_per_point
        for row in range(0, min(_TRIED * rows_per_point, self.runs), rows_per_point):
            x = self._study.sample(row, row + count, 1)
            try:
                answer = call.probe(call.rows(x))[0]
                has_answered = True
            except Exception as error:
                if isinstance(error, AnswerError) and not isinstance(error, NoAnswer):
                    raise
                first = first or error
                answer = reason_of(error)
            if not call.vectorised:
                tried[x.tobytes()] = answer
            if has_answered:
                break
        if first is not None and not has_answered:
            raise with_hint(first, call.vectorised)
        self._tried = tried
        if call.columns == self.outputs:
            return
        if call.lengths:
            before = self._table.get("outputs")
            units = before if isinstance(before, Mapping) else {}
            stated = {name: units.get(name, "1") for name in call.outputs or []}
            self._table["outputs"] = stated_outputs(stated, call.lengths)
        else:
            self._table["outputs"] = call.outputs
        self._parse()


def _text_of(table: Mapping[str, Any]) -> tuple[str, str, list[str]]:
    """The study file of a table, its name, and no changes of it."""
    return _toml.dumps({key: value for key, value in table.items() if value != []}), f"{table['name']}.toml", []


def _parsed(made_from: tuple[str, str, list[str]]) -> _engine.Study:
    try:
        return _engine.Study.parse(*made_from)
    except StudyError as error:
        raise StudyError(error.problem) from None


def _with_warnings(result: Result) -> Result:
    """The result, with every warning of it warned of; a `RunError` if no output has an index."""
    records = result.to_dict()["outputs"]
    if all(record.get("indices") is None for record in records):
        why = [(record.get("reason") or {}).get("text", "it does not vary") for record in records[:3]]
        reasons = "; ".join(f"{record['name']}: {reason}" for record, reason in zip(records, why))
        error = RunError(f"there are no indices: {reasons}")
        error.result = result
        raise error
    return result.warned()


def analyse(
    model: Callable[..., Any] | str | None,
    factors: Mapping[str, Any] | None = None,
    *,
    outputs: Sequence[str] | Mapping[str, Any] | str | None = None,
    name: str = "study",
    title: str | None = None,
    vectorised: bool = True,
    vectorized: bool | None = None,
    call: Style | None = None,
    version: str | None = None,
    base_samples: int | None = None,
    runs: int | None = None,
    accuracy: float | None = None,
    smallest_region: float | None = None,
    max_runs: int | None = None,
    max_time: float | None = None,
    sampler: Sampler | None = None,
    replicates: int | None = None,
    seed: int | np.random.Generator | None = None,
    indices_of: IndicesOf | None = None,
    second_order: bool | None = None,
    subsets: Sequence[Sequence[str]] | None = None,
    estimators: Sequence[Estimator] | None = None,
    intervals: Intervals | None = None,
    surrogate: Surrogate | None = None,
    shapley: bool | None = None,
    measures: Sequence[Measure] | None = None,
    threshold: float | None = None,
    dummy: bool | None = None,
    convergence: bool | None = None,
    aggregate: bool | None = None,
    resamples: int | None = None,
    failures: Failures | None = None,
    max_failed: float | None = None,
    noise: str | Mapping[str, Any] | None = None,
    dependence: Mapping[Any, Any] | Sequence[Mapping[str, Any]] | Any = None,
    afm: Mapping[str, Any] | None = None,
    function: Mapping[str, Any] | None = None,
    expression: Mapping[str, Any] | None = None,
    fidelity: Mapping[str, Any] | None = None,
    threads: int = 0,
    executor: Any = None,
    in_flight: int | None = None,
    journal: str | os.PathLike[str] | None = None,
    resume: Resume = "if-there",
    progress: bool | Callable[[int, int], None] | None = None,
    **unknown: NoReturn,
) -> Result:
    """Runs a study and estimates its indices: `Study(model, factors, ...)` and its `run(...)` in one call.

    `model` is a function of Python, the name of a model of the engine ("ishigami", "afm", ...), or None if the outputs are
    computed elsewhere: see `sample` and `analyse`. `factors` maps names to distributions; a pair (min, max) is uniform.

    `outputs` are names, or a mapping from names to units. An output may be a series, with several values a row: an array of
    (rows, values), or of (values,) where `vectorised=False`, in a dict or tuple of outputs or as the only one that `outputs`
    names. The mapping describes its axis: `outputs={"infected": {"axis": "day", "unit": "%"}}`, with
    `axis_unit`, and `positions` (all, or the first one and the step).

    `noise="seed"` gives a stochastic model a seed with every row, as its last argument or by that name;
    `noise={"mean_totals": True}` adds the total indices of the mean over it, one more run of each base sample for each factor,
    and `noise={"repetitions": 8}` calls the function 8 times for each row: its outputs are then `y_mean` and `y_variance`.

    The length of a run: `base_samples` (N of the matrices A and B), or `runs` in all, or the `accuracy` that every index must reach,
    within `max_runs` and `max_time` (seconds), not missing any region of `smallest_region` of a factor's range (0.05 for functions of
    Python). By default 16,384 base samples.

    The design: `sampler` ("sobol", "random", "latin-hypercube"), `replicates` (independent scrambles, 4), `seed` (a whole number or
    a NumPy generator, from which a seed is drawn).

    What is estimated: indices of the factors, or with `indices_of="groups"` of their groups only (`Uniform(0, 1, group="soil")`), which
    takes N (G + 2) runs for G groups; `second_order` indices, closed indices of `subsets` of factors, `shapley` effects, `measures` ("delta", "pawn_median", ...), `aggregate` indices of all outputs, further `estimators`
    ("janon-monod", ...), `intervals` ("nets", "percentile", "delta", with `resamples`), `surrogate` ("auto", "on", "off"),
    a `dummy` factor, `convergence`, and the `threshold` of the total index that a factor is compared with.

    Failed runs: `failures` ("drop-block" or "fail") and `max_failed`, the largest share of failed runs.

    Tables of a study file: `afm={...}`, `function={...}`, `expression={...}` (constants), `fidelity={...}` (cheaper models).
    Factors that depend on each other, by a Gaussian copula: `dependence={("a", "b"): 0.6}`, Pearson's correlations, or the matrix of all (`np.corrcoef(rows.T)`, `df.corr()`), or a list of
    tables as in a study file, as in `[{"factors": ["a", "b"], "correlation": 0.6, "measure": "spearman"}]`; or from
    joint measurements, one in each row: `[{"factors": ["a", "b"], "measurements": array}]`.

    The run: `threads`, `executor`, `in_flight`, `journal`, `resume`, `progress`, see `Study.run`. `version` tells a function from
    its earlier states in a journal, where its code does not.
    """
    keywords = {key: value for key, value in locals().items() if key not in ("model", "factors", "unknown")}
    of_run = {key: keywords.pop(key) for key in RUN}
    return Study(model, factors, **keywords, **unknown).run(**of_run)


_parameters = inspect.signature(analyse).parameters
Study.__signature__ = inspect.Signature([of for key, of in _parameters.items() if key not in RUN])  # type: ignore[attr-defined]
