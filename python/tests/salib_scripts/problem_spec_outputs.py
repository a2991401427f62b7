import matplotlib
import numpy as np
from SALib import ProblemSpec

matplotlib.use("Agg")


def model(X, power):
    return np.column_stack([X[:, 0] + X[:, 1] ** power, X[:, 1] * X[:, 2]])


sp = ProblemSpec({"names": ["a", "b", "c"], "bounds": [[0, 1], [1, 2], [0, 3]], "outputs": ["sum", "product"]})
sp.sample_sobol(128, calc_second_order=False, seed=2)
sp.evaluate(model, 3)
sp.analyze_sobol(calc_second_order=False, num_resamples=30, seed=2)
Si = sp.analysis["product"]
for name, (total, first) in zip(sp["outputs"], sp.to_df()):
    print(name, total.index[total["ST"].argmax()])
    print(first)
axes = sp.plot()
print(axes.shape, [len(ax.patches) for ax in axes.ravel()], axes[1, 0].get_title())
