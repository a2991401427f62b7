"""Problems of SALib: what their entries mean, and points of the engine for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._checks import MAX_SEED, whole
from .._distributions import Factor, LogNormal, LogUniform, Normal, Triangular, TruncatedNormal, Uniform, Weibull
from .._engine import StudyError
from .._study import Study

Seed = int | np.random.Generator | None


def from_problem(problem: Mapping[str, Any]) -> dict[str, Factor]:
    """The factors of a problem of SALib: `names`, `bounds`, and perhaps `dists` and `groups`."""
    for key in ("names", "bounds"):
        if key not in problem:
            raise StudyError(f"the problem has no {key!r}")
    names, bounds = list(problem["names"]), list(problem["bounds"])
    dists = list(problem.get("dists") or ["unif"] * len(names))
    groups = list(problem.get("groups") or [None] * len(names))
    if not len(names) == len(bounds) == len(dists) == len(groups):
        raise StudyError("the problem has lists of different lengths: names, bounds, dists and groups go together")
    if problem.get("num_vars", len(names)) != len(names):
        raise StudyError(f"num_vars is {problem['num_vars']}, and there are {len(names)} names")
    # A factor that is a group of its own needs none.
    groups = [None if group == name or groups.count(group) == 1 else group for name, group in zip(names, groups)]
    return {name: _factor(dist, list(bound), group) for name, dist, bound, group in zip(names, dists, bounds, groups)}


def _factor(dist: str, bound: list[float], group: str | None) -> Factor:
    if dist == "unif":
        return Uniform(bound[0], bound[1], group=group)
    if dist == "logunif":
        return LogUniform(bound[0], bound[1], group=group)
    if dist == "triang":
        # SALib: lower bound, upper bound, and the peak as a share of the way; or, before 1.4.6, width and peak.
        low, high, peak = bound if len(bound) == 3 else (0.0, bound[0], bound[1])
        return Triangular(low, low + peak * (high - low), high, group=group)
    if dist == "norm":
        return Normal(bound[0], bound[1], group=group)
    if dist == "truncnorm":
        return TruncatedNormal(bound[2], bound[3], bound[0], bound[1], group=group)
    if dist == "lognorm":
        return LogNormal(log_mean=bound[0], log_sd=bound[1], group=group)
    if dist == "weibull":
        return Weibull(*bound, group=group)
    known = "unif, logunif, triang, norm, truncnorm, lognorm or weibull"
    raise StudyError(f"dists: {dist!r} is not known: expected {known}")


def members_of(problem: Mapping[str, Any]) -> dict[str, list[int]]:
    """What has indices, factors or groups in SALib's order, with the columns of each."""
    if "names" not in problem:
        raise StudyError("the problem has no 'names'")
    groups = list(problem.get("groups") or problem["names"])
    return {str(member): [k for k, group in enumerate(groups) if group == member] for member in dict.fromkeys(groups)}


def generator(seed: Seed) -> np.random.Generator:
    """NumPy's generator of a seed, which is a whole number, a generator, or None for another one in each call."""
    is_number = not (seed is None or isinstance(seed, np.random.Generator))
    return np.random.default_rng(whole("seed", seed, 0, MAX_SEED) if is_number else seed)


def points(problem: Mapping[str, Any], N: int, seed: Seed, halves: int = 1, skipped: int = 0, **design: Any) -> np.ndarray:
    """(N, halves * factors): base points of a design of the engine in the units of the factors, `skipped` ones left out."""
    N = whole("N", N, 1, 2**53)
    if seed is None or isinstance(seed, np.random.Generator):
        seed = int(generator(seed).integers(2**63 - 1))
    seed = whole("seed", seed, 0, 2**63 - 1)
    columns = {f"{half}.{k}": f for half in range(halves) for k, f in enumerate(from_problem(problem).values())}
    plain = {name: Factor({key: value for key, value in f.keys.items() if key != "group"}) for name, f in columns.items()}
    study = Study(None, plain, base_samples=N + skipped, replicates=1, seed=seed, **design)
    # The first row of a base point has its coordinates in all columns.
    rows = study._study.rows_per_point
    return study._study.sample(skipped * rows, study.runs, rows)
