"""Points in SALib's order that were made elsewhere: whether they are what its formulas need."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .._engine import StudyError
from .._tables import numbers
from .._warnings import warn


def rows_of(members: Mapping[str, list[int]], names: list[str], X: Any, y: np.ndarray, second_order: bool) -> np.ndarray:
    """The outputs `y`, (rows,), at the points `X`, (rows, factors), as (base points, rows of each): without base points that lack
    a row and without those that repeat an earlier one, with warnings.

    A `StudyError` says that the rows are not in SALib's order, that A and B are not independent of each other or not of the same
    distributions, or that factors are correlated.
    """
    x, d = numbers(X, "the points are"), len(names)
    if x.shape != (len(y), d):
        raise StudyError(f"points of shape {x.shape} and {len(y)} outputs: expected ({len(y)}, {d})")
    step = (2 if second_order else 1) * len(members) + 2
    starts = _starts(list(members.values()), x, step)
    if len(starts) < 2 or 2 * len(starts) * step < len(x):
        raise StudyError(_disorder(members, names, x, step))
    if len(starts) * step < len(x):
        lost = len(x) - len(starts) * step
        warn(f"{lost} rows are not in a complete base point, and are left out: rows are missing")
    a, b = x[starts], x[starts + step - 1]
    first = np.sort(np.unique(np.hstack([a, b]), axis=0, return_index=True)[1])
    if len(first) < len(starts):
        again = int(np.setdiff1d(np.arange(len(starts)), first)[0])
        count = len(starts) - len(first)
        warn(f"{count} base points repeat earlier ones (from row {starts[again] + 1} on): each is used once")
    _independent(names, a[first], b[first])
    return y[starts[first][:, None] + np.arange(step)]


def _starts(columns: list[list[int]], x: np.ndarray, step: int) -> np.ndarray:
    """The first rows of the base points whose rows are all there, in their order."""
    fits = np.zeros(len(x), dtype=bool)
    count = len(x) - step + 1
    if count < 1:
        return np.flatnonzero(fits)
    a, b = x[:count], x[step - 1 :]
    fits[:count] = True
    for k, own in enumerate(columns):
        for place, base, other in ((1 + k, a, b), (1 + len(columns) + k, b, a)):
            if place < step - 1:
                expected = base.copy()
                expected[:, own] = other[:, own]
                fits[:count] &= np.isclose(x[place : place + count], expected, rtol=1e-9, atol=0).all(axis=1)
    starts, free = [], 0
    for start in np.flatnonzero(fits).tolist():
        if start >= free:
            starts.append(start)
            free = start + step
    return np.array(starts, dtype=int)


def _disorder(members: Mapping[str, list[int]], names: list[str], x: np.ndarray, step: int) -> str:
    """What is wrong with the order of rows."""
    for k, (member, own) in enumerate(members.items()):
        changed = np.flatnonzero(x[1 + k] != x[0]).tolist() if len(x) > 1 + k else []
        if set(own) < set(changed) and len(changed) < len(names):
            together = " and ".join(names[j] for j in changed)
            return f"row {2 + k}: {together} change together, where only {member} should: make them a group, or sample them apart"
    order = "A, a row for each factor or group that takes it from B, B" if step == len(members) + 2 else "A, AB rows, BA rows, B"
    return f"the points are not in SALib's order (for every base point: {order}, {step} rows); check calc_second_order and the order"


def _ranks(columns: np.ndarray) -> np.ndarray:
    ranks = columns.argsort(axis=0).argsort(axis=0).astype(float)
    for rank, column in zip(ranks.T, columns.T):
        # Equal values have the mean of their ranks.
        _, group = np.unique(column, return_inverse=True)
        rank[:] = (np.bincount(group, rank) / np.bincount(group))[group]
    return ranks


def _independent(names: list[str], a: np.ndarray, b: np.ndarray) -> None:
    n, d = a.shape
    varying = np.ptp(np.vstack([a, b]), axis=0) > 0
    for j in np.flatnonzero(varying).tolist():
        both = np.sort(np.concatenate([a[:, j], b[:, j]]))
        gap = np.abs(np.searchsorted(np.sort(a[:, j]), both, "right") - np.searchsorted(np.sort(b[:, j]), both, "right")).max() / n
        # A chance of 1e-6 by the test of Kolmogorov and Smirnov.
        if gap > 2.69 * np.sqrt(2 / n):
            raise StudyError(f"{names[j]} has other values in matrix A than in B: they must be of the same distribution")
    if n < 30:
        return
    with np.errstate(invalid="ignore"):
        correlation = np.nan_to_num(np.corrcoef(_ranks(np.hstack([a, b])), rowvar=False))
    # Five standard errors of independent columns.
    clear = np.argwhere(np.triu(np.abs(correlation) > 5 / np.sqrt(n - 1), 1))
    for i, j in clear.tolist():
        if i < d <= j:
            raise StudyError(
                f"{names[i]} in matrix A and {names[j - d]} in B are correlated (rank correlation {correlation[i, j]:.2f}): both come "
                "from one sequence, and the indices would be wrong; sample A and B as one sequence of twice as many columns"
            )
    for i, j in clear.tolist():
        raise StudyError(
            f"{names[i % d]} and {names[j % d]} are correlated (rank correlation {correlation[i, j]:.2f}): these formulas need "
            "independent factors; analyse rows A and B as given data, or sample the factors independently"
        )
