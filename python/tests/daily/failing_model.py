"""A model that fails in a part of its space: what failed, why, and the indices of the rest."""

import warnings

import apportion as ap
import numpy as np


def pressure(flow, width):
    if flow / width > 9.0:
        raise FloatingPointError("no steady flow")
    return flow**2 / width


with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    result = ap.analyse(pressure, {"flow": (1, 2), "width": (0.2, 1)}, vectorised=False, base_samples=256, max_failed=0.2)
reasons = list(result.failures.items())
assert reasons[0][0] == "FloatingPointError: no steady flow" and reasons[0][1] == result["y"].runs_failed > 0
assert any(of.category is ap.SensitivityWarning and "FloatingPointError" in str(of.message) for of in caught)
assert np.isfinite(result.total["flow"].estimate)
