"""How a function is to be called, from its signature."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Callable
from typing import Any

import numpy as np

from ._engine import StudyError

STYLES = ("columns", "keywords", "matrix")
_SAY = (
    'say call="columns" (one argument per factor, in their order), "keywords" (by name) or "matrix" (all factors in one array)'
)


def style_of(function: Callable[..., Any], names: list[str]) -> str:
    """One of `STYLES` for a function of the factors `names`; a `StudyError` where it cannot be determined, or where it is certain that
    an argument would get another factor than its name says, or an option a factor."""
    if isinstance(function, np.ufunc):
        return "columns" if function.nin == len(names) else "matrix"
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        raise StudyError(f"the arguments of the function are unknown: {_SAY}") from None
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
        return _by_place(positional, names)
    if len(required) == len(names):
        return _by_place(positional, names)
    if len(required) < len(names) == len(positional):
        options = [p.name for p in positional[len(required) :]]
        raise StudyError(
            f"the function takes {', '.join(p.name for p in positional)}, and the factors are {', '.join(names)}: it is unknown "
            f"whether {' and '.join(options)}, with a default value, should get a factor: {_SAY}"
        )
    if len(required) == 1 or not required and positional:
        return "matrix"
    raise StudyError(
        f"the function takes {len(required)} arguments, and there are {len(names)} factors ({', '.join(names)}): it should take "
        "one per factor, or one array of all (rows, factors)"
    )


def _by_place(positional: list[inspect.Parameter], names: list[str]) -> str:
    """One argument per factor, unless that gives an argument that has the name of a factor another one."""
    for parameter, name in zip(positional, names):
        if parameter.name != name and parameter.name in names:
            raise StudyError(
                f"the function takes {', '.join(p.name for p in positional)}, and the factors are {', '.join(names)}: by position "
                f"its argument {parameter.name} would get the factor {name}: {_SAY}"
            )
    return "columns"
