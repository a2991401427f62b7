"""Checks of numbers."""

from __future__ import annotations

import numbers
from typing import Any

from ._engine import StudyError

# As the program has it.
MAX_THREADS = 1024
MAX_SEED = 2**64 - 1


def whole(name: str, value: Any, least: int, most: int) -> int:
    """`value` as an `int` from `least` to `most`; otherwise a `StudyError` states the expected range of `name`."""
    is_whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if not is_whole or not least <= int(value) <= most:
        end = "2**64 - 1" if most == MAX_SEED else str(most)
        raise StudyError(f"{name} must be a whole number from {least} to {end}, not {value!r}")
    return int(value)
