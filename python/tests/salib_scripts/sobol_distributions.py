import numpy as np
import pandas as pd
from SALib.analyze import sobol
from SALib.sample import sobol as sobol_sample

problem = {
    "names": ["price", "demand", "share", "delay", "loss", "rate", "wear"],
    "num_vars": 7,
    "bounds": [[10, 2], [0.0, 0.3], [1, 3, 0.25], [0, 1], [-1, 1, 0, 0.5], [1, 10], [2, 3]],
    "dists": ["norm", "lognorm", "triang", "unif", "truncnorm", "logunif", "weibull"],
}

X = sobol_sample.sample(problem, 256, calc_second_order=False, seed=np.random.default_rng(1))
Y = X[:, 0] * X[:, 1] * (1 + X[:, 2]) - X[:, 3] + X[:, 4] * X[:, 5] - X[:, 6]
Si = sobol.analyze(problem, Y, calc_second_order=False, seed=2)
table = pd.concat(Si.to_df(), axis=1).sort_values("ST", ascending=False)
print(table.round(4))
