"""Inputs that were measured together: their correlations from a table, and fair shares of the variance."""

import apportion as ap
import numpy as np
import pandas as pd

rng = np.random.default_rng(1)
height = rng.normal(170, 10, 500)
measured = pd.DataFrame({"height": height, "weight": 0.9 * height - 80 + rng.normal(0, 8, 500), "age": rng.uniform(20, 60, 500)})

factors = {name: ap.Normal(column.mean(), column.std()) for name, column in measured.items()}
result = ap.analyse(lambda height, weight, age: weight / height**2 * 1e4 + 0.1 * age, factors, dependence=measured.corr(), base_samples=2048)
assert abs(np.sum(result.shapley) - 1) < 1e-6
assert result.shapley["weight"] > result.shapley["height"] > 0.0 and result.shapley["age"] > 0.0
