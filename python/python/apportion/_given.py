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
from ._warnings import warn


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
    Rows without an output (NaN, masked, missing) are left out, with a warning that counts them; texts of an input are categories.
    A `StudyError` names another column that holds no numbers, or an input without a value.
    """
    x, y = _table(_coded(inputs), "x", "the inputs"), _table(outputs, "y", "the outputs")
    known = ~np.isnan(y[1]).any(axis=1)
    if len(x[1]) == len(known) and known.any() and not known.all():
        warn(f"{np.count_nonzero(~known)} of {len(known)} rows have no output and are left out: indices are those of the other rows")
        x, y = (x[0], x[1][known]), (y[0], y[1][known])
    seed = whole("seed", seed, 0, MAX_SEED)
    digest = hashlib.sha256(x[1].tobytes() + y[1].tobytes()).hexdigest()
    study = None if factors is None else Study(None, factors)._study
    document = _engine.given_data(
        x, y, measures=measures, distributions=study, seed=seed, name=name, sha256=digest
    )
    return Document(document).warned()


def _coded(data: Any) -> Any:
    """The columns of inputs by their names, texts as numbers of their categories."""
    if not isinstance(data, Mapping) and not hasattr(data, "columns"):
        return data
    columns = {name: np.asarray(data[name]) for name in getattr(data, "column_names", getattr(data, "columns", data))}
    of_texts = [name for name, column in columns.items() if all(isinstance(value, str) for value in column.ravel().tolist())]
    return {**columns, **{name: np.unique(columns[name].astype(str), return_inverse=True)[1] for name in of_texts}} if of_texts else data


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
