import numpy as np
from SALib.analyze import sobol
from SALib.sample import sobol as sobol_sample
from SALib.test_functions import Ishigami

problem = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}

X = sobol_sample.sample(problem, 512, seed=101)
Y = Ishigami.evaluate(X)
Si = sobol.analyze(problem, Y, print_to_console=True, keep_resamples=True, seed=7)

print(Si["S1"], Si["S1_conf"])
print(f"x1-x3: {Si['S2'][0, 2]:.6f}")
print(Si["ST_conf_all"].shape)
