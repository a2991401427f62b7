"""Points in the order of Saltelli (2002), from scrambled Sobol' points of the engine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._checks import whole
from ..._engine import StudyError
from .._problem import Seed, members_of, points


def sample(
    problem: Mapping[str, Any],
    N: int,
    *,
    calc_second_order: bool = True,
    scramble: bool = True,
    skip_values: int = 0,
    seed: Seed = None,
) -> np.ndarray:
    """Points in SALib's order, (N * (2 D + 2), factors), or (N * (D + 2), factors) without second order, of D factors or groups.

    For each of `N` base points, best a power of two, the rows A, AB_1 ... AB_D, BA_1 ... BA_D (with second order), B. `seed`
    scrambles the points: a whole number, a generator of NumPy, or None for others in each call. The first `skip_values` points
    are left out. A `StudyError` refuses `scramble=False`, and what cannot be a problem.
    """
    if not scramble:
        raise StudyError("scramble=False: the points are always scrambled; a seed makes them the same in each call")
    both = points(problem, N, seed, 2, whole("skip_values", skip_values, 0, 2**52))
    d = both.shape[1] // 2
    a, b = both[:, :d], both[:, d:]
    members = members_of(problem)
    count = len(members)
    rows = np.empty((len(a), 2 + count * (2 if calc_second_order else 1), d))
    rows[:, : count + 1], rows[:, count + 1 :] = a[:, None], b[:, None]
    for place, columns in enumerate(members.values(), 1):
        rows[:, place, columns] = b[:, columns]
        if calc_second_order:
            rows[:, count + place, columns] = a[:, columns]
    return rows.reshape(-1, d)
