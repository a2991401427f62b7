"""SALib's way: a problem as a dict, its layouts of rows and its keys of results, on the engine.

The rest of a script that was written for SALib runs with these two changes:

    from apportion import salib
    X = salib.sample(problem, 1024)            # SALib.sample.sobol.sample
    Si = salib.analyze(problem, Y)             # SALib.analyze.sobol.analyze

`from_problem` turns the problem into the factors of `apportion.analyse`, which needs fewer runs for the same accuracy.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _engine
from ._checks import MAX_SEED, whole
from ._distributions import Factor, LogNormal, LogUniform, Normal, Triangular, TruncatedNormal, Uniform
from ._engine import StudyError
from ._study import Study
from ._tables import numbers

__all__ = ["Sensitivities", "analyze", "from_problem", "sample"]

# As the program has it.
_MAX_RESAMPLES = 10**6
_MIN_RESAMPLES = 100


def from_problem(problem: Mapping[str, Any]) -> dict[str, Factor]:
    """The factors of a problem of SALib: `names`, `bounds`, and perhaps `dists` and `groups`."""
    names = list(problem["names"])
    bounds = list(problem["bounds"])
    dists = list(problem.get("dists") or ["unif"] * len(names))
    groups = list(problem.get("groups") or [None] * len(names))
    if not len(names) == len(bounds) == len(dists) == len(groups):
        raise StudyError("the problem has lists of different lengths: names, bounds, dists and groups go together")
    if problem.get("num_vars", len(names)) != len(names):
        raise StudyError(f"num_vars is {problem['num_vars']}, but there are {len(names)} names")
    # A factor that forms a group alone needs none.
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
    raise StudyError(f"dists: {dist!r} is unknown: expected unif, logunif, triang, norm, truncnorm or lognorm")


def _members(problem: Mapping[str, Any]) -> list[tuple[str, list[int]]]:
    """What has indices, factors or groups in SALib's order, with the columns of each."""
    names = list(problem["names"])
    groups = problem.get("groups") or names
    return [(member, [k for k, group in enumerate(groups) if group == member]) for member in dict.fromkeys(groups)]


def sample(problem: Mapping[str, Any], N: int, *, calc_second_order: bool = True, seed: int = 0) -> np.ndarray:
    """Points in SALib's order: for each of `N` base points the rows A, AB_1 ... AB_d, BA_1 ... BA_d (with second order), B.

    Scrambled Sobol' points of the engine, randomised by `seed`; N is best a power of two.
    """
    N, seed = whole("N", N, 1, 2**53), whole("seed", seed, 0, 2**63 - 1)
    factors = from_problem(problem)
    d = len(factors)
    base = {f"{half}{k}": f for half in "ab" for k, f in enumerate(factors.values())}
    plain = {name: Factor({key: value for key, value in f.keys.items() if key != "group"}) for name, f in base.items()}
    study = Study(None, plain, base_samples=N, replicates=1, seed=seed)
    # The first row of a base point has its coordinates in all 2d columns.
    both = study._study.sample(0, study.runs, study._study.rows_per_point)
    a, b = both[:, :d], both[:, d:]
    members = _members(problem)

    def mixed(of: np.ndarray, other: np.ndarray) -> list[np.ndarray]:
        swapped = []
        for _, columns in members:
            row = of.copy()
            row[:, columns] = other[:, columns]
            swapped.append(row)
        return swapped

    blocks = [a, *mixed(a, b), *(mixed(b, a) if calc_second_order else []), b]
    return np.stack(blocks, axis=1).reshape(-1, d)


class Sensitivities(dict):
    """What SALib's `analyze` returns: S1, S1_conf, ST, ST_conf and, with second order, S2 and S2_conf."""

    def __init__(self, values: Mapping[str, Any], names: list[str]):
        super().__init__(values)
        self.names = names

    def to_df(self) -> list[Any]:
        """Frames of total, first-order and second-order indices, as SALib's."""
        import pandas as pd

        frames = [pd.DataFrame({key: self[key], f"{key}_conf": self[f"{key}_conf"]}, index=self.names) for key in ("ST", "S1")]
        if "S2" in self:
            pairs = [(j, k) for j in range(len(self.names)) for k in range(j + 1, len(self.names))]
            data = {key: [self[key][j, k] for j, k in pairs] for key in ("S2", "S2_conf")}
            frames.append(pd.DataFrame(data, index=[(self.names[j], self.names[k]) for j, k in pairs]))
        return frames


def analyze(
    problem: Mapping[str, Any],
    Y: Any,
    *,
    calc_second_order: bool = True,
    num_resamples: int = 100,
    conf_level: float = 0.95,
    print_to_console: bool = False,
    seed: int = 0,
) -> Sensitivities:
    """Indices by SALib's estimators from the outputs `Y` at points of `sample`, or of SALib's own.

    `*_conf` are half widths of the percentile bootstrap's 95 % intervals (of at least 100 resamples; without any, of intervals by
    the delta method); other levels are not offered. A `nan` in `Y` leaves its base point out, with a warning.
    """
    num_resamples = whole("num_resamples", num_resamples, 0, _MAX_RESAMPLES)
    seed = whole("seed", seed, 0, MAX_SEED)
    if conf_level != 0.95:
        raise StudyError("conf_level: only intervals of 95 % are available")
    names = [member for member, _ in _members(problem)]
    y = numbers(Y, "the outputs are").ravel()
    resamples = max(num_resamples, _MIN_RESAMPLES) if num_resamples else 0
    first, total, pairs, told = _engine.salib_indices(
        y, len(names), second_order=calc_second_order, resamples=resamples, seed=seed
    )
    for warning in told:
        warnings.warn(warning, stacklevel=2)

    def halves(triples: list[tuple[float, float, float]]) -> np.ndarray:
        return np.array([(high - low) / 2 for _, low, high in triples])

    values: dict[str, Any] = {
        "S1": np.array([index[0] for index in first]),
        "S1_conf": halves(first),
        "ST": np.array([index[0] for index in total]),
        "ST_conf": halves(total),
    }
    if calc_second_order:
        values |= {"S2": np.full((len(names),) * 2, np.nan), "S2_conf": np.full((len(names),) * 2, np.nan)}
        for j, k, triple in pairs:
            values["S2"][j, k] = triple[0]
            values["S2_conf"][j, k] = (triple[2] - triple[1]) / 2
    found = Sensitivities(values, names)
    if print_to_console:
        for frame in found.to_df():
            print(frame)
    return found
