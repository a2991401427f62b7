"""Indices from a table that exists already."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _engine
from ._result import Document
from ._study import Study


def given_data(
    inputs: Any,
    outputs: Any,
    *,
    method: str = "both",
    surrogate: bool = False,
    measures: bool = False,
    factors: Mapping[str, Any] | None = None,
    seed: int = 0,
    name: str = "given-data",
) -> Document:
    """Indices from rows that are independent draws, whoever made them: no design, and no further runs.

    `inputs` and `outputs` are mappings from names to (rows,), `pandas.DataFrame`s, or arrays of (rows, columns). `method` is
    "rank", "binned" or "both". With `surrogate` there are total indices too; `factors` tells it the distributions. `measures`
    adds Borgonovo's delta, distances after Kolmogorov and Kuiper, PAWN, R2-HSIC and S_1 by the spectrum, with p-values.
    """
    x, y = _table(inputs, "x"), _table(outputs, "y")
    digest = hashlib.sha256(x[1].tobytes() + y[1].tobytes()).hexdigest()
    study = None if factors is None else Study(None, factors)._study
    document = _engine.given_data(
        x, y, method=method, surrogate=surrogate, measures=measures, distributions=study, seed=seed, name=name, sha256=digest
    )
    return Document(document)


def _table(data: Any, letter: str) -> tuple[list[str], np.ndarray]:
    if isinstance(data, Mapping) or hasattr(data, "columns"):
        names = [str(name) for name in data]
        return names, np.column_stack([np.asarray(data[name], dtype=float) for name in data])
    values = np.asarray(data, dtype=float)
    values = values.reshape(len(values), -1)
    count = values.shape[1]
    names = [letter] if count == 1 and letter == "y" else [f"{letter}{k + 1}" for k in range(count)]
    return names, np.ascontiguousarray(values)
