from SALib.analyze.sobol import analyze
from SALib.sample.sobol import sample
from SALib.test_functions import Sobol_G

problem = {"num_vars": 8, "names": [f"x{k}" for k in range(8)], "bounds": [[0.0, 1.0]] * 8}

X = sample(problem, 256, calc_second_order=False, scramble=True, skip_values=256, seed=3)
Y = Sobol_G.evaluate(X) + 1000.0
Si = analyze(
    problem,
    Y,
    calc_second_order=False,
    num_resamples=50,
    conf_level=0.9,
    print_to_console=True,
    parallel=True,
    n_processors=2,
    seed=5,
)
for name, total, half in zip(problem["names"], Si["ST"], Si["ST_conf"]):
    print(f"{name}: {total:.3f} +- {half:.3f}")
