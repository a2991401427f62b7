"""Charts and a table for a paper."""

import tempfile
from pathlib import Path

import apportion as ap
import matplotlib
import numpy as np

matplotlib.use("Agg")

result = ap.analyse(lambda x, y: np.sin(3 * x) + y, {"x": (0, 1), "y": (0, 1)}, base_samples=512, name="figure")
with tempfile.TemporaryDirectory() as folder:
    result.save(folder, charts=["pdf"], width="88mm")
    charts = list(Path(folder, "charts").glob("*.pdf"))
    assert charts and all(chart.read_bytes().startswith(b"%PDF") for chart in charts)
assert r"\begin{tabular}" in result.to_latex() and r"$\pm$" in result.to_latex()
axes = result.plot()
assert len(axes.patches) == 4
