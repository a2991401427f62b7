"""What functions return, as arrays of (rows, values)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._tables import named, numbers, series_name


class AnswerError(TypeError):
    """A function returned invalid outputs."""


class NoAnswer(AnswerError):
    """A function of one row returned None: this row failed."""


class Answer(NamedTuple):
    """The values that a function returned, as (rows, values); the names of the outputs if there are any; and, for separate outputs,
    the number of values of each, None for a single number."""

    values: np.ndarray
    names: list[str] | None
    lengths: list[int | None] | None

    @property
    def width(self) -> int:
        return self.values.shape[1]


def expanded(names: Sequence[str], lengths: Mapping[str, int | None]) -> list[str]:
    """The names of all values: those of a series are `name[0]`, `name[1]` and so on."""
    columns: list[str] = []
    for name in names:
        length = lengths.get(name)
        columns += [name] if length is None else [f"{name}[{place}]" for place in range(length)]
    return columns


def read(answer: Any, rows: int, vectorised: bool, expected: Sequence[str] | None, hint: bool) -> Answer:
    """What a function returned for `rows` rows, or an `AnswerError`. Outputs by name come in the order of `expected`, if they are
    the same ones; with `hint` the message about a wrong shape names the keyword for functions of one row."""
    if answer is None:
        if not vectorised:
            raise NoAnswer("the function returned None")
        raise AnswerError(f"the function returned None for {rows} rows: expected an array, a tuple of arrays or a dict")
    if not vectorised and hasattr(answer, "to_frame") and hasattr(answer, "to_dict") and all(isinstance(label, str) for label in answer.index):
        # The labels of a Series for one row are the names of the outputs.
        answer = answer.to_dict()
    table = named(answer, "the function returned", AnswerError)
    if table is not None:
        names = list(expected) if expected is not None and sorted(expected) == sorted(table) else list(table)
        return _stacked([table[name] for name in names], names, rows, vectorised)._replace(names=names)
    if isinstance(answer, tuple):
        parts = [numbers(part, "the function returned", AnswerError) for part in answer]
        return _stacked(parts, [str(place) for place in range(len(parts))], rows, vectorised)
    values = numbers(answer, "the function returned", AnswerError)
    name = series_name(answer) if expected is None else None
    if not vectorised:
        if values.ndim > 1:
            raise AnswerError(f"the function returned an array of shape {values.shape} for one row")
        return Answer(values.reshape(1, -1), None, None)
    if values.ndim == 1 and len(values) == rows:
        return Answer(values.reshape(rows, 1), [name] if name else None, None)
    if values.ndim == 2 and len(values) == rows:
        return Answer(values, None, None)
    words = ": if it is a function of one row, say vectorised=False" if hint or values.ndim == 0 else ""
    shapes = f"({rows},) or ({rows}, outputs)"
    raise AnswerError(
        f"the function returned an array of shape {values.shape} for {rows} rows, and {shapes} was expected{words}"
    )


def _stacked(parts: list[np.ndarray], names: list[str], rows: int, vectorised: bool) -> Answer:
    """Separate outputs, each with one number per row or a series: (rows,) or (rows, values), and for one row () or (values,)."""
    shape = (rows,) if vectorised else ()
    columns, lengths = [], []
    for name, part in zip(names, parts):
        is_series = part.ndim == len(shape) + 1 and part.shape[: len(shape)] == shape and (vectorised or part.shape != (1,))
        if not is_series and part.shape != shape and part.shape != (rows,):
            expected = f"{shape}, or {shape[:1] + ('values',)} of a series," if vectorised else "() or (values,)"
            raise AnswerError(f"output {name} has the shape {part.shape}, and {expected} was expected")
        columns.append(part.reshape(rows, -1))
        lengths.append(part.shape[-1] if is_series else None)
    if not parts:
        raise AnswerError("the function returned no outputs")
    return Answer(np.column_stack(columns), None, lengths)
