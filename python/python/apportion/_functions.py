"""Functions of Python as models: how they are called, and what becomes of what they return."""

from __future__ import annotations

import hashlib
import inspect
import keyword
import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any

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
        self.outputs = list(outputs) if outputs is not None else None
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
        values, names = self._answer(self.rows(x))
        if self.outputs is None:
            self.outputs = names or (["y"] if values.shape[1] == 1 else [f"y{k + 1}" for k in range(values.shape[1])])
        self._check(values, names)
        return values

    def evaluate(self, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Outputs of the rows `x`, NaN where there are none, and (row, reason) where the function raised an exception.

        A block that raises is divided until the rows are found that do.
        """
        rows = self.rows(x)
        values = np.full((len(x), len(self.outputs or ())), np.nan)
        failures: list[tuple[int, str]] = []
        blocks = [(0, len(x))] if self.vectorised else [(row, row + 1) for row in range(len(x))]
        while blocks:
            first, last = blocks.pop()
            try:
                answer, names = self._answer(rows[first:last])
            except AnswerError:
                raise
            except Exception as error:
                if last - first == 1:
                    failures.append((first, traceback.format_exception_only(type(error), error)[-1].strip()))
                else:
                    middle = (first + last) // 2
                    blocks += [(middle, last), (first, middle)]
            else:
                self._check(answer, names)
                values[first:last] = answer
        return values, sorted(failures)

    def _answer(self, rows: np.ndarray) -> tuple[np.ndarray, list[str] | None]:
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

    def _check(self, values: np.ndarray, names: list[str] | None) -> None:
        expected = self.outputs or []
        if names is not None and names != expected:
            raise AnswerError(f"the function returned the outputs {names}, and {expected} were expected")
        if values.shape[1] != len(expected):
            raise AnswerError(f"the function returned {values.shape[1]} outputs, and {expected} were expected")

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


def _columns(answer: Any, rows: int, vectorised: bool) -> tuple[np.ndarray, list[str] | None]:
    """What a function returned, as (rows, outputs), and the names of the outputs if it said them."""
    if isinstance(answer, Mapping) or hasattr(answer, "columns") and hasattr(answer, "to_numpy"):
        names = [str(name) for name in answer]
        parts = [_numbers(answer[name]) for name in answer]
        return _stacked(parts, names, rows, vectorised), names
    if isinstance(answer, tuple):
        parts = [_numbers(part) for part in answer]
        return _stacked(parts, [str(place) for place in range(len(parts))], rows, vectorised), None
    values = _numbers(answer)
    if not vectorised:
        if values.ndim > 1:
            raise AnswerError(f"the function returned an array of shape {values.shape} for one row")
        return values.reshape(1, -1), None
    if values.ndim == 1 and len(values) == rows:
        return values.reshape(rows, 1), None
    if values.ndim == 2 and len(values) == rows:
        return values, None
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


def _stacked(parts: list[np.ndarray], names: list[str], rows: int, vectorised: bool) -> np.ndarray:
    shape = (rows,) if vectorised else ()
    for name, part in zip(names, parts):
        if part.shape != shape and part.shape != (rows,):
            raise AnswerError(f"output {name} has the shape {part.shape}, and {shape} was expected")
    if not parts:
        raise AnswerError("the function returned no outputs")
    return np.column_stack([part.reshape(rows) for part in parts])
