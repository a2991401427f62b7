"""Functions of Python as models: how they are called, and what becomes of what they return."""

from __future__ import annotations

import hashlib
import inspect
import keyword
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ._engine import StudyError

STYLES = ("columns", "keywords", "matrix")


class AnswerError(TypeError):
    """A function returned what cannot be its outputs."""


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
            raise StudyError(f"{function!r} is no function")
        if style is not None and style not in STYLES:
            raise StudyError(f"call={style!r}: expected one of {', '.join(map(repr, STYLES))}")
        self.function = function
        self.names = list(names)
        self.vectorised = vectorised
        self.style = style or _style(function, self.names)
        # Names of the outputs, and of those that are series how many values they have (None as long as that is not known).
        self.outputs = list(outputs) if outputs is not None else None
        self.lengths = dict(lengths or {})
        self.quantiles = dict(quantiles)

    def rows(self, x: np.ndarray) -> np.ndarray:
        """What the function gets for rows of the engine: the same, but for factors by their quantile functions."""
        if self.quantiles:
            x = x.copy()
            for place, quantile in self.quantiles.items():
                x[:, place] = quantile(x[:, place])
        return x

    def probe(self, x: np.ndarray) -> np.ndarray:
        """The outputs of the rows `x`, which must answer and show the names of the outputs."""
        answer = self._answer(self.rows(x))
        if self.outputs is None:
            self.outputs = answer.names or ["y"] * (answer.width == 1) or [f"y{k + 1}" for k in range(answer.width)]
        if self.lengths or answer.lengths or len(self.outputs) == 1 < answer.width:
            self._learn_lengths(answer)
        self._check(answer)
        return answer.values

    def _learn_lengths(self, answer: "_Answer") -> None:
        """Which outputs are series, and of how many values: those of several columns, where that can be told."""
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
                raise AnswerError(f"it cannot be told how many values {' and '.join(open_ones)} have: say their `length`")
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

    def evaluate(self, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Outputs of the rows `x`, NaN where there are none, and (row, reason) where the function raised an exception.

        A block that raises is divided until the rows are found that do.
        """
        rows = self.rows(x)
        values = np.full((len(x), len(self.columns)), np.nan)
        failures: list[tuple[int, str]] = []
        blocks = [(0, len(x))] if self.vectorised else [(row, row + 1) for row in range(len(x))]
        while blocks:
            first, last = blocks.pop()
            try:
                answer = self._answer(rows[first:last])
            except AnswerError:
                raise
            except Exception as error:
                if last - first == 1:
                    failures.append((first, traceback.format_exception_only(type(error), error)[-1].strip()))
                else:
                    middle = (first + last) // 2
                    blocks += [(middle, last), (first, middle)]
            else:
                self._check(answer)
                values[first:last] = answer.values
        return values, sorted(failures)

    def _answer(self, rows: np.ndarray) -> "_Answer":
        arguments = rows if self.vectorised else rows[0]
        if self.style == "matrix":
            answer = self.function(arguments)
        elif self.vectorised:
            answer = self._spread([np.ascontiguousarray(rows[:, place]) for place in range(rows.shape[1])])
        else:
            answer = self._spread([float(x) for x in arguments])
        return _columns(answer, len(rows), self.vectorised)

    def _spread(self, arguments: list) -> Any:
        if self.style == "keywords":
            return self.function(**dict(zip(self.names, arguments)))
        return self.function(*arguments)

    def _check(self, answer: "_Answer") -> None:
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

    def fingerprint(self) -> str:
        """Tells this function from an edited one: its name, code, constants and defaults; not what it calls."""
        digest = hashlib.sha256()
        function = inspect.unwrap(getattr(self.function, "func", self.function))
        code = getattr(function, "__code__", None) or getattr(getattr(function, "__call__", None), "__code__", None)
        _digest_code(code, digest)
        for part in (getattr(function, "__defaults__", None), getattr(self.function, "args", None)):
            digest.update(_words(part).encode())
        name = getattr(function, "__qualname__", type(function).__qualname__)
        return f"{getattr(function, '__module__', None)}.{name} {digest.hexdigest()[:16]}"


def _words(value: Any) -> str:
    """The value in words that are the same in every process."""
    if isinstance(value, (tuple, list)):
        return "(" + ",".join(_words(part) for part in value) + ")"
    if isinstance(value, (set, frozenset)):
        return "{" + ",".join(sorted(_words(part) for part in value)) + "}"
    return repr(value) if isinstance(value, (int, float, complex, str, bytes, type(None))) else type(value).__qualname__


def _digest_code(code: Any, digest: Any) -> None:
    if code is None:
        return
    digest.update(code.co_code)
    digest.update(_words(code.co_names + code.co_varnames).encode())
    for constant in code.co_consts:
        if hasattr(constant, "co_code"):
            _digest_code(constant, digest)
        else:
            digest.update(_words(constant).encode())


def _style(function: Callable[..., Any], names: list[str]) -> str:
    if isinstance(function, np.ufunc):
        return "columns" if function.nin == len(names) else "matrix"
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        raise StudyError(
            'it cannot be seen which arguments the function takes: say call="columns" (one per factor), "keywords" or '
            '"matrix" (all factors in one array)'
        ) from None
    kinds = inspect.Parameter
    required = [p for p in parameters if p.default is p.empty and p.kind not in (kinds.VAR_POSITIONAL, kinds.VAR_KEYWORD)]
    by_name = {p.name for p in parameters if p.kind in (kinds.POSITIONAL_OR_KEYWORD, kinds.KEYWORD_ONLY)}
    positional = [p for p in parameters if p.kind in (kinds.POSITIONAL_ONLY, kinds.POSITIONAL_OR_KEYWORD)]
    takes_any_name = any(p.kind == kinds.VAR_KEYWORD for p in parameters)
    are_names = all(name.isidentifier() and not keyword.iskeyword(name) for name in names)
    if are_names and {p.name for p in required} <= set(names) and (set(names) <= by_name or takes_any_name and required == []):
        if set(names) <= by_name or not positional:
            return "keywords"
    if any(p.kind == kinds.KEYWORD_ONLY for p in required):
        raise StudyError(f"the function takes {[p.name for p in required]}, and the factors are {names}")
    if any(p.kind == kinds.VAR_POSITIONAL for p in parameters) and len(required) <= len(names):
        return "columns"
    if len(required) == len(names) or len(required) < len(names) == len(positional):
        return "columns"
    if len(required) == 1 or not required and positional:
        return "matrix"
    raise StudyError(
        f"the function takes {len(required)} arguments, and there are {len(names)} factors ({', '.join(names)}): it should take "
        "one per factor, or one array of all (rows, factors)"
    )


class _Answer(NamedTuple):
    """What a function returned: (rows, values), the names of the outputs if it said them, and if it returned them one by one
    how many values each has, None for a single number."""

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


def _values(length: int | None) -> str:
    return "one value" if length is None else f"{length} values"


def _columns(answer: Any, rows: int, vectorised: bool) -> _Answer:
    """What a function returned, as (rows, values)."""
    if isinstance(answer, Mapping) or hasattr(answer, "columns") and hasattr(answer, "to_numpy"):
        names = [str(name) for name in answer]
        parts = [_numbers(answer[name]) for name in answer]
        return _stacked(parts, names, rows, vectorised)._replace(names=names)
    if isinstance(answer, tuple):
        parts = [_numbers(part) for part in answer]
        return _stacked(parts, [str(place) for place in range(len(parts))], rows, vectorised)
    values = _numbers(answer)
    if not vectorised:
        if values.ndim > 1:
            raise AnswerError(f"the function returned an array of shape {values.shape} for one row")
        return _Answer(values.reshape(1, -1), None, None)
    if values.ndim == 1 and len(values) == rows:
        return _Answer(values.reshape(rows, 1), None, None)
    if values.ndim == 2 and len(values) == rows:
        return _Answer(values, None, None)
    hint = ": if it is a function of one row, say vectorised=False" if values.ndim == 0 else ""
    shapes = f"({rows},) or ({rows}, outputs)"
    raise AnswerError(
        f"the function returned an array of shape {values.shape} for {rows} rows, and {shapes} was expected{hint}"
    )


def _numbers(part: Any) -> np.ndarray:
    values = np.asarray(part)
    if values.dtype.kind not in "fiub":
        raise AnswerError(f"the function returned {part!r:.80}: expected real numbers")
    return values.astype(float)


def _stacked(parts: list[np.ndarray], names: list[str], rows: int, vectorised: bool) -> _Answer:
    """Outputs one by one, each a number a row or a series: (rows,) or (rows, values), and of one row () or (values,)."""
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
    return _Answer(np.column_stack(columns), None, lengths)
