"""Sixty factors: a screening finds the four that act, and the study of these fixes the others."""

import apportion as ap
import numpy as np


def model(x):
    return x[:, 7] + 2 * x[:, 21] * x[:, 33] + np.exp(x[:, 48])


factors = {f"x{k}": ap.Uniform(0, 1) for k in range(60)}
screening = ap.Study(model, factors, call="matrix").screen(8)
effects = screening.to_frame()["mu_star"].droplevel("output")
acting = list(effects[effects > 0].index)
assert sorted(acting) == ["x21", "x33", "x48", "x7"]

fixed = {name: factor if name in acting else 0.5 for name, factor in factors.items()}
result = ap.analyse(model, fixed, call="matrix", base_samples=256)
assert result.runs == 256 * 6 and len(result.total) == 60
assert [name for name, index in result.total.items() if index > 0] == ["x7", "x21", "x33", "x48"]
