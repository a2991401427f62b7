"""Functions of Python as models: calls and failed rows."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import numpy as np

from ._answers import Answer, AnswerError, NoAnswer, expanded, read
from ._engine import StudyError
from ._identity import identity_of
from ._signatures import STYLES, style_of


class Call:
    """A function, and how it is called.

    `style` is one of "columns" (one argument per factor), "keywords" (the same by name) and "matrix" (all factors in one
    array). Vectorised functions get arrays of one entry, or one row, per model run; others get numbers, or one row.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        names: Sequence[str],
        *,
        vectorised: bool,
        style: str | None,
        outputs: Sequence[str] | None,
        lengths: Mapping[str, int | None] | None = None,
        quantiles: Mapping[int, Callable[[np.ndarray], np.ndarray]],
    ):
        if not callable(function):
            raise StudyError(f"{function!r} is not a function")
        if style is not None and style not in STYLES:
            raise StudyError(f"call={style!r}: expected one of {', '.join(map(repr, STYLES))}")
        self.function = function
        self.names = list(names)
        self.vectorised = vectorised
        self.style = style or style_of(function, self.names)
        # Names of the outputs, and of those that are series how many values they have (None as long as that is not known).
        self.outputs = list(outputs) if outputs is not None else None
        self.lengths = dict(lengths or {})
        self.quantiles = dict(quantiles)

    def rows(self, x: np.ndarray) -> np.ndarray:
        """The values that the function gets for rows of the engine: the same, except for factors by their quantile functions."""
        if self.quantiles:
            x = x.copy()
            for place, quantile in self.quantiles.items():
                x[:, place] = quantile(x[:, place])
        return x

    def probe(self, rows: np.ndarray) -> np.ndarray:
        """The outputs of `rows`, which must answer and show the names of the outputs."""
        answer = self._answer(rows)
        if self.outputs is None:
            self.outputs = answer.names or [unnamed(self.names)] * (answer.width == 1) or [f"y{k + 1}" for k in range(answer.width)]
        if self.lengths or answer.lengths or len(self.outputs) == 1 < answer.width:
            self._learn_lengths(answer)
        self._check(answer)
        return answer.values.copy()

    def _learn_lengths(self, answer: Answer) -> None:
        """The outputs that are series, with their numbers of values if known: those with several columns."""
        outputs = self.outputs or []
        found = answer.lengths
        if found is None:
            # One array: of what is left the only series whose length is not declared takes all.
            open_ones = [name for name in outputs if self.lengths.get(name, 1) is None]
            open_ones = outputs if len(outputs) == 1 and not self.lengths else open_ones
            known = sum(self.lengths.get(name, 1) or 0 for name in outputs if name not in open_ones)
            left = answer.width - known
            if len(open_ones) == 1:
                self.lengths[open_ones[0]] = left
            elif open_ones:
                raise AnswerError(f"the number of values of {' and '.join(open_ones)} is unknown: state their `length`")
            return
        for name, length in zip(outputs, found):
            if length is not None or name in self.lengths:
                self.lengths.setdefault(name, length)
                if self.lengths[name] is None:
                    self.lengths[name] = length

    @property
    def columns(self) -> list[str]:
        """Names of all values, as the engine has them: those of a series are `name[0]`, `name[1]` and so on."""
        return expanded(self.outputs or [], self.lengths)

    def evaluate(self, rows: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Outputs of `rows` (rows, factors), which are what the function gets, NaN where there are none, and (row, reason) where it
        raised an exception, or returned None for the row.

        A block that raises is divided until the rows are found that do. The array of a whole block is the function's own.
        """
        values: np.ndarray | None = None
        failures: list[tuple[int, str]] = []
        blocks = [(0, len(rows))] if self.vectorised else [(row, row + 1) for row in range(len(rows))]
        while blocks:
            first, last = blocks.pop()
            try:
                answer = self._answer(rows[first:last])
            except NoAnswer as none:
                failures.append((first, reason_of(none)))
            except AnswerError:
                raise
            except Exception as error:
                if last - first == 1:
                    failures.append((first, reason_of(error)))
                else:
                    middle = (first + last) // 2
                    blocks += [(middle, last), (first, middle)]
            else:
                self._check(answer)
                if last - first == len(rows):
                    return answer.values, []
                values = self._missing(rows) if values is None else values
                values[first:last] = answer.values
        return self._missing(rows) if values is None else values, sorted(failures)

    def _missing(self, rows: np.ndarray) -> np.ndarray:
        return np.full((len(rows), len(self.columns)), np.nan)

    def _answer(self, rows: np.ndarray) -> Answer:
        # Copies: a function may change its arguments in place, and the rows may be asked again.
        if self.style == "matrix":
            answer = self.function((rows if self.vectorised else rows[0]).copy())
        elif self.vectorised:
            answer = self._spread([rows[:, place].copy() for place in range(rows.shape[1])])
        else:
            answer = self._spread([float(x) for x in rows[0]])
        return read(answer, len(rows), self.vectorised, self.outputs, self.style == "matrix")

    def _spread(self, arguments: list[Any]) -> Any:
        if self.style == "keywords":
            return self.function(**dict(zip(self.names, arguments)))
        return self.function(*arguments)

    def _check(self, answer: Answer) -> None:
        expected = self.outputs or []
        if answer.names is not None and answer.names != expected:
            raise AnswerError(f"the function returned the outputs {answer.names}, and {expected} were expected")
        lengths = [self.lengths.get(name) for name in expected]
        if answer.lengths is not None and len(answer.lengths) == len(expected) and answer.lengths != lengths:
            found = [f"{name} with {_values(length)}" for name, length in zip(expected, answer.lengths)]
            wanted = [_values(length) for length in lengths]
            raise AnswerError(f"the function returned {', '.join(found)}, and {', '.join(wanted)} were expected")
        if answer.width != len(self.columns):
            what = "values" if self.lengths else "outputs"
            raise AnswerError(f"the function returned {answer.width} {what}, and {len(self.columns)} were expected: {expected}")

    def identity(self, version: str | None) -> str:
        """Identifies this function in journals: see `identity_of`."""
        return identity_of(self.function, self.quantiles.values(), version)


def unnamed(factors: Collection[str]) -> str:
    """The name of the only output of a function that does not name it."""
    return "output" if "y" in factors else "y"


def reason_of(error: BaseException) -> str:
    """The last line of an exception, the reason of a failed row."""
    if isinstance(error, NoAnswer):
        return str(error)
    return traceback.format_exception_only(type(error), error)[-1].strip()


def with_hint(error: Exception, vectorised: bool) -> Exception:
    """The error for an exception at every row, with a hint if a function of numbers got arrays."""
    of_arrays = isinstance(error, IndexError) or isinstance(error, (TypeError, ValueError)) and "array" in str(error)
    if not vectorised or not of_arrays:
        return error
    words = f"the function failed with arrays of several rows: {reason_of(error)}"
    hinted = StudyError(f"{words}: if it is a function of one row, pass vectorised=False")
    hinted.__cause__ = error
    return hinted


def _values(length: int | None) -> str:
    return "one value" if length is None else f"{length} values"
