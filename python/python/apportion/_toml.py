"""Study files, written."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._engine import StudyError


def dumps(table: Mapping[str, Any]) -> str:
    """The text of a study file: simple keys, then tables, then lists of tables."""
    lines = [f"{_key(key)} = {value_of(value)}" for key, value in table.items() if not _is_table(value)]
    for key, value in table.items():
        for part in value if _is_tables(value) else [value] if isinstance(value, Mapping) else []:
            lines += ["", f"[[{_key(key)}]]" if _is_tables(value) else f"[{_key(key)}]"]
            lines += [f"{_key(name)} = {value_of(inner)}" for name, inner in part.items()]
    return "\n".join(lines) + "\n"


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(part, Mapping) for part in value)


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping) or _is_tables(value)


def _key(key: str) -> str:
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else json.dumps(key)


def value_of(value: Any) -> str:
    """A value as written in a study file."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return repr(number) if math.isfinite(number) else "nan" if math.isnan(number) else "inf" if number > 0 else "-inf"
    if isinstance(value, str):
        # Escapes of JSON are escapes of TOML, but for the one that it does not need.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {value_of(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, (list, tuple, set, frozenset, np.ndarray)):
        return "[" + ", ".join(value_of(inner) for inner in value) + "]"
    raise StudyError(
        f"{value!r} cannot be a value of a study: expected a number, a text, true or false, a list or a table of these"
    )
