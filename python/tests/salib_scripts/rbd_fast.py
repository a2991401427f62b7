import numpy as np
from SALib.analyze import rbd_fast
from SALib.sample import latin
from SALib.test_functions import Ishigami

problem = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}

X = latin.sample(problem, 1000, seed=1)
Y = Ishigami.evaluate(X)
Si = rbd_fast.analyze(problem, X, Y, M=8, num_resamples=20, print_to_console=True, seed=9)
bars = Si.plot()
print(len(bars.patches), np.round(Si["S1"], 6))
