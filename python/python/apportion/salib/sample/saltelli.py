"""The former name of `sobol`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import sobol


def sample(problem: Mapping[str, Any], N: int, calc_second_order: bool = True, skip_values: int | None = None) -> np.ndarray:
    """The points of `sobol.sample` with the seed 0, the same ones in each call; the first `skip_values` are left out."""
    return sobol.sample(problem, N, calc_second_order=calc_second_order, skip_values=skip_values or 0, seed=0)
