"""Indices from an existing table."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _engine
from ._checks import MAX_SEED, whole
from ._engine import StudyError
from ._result import Document
from ._study import Study
from ._tables import named, numbers, series_name


def given_data(
    inputs: Any,
    outputs: Any,
    *,
    measures: bool = False,
    factors: Mapping[str, Any] | None = None,
    seed: int = 0,
    name: str = "given-data",
) -> Document:
    """Indices from rows that are independent draws, from any source: no design, and no further runs.

    `inputs` and `outputs` are mappings from names to (rows,), `pandas.DataFrame`s or named `Series`, or arrays of
    (rows, columns). `factors` tells the distributions to the surrogate, which also gives total indices. `measures`
    adds Borgonovo's delta, PAWN, R2-HSIC and S_1 by the spectrum, with p-values.
    A `StudyError` names the column that holds no numbers, or entries that are NaN, infinite, masked or missing.
    """
    x, y = _table(inputs, "x", "the inputs"), _table(outputs, "y", "the outputs")
    seed = whole("seed", seed, 0, MAX_SEED)
    digest = hashlib.sha256(x[1].tobytes() + y[1].tobytes()).hexdigest()
    study = None if factors is None else Study(None, factors)._study
    document = _engine.given_data(
        x, y, measures=measures, distributions=study, seed=seed, name=name, sha256=digest
    )
    return Document(document)


def _table(data: Any, letter: str, what: str) -> tuple[list[str], np.ndarray]:
    columns = named(data, f"{what} have")
    if columns is None:
        values = numbers(data, f"{what} are")
        values = values.reshape(len(values), -1) if values.size and values.ndim else np.empty((0, 0))
        count = values.shape[1]
        names = [letter] if count == 1 and letter == "y" else [f"{letter}{k + 1}" for k in range(count)]
        names = [series_name(data) or names[0]] if count == 1 else names
        columns = dict(zip(names, values.T))
    for name, column in columns.items():
        if column.ndim != 1:
            raise StudyError(f"{what} have an array of shape {column.shape} in {name!r}: expected (rows,)")
    lengths = {len(column) for column in columns.values()}
    if lengths in (set(), {0}):
        raise StudyError(
            f"{what} have no rows: expected a mapping from names to (rows,), a frame, or an array of (rows, columns)"
        )
    if len(lengths) > 1:
        found = ", ".join(f"{len(column)} in {name!r}" for name, column in columns.items())
        raise StudyError(f"{what} have different numbers of rows: {found}")
    return list(columns), np.column_stack(list(columns.values()))
