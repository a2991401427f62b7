"""Warnings about results."""

from __future__ import annotations

import sys
import warnings

_PACKAGE = __name__.rpartition(".")[0]


class SensitivityWarning(UserWarning):
    """What a careful reader of a result should know."""


def warn(*texts: str) -> None:
    """Warns of each text once, at the line that called this package."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and f"{frame.f_globals.get('__name__')}.".startswith(f"{_PACKAGE}."):
        frame, level = frame.f_back, level + 1
    for text in dict.fromkeys(texts):
        warnings.warn(text, SensitivityWarning, stacklevel=level)
