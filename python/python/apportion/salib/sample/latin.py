"""Latin hypercubes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._engine import StudyError
from .._problem import Seed, members_of, points


def sample(problem: Mapping[str, Any], N: int, seed: Seed = None) -> np.ndarray:
    """A Latin hypercube, (N, factors). A `StudyError` refuses groups."""
    if len(members_of(problem)) < len(problem["names"]):
        raise StudyError("groups: a Latin hypercube has none; leave them out of the problem")
    return points(problem, N, seed, sampler="latin-hypercube")
