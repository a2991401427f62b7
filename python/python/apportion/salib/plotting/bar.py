"""Bars of indices."""

from __future__ import annotations

from typing import Any


def plot(Si_df: Any, ax: Any = None) -> Any:
    """Bars of the columns of a frame with half widths from those that end in `_conf`, on `ax` of matplotlib; returns the axes."""
    conf = [name for name in Si_df.columns if name.endswith("_conf")]
    errors = Si_df[conf].rename(columns=lambda name: name.removesuffix("_conf"))
    return Si_df.drop(columns=conf).plot(kind="bar", yerr=errors, ax=ax)
