"""Indices as colours."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._indices import axes


def heatmap(sp: Any, metric: str | None = None, index: Any = None, title: str | None = None, ax: Any = None) -> Any:
    """Colours of the indices of the output `metric` of an analysed problem, by default the first, by factors or groups: of those named by
    `index`, or of all with a number for each. On `ax` of matplotlib; returns the axes."""
    metric = metric or sp["outputs"][0]
    found = sp._found()[metric]
    frames = found.to_df()
    columns: dict[str, Any] = {}
    for frame in frames if isinstance(frames, list) else [frames]:
        columns |= {key: frame[key] for key in frame if not key.endswith("_conf") and np.shape(found[key]) == (len(frame),)}
    names = [index] if isinstance(index, str) else list(index or columns)
    ax = axes(ax, (6.0, 0.6 * len(names) + 1.2))
    image = ax.imshow([columns[name] for name in names], aspect="auto")
    ax.set_yticks(range(len(names)), names)
    labels = list(columns[names[0]].index)
    ax.set_xticks(range(len(labels)), labels, rotation=90)
    ax.set_title(title or metric)
    ax.figure.colorbar(image, ax=ax)
    return ax
