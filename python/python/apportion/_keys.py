"""Keywords, and the tables of a study file that they make."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, TypedDict

import numpy as np

from ._distributions import Factor
from ._engine import StudyError
from ._toml import value_of

Sampler = Literal["sobol", "random", "latin-hypercube"]
IndicesOf = Literal["factors", "groups"]
Intervals = Literal["nets", "replicates", "batches", "delta", "percentile"]
Surrogate = Literal["auto", "on", "off"]
Failures = Literal["drop-block", "fail"]
Measure = Literal["delta", "pawn_median", "pawn_max", "r2_hsic", "fourier"]
Style = Literal["columns", "keywords", "matrix"]
Resume = Literal["if-there", "require", "retry-failed", "never"]
Estimator = Literal[
    "default", "sobol-1993", "homma-saltelli", "saltelli-2002", "sobol-2007", "saltelli-2010", "jansen", "janon-monod",
    "martinez", "glen-isaacs", "azzini",
]


class DesignOptions(TypedDict, total=False):
    """Keys of the table `[design]` of a study file."""

    sampler: Sampler | None
    base_samples: int | None
    runs: int | None
    replicates: int | None
    seed: int | np.random.Generator | None
    max_runs: int | None
    max_time: float | None


class AnalysisOptions(TypedDict, total=False):
    """Keys of the table `[analysis]`."""

    estimators: Sequence[Estimator] | None
    second_order: bool | None
    subsets: Sequence[Sequence[str]] | None
    indices_of: IndicesOf | None
    shapley: bool | None
    measures: Sequence[Measure] | None
    aggregate: bool | None
    dummy: bool | None
    convergence: bool | None
    intervals: Intervals | None
    surrogate: Surrogate | None
    resamples: int | None
    threshold: float | None
    failures: Failures | None
    max_failed: float | None


class TableOptions(TypedDict, total=False):
    """Tables and keys of the study file that are keywords themselves."""

    name: str
    title: str | None
    accuracy: float | None
    smallest_region: float | None
    dependence: Mapping[Any, Any] | Sequence[Mapping[str, Any]] | Any
    noise: str | Mapping[str, Any] | None
    afm: Mapping[str, Any] | None
    function: Mapping[str, Any] | None
    expression: Mapping[str, Any] | None
    fidelity: Mapping[str, Any] | None


class StudyOptions(DesignOptions, AnalysisOptions, TableOptions, total=False):
    """Keywords of `Study`; `analyse` has their meaning."""

    outputs: Sequence[str] | Mapping[str, Any] | str | None
    vectorised: bool
    vectorized: bool | None
    call: Style | None
    version: str | None


# Keywords of a run, which `analyse` takes too.
RUN = ("threads", "executor", "in_flight", "journal", "resume", "progress")
# What other packages call them.
_OTHERS = {
    "N": "base_samples",
    "n": "base_samples",
    "n_samples": "base_samples",
    "budget": "max_time",
    "target": "accuracy",
    "calc_second_order": "second_order",
    "n_jobs": "threads",
    "workers": "threads",
    "random_state": "seed",
}


def refuse_unknown(keywords: Mapping[str, Any], known: Iterable[str]) -> None:
    """A `StudyError` for the first unknown keyword, with the probable one."""
    known = list(known)
    for keyword, value in keywords.items():
        if keyword in known:
            continue
        near = difflib.get_close_matches(keyword, known, 1)
        meant = _OTHERS.get(keyword, near[0] if near else None)
        hint = f"did you mean {meant}?" if meant in known else f"expected one of {', '.join(known)}"
        if meant is None and (isinstance(value, (Factor, tuple)) or hasattr(value, "ppf")):
            hint = f'factors come as a mapping, as in {{"{keyword}": {value!r:.40}}}'
        if meant in RUN and meant not in known:
            hint = f"did you mean {meant}, which run() and analyse() take?"
        raise StudyError(f"unknown keyword {keyword}: {hint}")


def factors_of(factors: Any) -> dict[str, Factor]:
    """The factors by their names, from any form of a factor."""
    if factors is None:
        return {}
    if not isinstance(factors, Mapping):
        raise StudyError(f'factors: {factors!r:.80} is not a mapping from names to distributions, such as {{"x1": (0, 1)}}')
    for name in factors:
        if not isinstance(name, str):
            raise StudyError(f"factors: the name {name!r} is not a text: expected a name such as {str(name)!r}")
    return {str(name): Factor.of(value) for name, value in factors.items()}


def lengths_of(outputs: Mapping[str, Any]) -> dict[str, int | None]:
    """The number of values of every output that is a series, as far as it is stated."""
    lengths: dict[str, int | None] = {}
    for name, of in outputs.items():
        if isinstance(of, Mapping) and set(of) - {"unit"}:
            positions = np.atleast_1d(of.get("positions", ()))
            lengths[name] = of.get("length", len(positions) if len(positions) > 2 else None)
    return lengths


def stated_outputs(outputs: Mapping[str, Any], lengths: Mapping[str, int | None]) -> dict[str, Any]:
    """The outputs of the study file; a series whose length is not known yet has two values."""
    lengths = {**{name: length or 2 for name, length in lengths_of(outputs).items()}, **lengths}
    stated: dict[str, Any] = {}
    for name, of in outputs.items():
        if name not in lengths:
            stated[name] = of
            continue
        of = {"unit": of} if isinstance(of, str) else dict(of)
        positions = of.pop("positions", None)
        if positions is None and "axis_unit" in of:
            raise StudyError(f"the output {name} has an axis_unit: state its positions, all or the first one and the step")
        of |= {} if positions is None else {"positions": np.asarray(positions, dtype=float).tolist()}
        stated[name] = {**of, "length": lengths[name]}
    return stated


def dependence_tables(asked: Any, factors: Mapping[str, Factor]) -> list[dict[str, Any]]:
    """The tables of `dependence`, from these or from correlations by pairs of factors."""
    if asked is None:
        return []
    if isinstance(asked, Mapping) and "factors" in asked:
        asked = [asked]
    elif np.ndim(asked) == 2 and hasattr(asked, "__array__"):
        matrix = np.array(asked, dtype=float)
        # Those of np.corrcoef and of pandas are rounded.
        if matrix.shape[0] == matrix.shape[1] and np.allclose(matrix, matrix.T) and np.allclose(np.diag(matrix), 1.0):
            matrix = (matrix + matrix.T) / 2
            np.fill_diagonal(matrix, 1.0)
        asked = [{"factors": list(map(str, getattr(asked, "columns", factors))), "correlation": matrix}]
    elif isinstance(asked, Mapping):
        asked = [{"factors": list(pair), "correlation": correlation} for pair, correlation in asked.items()]
    if not isinstance(asked, (list, tuple)) or not all(isinstance(table, Mapping) for table in asked):
        raise StudyError(
            f'dependence={asked!r:.80}: expected correlations by pairs, as {{("a", "b"): 0.6}}, a matrix of all, or a list of tables'
        )
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


def said(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if value is not None}


def overridden(overrides: Mapping[str, Any]) -> list[str]:
    return [f"{key}={value_of(value)}" for key, value in overrides.items()]
