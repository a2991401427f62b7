"""Sobol' indices from outputs in SALib's order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ... import _engine
from ..._checks import whole
from ..._indices import needed
from ..._tables import numbers
from ..._warnings import warn
from .._layout import rows_of
from .._problem import Seed, generator, members_of
from ..util import ResultDict, confidence

_MAX_RESAMPLES = 10**6


class Sensitivities(ResultDict):
    """S1, S1_conf, ST, ST_conf and, with second order, S2 and S2_conf, (D,) and (D, D), NaN on and below the diagonal."""

    def __init__(self, values: Mapping[str, Any], members: list[str]):
        super().__init__(values)
        self.members = members

    def to_df(self) -> list[Any]:
        """Frames of total, first-order and second-order indices, as SALib's."""
        pd = needed("pandas", "to_df")
        frames = [
            pd.DataFrame({key: self[key], f"{key}_conf": self[f"{key}_conf"]}, index=self.members) for key in ("ST", "S1")
        ]
        if "S2" in self:
            first, second = np.triu_indices(len(self.members), 1)
            pairs = [(self.members[j], self.members[k]) for j, k in zip(first, second)]
            frames.append(pd.DataFrame({key: self[key][first, second] for key in ("S2", "S2_conf")}, index=pairs))
        return frames


def analyze(
    problem: Mapping[str, Any],
    Y: Any,
    calc_second_order: bool = True,
    num_resamples: int = 100,
    conf_level: float = 0.95,
    print_to_console: bool = False,
    parallel: bool = False,
    n_processors: int | None = None,
    keep_resamples: bool = False,
    seed: Seed = None,
    X: Any = None,
) -> Sensitivities:
    """Indices by SALib's estimators from the outputs `Y`, (rows,), at points of `sample.sobol`, or of SALib's own.

    `*_conf` are half widths of intervals, as SALib has them: standard deviations over `num_resamples` resamples of the base points,
    the same as SALib's with the same `seed` above 0, times the quantile of the normal distribution at `conf_level`; NaN of fewer
    than 2. On Sobol' points they are too wide. `keep_resamples` adds S1_conf_all and ST_conf_all, (num_resamples, D).
    `parallel` and `n_processors` have no effect. What is not finite in `Y` leaves its base point out,
    with a warning. Points `X`, (rows, factors), are checked if given: base points that lack a row or repeat an earlier one are
    left out, and correlated or unequal matrices A and B are refused.
    Indices of outputs that do not vary are 0, with a warning. A `StudyError` says that the number of outputs is wrong.
    """
    num_resamples = whole("num_resamples", num_resamples, 0, _MAX_RESAMPLES)
    z, rng = confidence(conf_level), generator(seed)
    members = list(members_of(problem))
    d = len(members)
    y = numbers(Y, "the outputs are")
    if y.ndim > 2 or y.ndim == 2 and y.shape[1] != 1:
        raise _engine.StudyError(f"outputs of shape {y.shape}: expected (rows,), one output at a time")
    y = y.ravel()
    step = (2 if calc_second_order else 1) * d + 2
    if X is None and (y.size < 2 * step or y.size % step):
        raise _engine.StudyError(f"{y.size} outputs: expected a multiple of {step}, at least {2 * step}")
    rows = y.reshape(-1, step) if X is None else rows_of(members_of(problem), list(problem["names"]), X, y, calc_second_order)
    if unlikely := _engine.unlikely(y, rows[:, [0, -1]].ravel()):
        warn(unlikely)
    n, rows = len(rows), rows[np.isfinite(rows).all(axis=1)]
    if len(rows) < n:
        warn(f"{n - len(rows)} of {n} base points have outputs that are not finite, and are left out")
    if len(rows) < 2:
        raise _engine.StudyError(f"no indices: {len(rows)} base points have outputs")
    if np.ptp(rows) == 0:
        warn("the outputs do not vary: all indices are 0")
    first, total, pairs = (of[0] for of in _indices(rows, d, np.full((1, len(rows)), 1 / len(rows))))
    of_first, of_total, of_pairs = _indices(rows, d, _drawn(len(rows), num_resamples, rng))

    def spread(resamples: np.ndarray) -> np.ndarray:
        return z * resamples.std(axis=0, ddof=1) if num_resamples > 1 else np.full(resamples.shape[1:], np.nan)

    values = {"S1": first, "S1_conf": spread(of_first), "ST": total, "ST_conf": spread(of_total)}
    if keep_resamples:
        values |= {"S1_conf_all": of_first, "ST_conf_all": of_total}
    if calc_second_order:
        upper = np.triu_indices(d, 1)
        for key, of in (("S2", pairs), ("S2_conf", spread(of_pairs))):
            values[key] = np.full((d, d), np.nan)
            values[key][upper] = of
    found = Sensitivities(values, members)
    if print_to_console:
        for frame in found.to_df():
            print(frame)
    return found


def _drawn(n: int, resamples: int, rng: np.random.Generator) -> np.ndarray:
    """How often each of n base points is drawn with replacement, relative to n, (resamples, n)."""
    drawn = rng.integers(n, size=(n, resamples)).T.copy()
    return np.array([np.bincount(rows_drawn, minlength=n) for rows_drawn in drawn], dtype=float).reshape(resamples, n) / n


def _indices(rows: np.ndarray, d: int, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """First-order, total, (resamples, d), and second-order indices, (resamples, pairs), of base points that count as `counts` says,
    (resamples, n): S1 by Saltelli et al. 2010, ST by Jansen 1999, S2 by Saltelli 2002, of outputs less the mean of all."""
    rows = (rows - rows.mean()) / (rows.std() or 1.0)
    a, ab, ba, b = rows[:, :1], rows[:, 1 : d + 1], rows[:, d + 1 : -1], rows[:, -1:]
    both = counts @ np.hstack([(a + b) / 2, (a * a + b * b) / 2])
    variance = both[:, 1:] - both[:, :1] ** 2
    variance[variance == 0] = 1.0
    first = counts @ (b * (ab - a)) / variance
    total = counts @ (a - ab) ** 2 / (2 * variance)
    # A factor at a time: all products of pairs would be many arrays of outputs.
    closed = [counts @ (ba[:, j : j + 1] * ab[:, j + 1 :] - a * b) / variance for j in range(ba.shape[1])]
    pairs = [of - first[:, j : j + 1] - first[:, j + 1 :] for j, of in enumerate(closed)]
    return first, total, np.hstack(pairs) if pairs else first[:, :0]
