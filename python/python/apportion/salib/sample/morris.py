"""Trajectories of Morris (1991) on a grid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._checks import whole
from ..._engine import StudyError
from ..._warnings import warn
from .._problem import Seed, from_problem, generator, members_of


def sample(
    problem: Mapping[str, Any],
    N: int,
    num_levels: int = 4,
    optimal_trajectories: int | None = None,
    local_optimization: bool = True,
    seed: Seed = None,
) -> np.ndarray:
    """`N` trajectories of D + 1 points, (N * (D + 1), factors), of D factors or groups, which move as one.

    The grid has `num_levels` levels, best an even number; a step goes over half of them. A `StudyError` refuses other
    distributions than `unif`, which have no ends, and `optimal_trajectories`.
    """
    if optimal_trajectories:
        raise StudyError(
            f"optimal_trajectories={optimal_trajectories!r}: expected None; for points that are spread, use Study.screen()"
        )
    if any(factor.keys["distribution"] != "uniform" for factor in from_problem(problem).values()):
        raise StudyError("dists: trajectories on a grid are those of unif; for other distributions use Study.screen()")
    N, num_levels = whole("N", N, 1, 2**32), whole("num_levels", num_levels, 2, 2**16)
    if num_levels % 2:
        warn(f"num_levels={num_levels}: an even number is without bias")
    rng = generator(seed)
    members = members_of(problem)
    group_of = np.empty(len(problem["names"]), dtype=int)
    for group, columns in enumerate(members.values()):
        group_of[columns] = group
    count, d = len(members), len(group_of)
    step = num_levels / (2 * (num_levels - 1))
    low = rng.choice(np.linspace(0, 1 - step, num_levels // 2), (N, 1, d))
    # The place of each group in the order of steps; a factor goes up, or down from the upper end.
    order = rng.permuted(np.tile(np.arange(count), (N, 1)), axis=1)
    has_moved = order[:, None, group_of] < np.arange(count + 1)[:, None]
    u = low + step * (has_moved == rng.choice([False, True], (N, 1, d)))
    bounds = np.asarray(problem["bounds"], dtype=float)
    return (bounds[:, 0] + u * (bounds[:, 1] - bounds[:, 0])).reshape(-1, d)
