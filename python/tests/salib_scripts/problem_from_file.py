from pathlib import Path

from SALib.analyze import sobol
from SALib.sample import sobol as sobol_sample
from SALib.util import read_param_file

Path("params.txt").write_text("a,0,2,g1,unif\nb,1,3,g2,norm\nc,0,1,g1,unif\n")
problem = read_param_file("params.txt")
print(problem)

X = sobol_sample.sample(problem, 64, calc_second_order=False, seed=4)
Y = X[:, 0] + X[:, 1] ** 2 * X[:, 2]
Si = sobol.analyze(problem, Y, calc_second_order=False, num_resamples=20, seed=4)
print(Si.to_df()[0])
