from SALib.analyze.morris import analyze
from SALib.sample.morris import sample

problem = {
    "num_vars": 5,
    "names": ["a", "b", "c", "d", "e"],
    "groups": ["inner", "inner", "outer", "lone", "outer"],
    "bounds": [[0, 1], [0, 2], [-1, 1], [0, 3], [5, 6]],
}

X = sample(problem, 30, seed=8)
Y = X[:, 0] * X[:, 1] + X[:, 2] ** 2 + X[:, 3] + X[:, 4]
Si = analyze(problem, X, Y, seed=8)
scaled = analyze(problem, X, Y, scaled=True, seed=8)
print(Si.to_df())
print(scaled.to_df()["mu_star"])
