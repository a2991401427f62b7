import numpy as np
from SALib.analyze import sobol
from SALib.sample import saltelli
from SALib.test_functions import Sobol_G

problem = {
    "num_vars": 4,
    "names": ["length", "width", "load", "angle"],
    "groups": ["shape", "shape", "load", "mount"],
    "bounds": [[0, 1]] * 4,
}

X = saltelli.sample(problem, 128)
Y = Sobol_G.evaluate(X, a=np.array([0.0, 0.5, 3.0, 9.0]))
Si = sobol.analyze(problem, Y, seed=11)
total, first, second = Si.to_df()
print(total)
print(second)
