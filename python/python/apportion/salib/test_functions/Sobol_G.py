"""The g function of Sobol' (1998), with shifts and curvatures (Saltelli et al. 2010)."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._engine import StudyError

_A = (0, 1, 4.5, 9, 99, 99, 99, 99)


def evaluate(values: np.ndarray, a: Any = None, delta: Any = 0.0, alpha: Any = 1.0) -> np.ndarray:
    """The outputs, (rows,), of points between 0 and 1, (rows, factors); a factor with a small `a` has much effect."""
    values = np.asarray(values, dtype=float)
    if values.ndim != 2 or not ((values >= 0) & (values <= 1)).all():
        raise StudyError("expected points between 0 and 1, (rows, factors)")
    a, alpha = np.asarray(_A if a is None else a, dtype=float), np.asarray(1.0 if alpha is None else alpha)
    delta = np.asarray(0.0 if delta is None else delta, dtype=float)
    if a.shape != values.shape[1:] or (alpha <= 0).any() or not ((delta >= 0) & (delta <= 1)).all():
        raise StudyError(f"expected {values.shape[1]} values of a, alpha above 0, and delta from 0 to 1")
    shifted = (values + delta) % 1
    return np.prod(((1 + alpha) * np.abs(2 * shifted - 1) ** alpha + a) / (1 + a), axis=1)


def _variances(a: Any, alpha: Any) -> np.ndarray:
    """Of the factors of the product, (factors,)."""
    alpha = np.asarray(1.0 if alpha is None else alpha, dtype=float)
    return alpha**2 / ((1 + 2 * alpha) * (1 + np.asarray(a, dtype=float)) ** 2)


def sensitivity_index(a: Any, alpha: Any = None) -> np.ndarray:
    """The exact first-order indices, (factors,)."""
    of = _variances(a, alpha)
    return of / (np.prod(1 + of) - 1)


def total_sensitivity_index(a: Any, alpha: Any = None) -> np.ndarray:
    """The exact total indices, (factors,)."""
    of = _variances(a, alpha)
    return of / (1 + of) * np.prod(1 + of) / (np.prod(1 + of) - 1)
