import numpy as np
from SALib import ProblemSpec
from SALib.test_functions import Ishigami

sp = ProblemSpec({"names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3, "outputs": ["height"]})

sp.sample_sobol(256, calc_second_order=True, seed=1).evaluate(Ishigami.evaluate, A=5.0).analyze_sobol(seed=1)
Si = sp.analysis
total, first, second = sp.to_df()
print(sp)
print(second.loc[[("x1", "x3")]])
print(sp.samples.shape, sp.results.shape, sp["outputs"])
