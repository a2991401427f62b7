from SALib.analyze import morris
from SALib.sample import morris as morris_sample

problem = {"num_vars": 4, "names": ["a", "b", "c", "d"], "bounds": [[0, 1], [-1, 1], [10, 20], [0, 100]]}

X = morris_sample.sample(problem, 20, num_levels=6, optimal_trajectories=None, seed=1)
Y = X[:, 0] ** 2 + X[:, 0] * X[:, 1] + 0.1 * X[:, 2]
Si = morris.analyze(problem, X, Y, num_resamples=200, conf_level=0.95, print_to_console=True, num_levels=6, seed=3)
for name, size, spread in zip(Si["names"], Si["mu_star"], Si["sigma"]):
    print(f"{name}: {size:.4f} {spread:.4f}")
