"""Elementary effects from outputs along trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._checks import whole
from ..._engine import StudyError
from ..._tables import numbers
from .._problem import Seed, generator, members_of
from ..util import ResultDict, confidence


def analyze(
    problem: Mapping[str, Any],
    X: Any,
    Y: Any,
    num_resamples: int = 100,
    conf_level: float = 0.95,
    scaled: bool = False,
    print_to_console: bool = False,
    num_levels: int = 4,
    seed: Seed = None,
) -> ResultDict:
    """mu, mu_star, sigma and mu_star_conf, (D,), of D factors or groups, and their names, from outputs `Y`, (rows,), at the points
    `X`, (rows, factors), of `sample.morris` with as many `num_levels`, or of SALib's own; shuffled rows of factors are put in order.

    Effects are per unit of the range of a factor; those that are `scaled` per standard deviation, of input and output. Of groups
    they are means over their factors, and sigma is NaN. A `StudyError` says that the numbers of rows are wrong.
    """
    num_resamples, num_levels = whole("num_resamples", num_resamples, 0, 10**6), whole("num_levels", num_levels, 2, 2**16)
    z, rng = confidence(conf_level), generator(seed)
    members = members_of(problem)
    points, d = len(members) + 1, len(problem["names"])
    x, y = numbers(X, "the points are"), numbers(Y, "the outputs are").ravel()
    if x.shape != (len(y), d) or not len(y) or len(y) % points:
        expected = f"expected (rows, {d}) and (rows,), and a multiple of {points} rows"
        raise StudyError(f"points of shape {x.shape} and {len(y)} outputs: {expected}")
    rows = np.arange(len(y)) if _are_in_order(x, members) else _paths(x)
    if len(rows) != len(y) or not _are_in_order(x[rows], members):
        raise StudyError("the rows are no trajectories: put them back in the order in which they were sampled")
    x, y = x[rows].reshape(-1, points, d), y[rows].reshape((-1, points))
    effects = np.einsum("tsk,ts->kt", np.sign(np.diff(x, axis=1)), np.diff(y, axis=1))
    if scaled:
        spread = y.std(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            effects *= np.where(spread > 0, x.std(axis=1).T / spread, 0.0) / np.ptp(x, axis=1).T
    else:
        effects /= num_levels / (2 * (num_levels - 1))
    sizes = np.ascontiguousarray(np.abs(effects))
    means = [size[rng.integers(len(y), size=(num_resamples, len(y)))].mean(axis=1) for size in sizes]
    conf = z * np.std(means, axis=1, ddof=1) if num_resamples > 1 else np.full(d, np.nan)

    def joint(of: np.ndarray) -> np.ndarray:
        return np.array([of[columns].mean() for columns in members.values()])

    sigma = effects.std(axis=1, ddof=1) if len(y) > 1 else np.full(d, np.nan)
    found = ResultDict(
        names=list(members),
        mu=joint(effects.mean(axis=1)),
        mu_star=joint(sizes.mean(axis=1)),
        sigma=np.array([sigma[columns[0]] if len(columns) == 1 else np.nan for columns in members.values()]),
        mu_star_conf=joint(conf),
    )
    if print_to_console:
        print(found.to_df())
    return found


def _are_in_order(x: np.ndarray, members: Mapping[str, list[int]]) -> bool:
    """Whether every step of every trajectory moves one factor or group at most, and each moves once at most."""
    steps = np.diff(x.reshape(-1, len(members) + 1, x.shape[1]), axis=1) != 0
    moves = np.stack([steps[..., columns].any(axis=2) for columns in members.values()], axis=2)
    return bool(moves.sum(axis=1).max() <= 1 and moves.sum(axis=2).max() <= 1)


def _paths(x: np.ndarray) -> np.ndarray:
    """The rows of shuffled trajectories, one after the other: neighbours differ in one factor. Incomplete if there are none."""
    d = x.shape[1]
    near: list[list[tuple[int, int]]] = [[] for _ in x]
    for k in range(d):
        others = np.unique(np.delete(x, k, axis=1), axis=0, return_inverse=True)[1].ravel()
        for alike in np.split(np.argsort(others, kind="stable"), np.cumsum(np.bincount(others))[:-1]):
            for a in alike:
                near[a].extend((int(b), k) for b in alike if x[a, k] != x[b, k])
    free = set(range(len(x)))

    def path(rows: list[int], moved: list[int]) -> list[int]:
        if len(moved) == d:
            return rows
        on = (path([*rows, b], [*moved, k]) for b, k in near[rows[-1]] if b in free and k not in moved)
        return next(filter(None, on), [])

    found: list[int] = []
    while free:
        # Ends may be seen only when other trajectories are gone.
        ends = (row for row in sorted(free) if sum(b in free for b, _ in near[row]) == 1)
        one = next(filter(None, (path([end], []) for end in ends)), [])
        if not one:
            break
        found += one
        free.difference_update(one)
    return np.array(found, dtype=int)
