"""The identity of a function in journals: the version that is stated, or its code and the plain values that it holds."""

from __future__ import annotations

import functools
import hashlib
import types
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ._engine import StudyError

_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(Ellipsis))
# What is known by its name.
_BY_NAME = (type, types.ModuleType, types.BuiltinFunctionType, np.ufunc, np.dtype)


def identity_of(function: Callable[..., Any], quantiles: Iterable[Any], version: str | None) -> str:
    """The name of the function with its `version`, or with a digest of its code, defaults, arguments of `functools.partial`,
    variables of enclosing functions and decorators, and of the `quantiles` of its factors.

    A `StudyError` names what cannot be told from its earlier state: an object, a list, a dict.
    """
    digest = hashlib.sha256()
    _feed(digest, "a factor", tuple(quantile.identity() for quantile in quantiles), ())
    if version is None:
        _feed(digest, "the function", function, ())
    return f"{name_of(function)} version {version} {digest.hexdigest()[:16]}"


def name_of(value: Any) -> str:
    named = getattr(value, "func", value)
    return f"{getattr(named, '__module__', None)}.{getattr(named, '__qualname__', type(named).__qualname__)}"


def _feed(digest: Any, where: str, value: Any, above: tuple[int, ...]) -> None:
    """Adds a value that stands at `where` inside of functions with the `id`s `above`."""

    def parts(*values: Any, where: str = where) -> None:
        digest.update(f"{len(values)}:".encode())
        for part in values:
            _feed(digest, where, part, (*above, id(value)))

    digest.update(f"{type(value).__qualname__};".encode())
    if id(value) in above:
        digest.update(f"{len(above) - above.index(id(value))} above;".encode())
    elif isinstance(value, _PLAIN):
        digest.update(f"{value!r};".encode("utf-8", "surrogatepass"))
    elif isinstance(value, (tuple, frozenset)):
        parts(*(value if isinstance(value, tuple) else sorted(value, key=repr)))
    elif isinstance(value, np.generic) or type(value) is np.ndarray and value.dtype.kind != "O":
        digest.update(f"{value.dtype} {value.shape}:".encode() + value.tobytes())
    elif isinstance(value, types.CodeType):
        digest.update(value.co_code)
        parts(value.co_names, value.co_varnames, value.co_consts)
    elif isinstance(value, functools.partial):
        parts(value.func, value.args, *sorted(value.keywords.items()))
    elif isinstance(value, types.FunctionType):
        where = value.__qualname__
        parts(value.__code__, value.__defaults__, *sorted((value.__kwdefaults__ or {}).items()), where=where)
        for name, cell in zip(value.__code__.co_freevars, value.__closure__ or ()):
            # Empty until its variable is set.
            parts(name, *([cell.cell_contents] if cell != types.CellType() else []), where=f"{where} in {name}")
    elif isinstance(value, _BY_NAME):
        digest.update(f"{name_of(value)} {getattr(value, '__name__', value)};".encode())
    elif hasattr(value, "__wrapped__"):
        parts(value.__wrapped__)
    else:
        raise StudyError(
            f"journal: {where} holds a {type(value).__qualname__}, and it is unknown whether its runs are those of an earlier one: "
            'state version="1", and another version after each change of the function or of what it holds'
        )
