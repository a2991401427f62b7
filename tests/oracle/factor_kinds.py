"""Factors as people have them, by scipy.stats 1.17, frozen in factor_kinds.json: whole numbers, booleans, categories and
measured values; and families by what is stated of them (quantiles, mean, sd, mode), computed by scipy from parameters
that the file does not tell.

scipy's quantile is the smallest x with P(X <= x) >= u, ours has > u: the probabilities u avoid the steps.

Run from anywhere: python3 factor_kinds.py
"""

import json
import pathlib

import numpy as np
from scipy import stats

U = [1e-6, 0.013, 0.11, 0.23, 0.31, 0.47, 0.53, 0.61, 0.77, 0.83, 0.91, 0.987, 0.999999]


# Values that are listed have no error of their own: to the ends.
FAR = [2.0**-64, *U, 1 - 2.0**-53]


def listed(values, weights=None):
    """A distribution on a list; scipy wants each value once, in ascending order."""
    weights = np.ones(len(values)) if weights is None else np.asarray(weights, float)
    distinct = np.unique(values)
    shares = [weights[np.asarray(values) == value].sum() / weights.sum() for value in distinct]
    return stats.rv_discrete(values=(np.arange(len(distinct)), shares)), distinct


def kind(name, parameters, frozen):
    return dict(
        distribution=name,
        parameters=parameters,
        u=FAR,
        quantile=[float(x) for x in frozen.ppf(FAR)],
        mean=float(frozen.mean()),
        sd=float(frozen.std()),
    )


def of_list(name, parameters, values, weights=None):
    places, distinct = listed(values, weights)
    shares = places.pmf(np.arange(len(distinct)))
    mean = float(np.dot(shares, distinct))
    return dict(
        distribution=name,
        parameters=parameters,
        u=FAR,
        quantile=[float(distinct[int(place)]) for place in places.ppf(FAR)],
        mean=mean,
        sd=float(np.sqrt(np.dot(shares, (distinct - mean) ** 2))),
    )


MEASURED = [52.1, 48.0, 49.5, 51.0, 48.0, 50.25, 47.75, 53.0, 51.0, 51.0]
KINDS = [
    kind("integer", dict(min=a, max=b), stats.randint(a, b + 1)) for a, b in [(1, 6), (-3, 3), (0, 1000000), (7, 7)]
] + [
    kind("boolean", dict(probability=p), stats.bernoulli(p)) for p in [0.25, 0.5, 0.003, 0.9995]
] + [
    of_list("categorical", dict(labels=labels, values=values, weights=weights), values, weights)
    for labels, values, weights in [
        (["steel", "brass", "copper"], [0, 1, 2], [5, 2, 1]),
        (["<110>", "<100>"], [169, 130], [3, 1]),
        (["a", "b", "c", "d"], [1e-9, -2e-9, 4e-9, 3e-9], [1, 1, 0, 1]),
    ]
] + [
    of_list("empirical", dict(values=values), values) for values in [MEASURED, [3.5], [1e9, 1e9 + 1, 1e9 + 2]]
] + [
    of_list("discrete", dict(values=values, weights=weights), values, weights)
    for values, weights in [([3, 1, 2], [1, 0, 3]), ([1e-9, 5e-9, 2e-9], [2, 1, 1]), ([-1, 0, 1, 0], [1, 1, 1, 2])]
] + [
    of_list("constant", dict(value=value), [value]) for value in [225.0, -3e-9]
]


def stated(law, frozen, statistics, given=None):
    """The statistics of `frozen`; those that scipy does not know are `given`."""
    value = {"mean": lambda: frozen.mean(), "sd": lambda: frozen.std()}
    value |= {f"p{p:02}": lambda p=p: frozen.ppf(p / 100) for p in (1, 5, 10, 25, 50, 75, 90, 95, 99)}
    told = {name: float((given or {})[name] if name in (given or {}) else value[name]()) for name in statistics}
    return dict(
        law=law,
        stated=told,
        u=U,
        quantile=[float(x) for x in frozen.ppf(U)],
        mean=float(frozen.mean()),
        sd=float(frozen.std()),
    )


normal, log_normal = stats.norm(-3, 0.25), stats.lognorm(0.6, scale=np.exp(1.5))
triangle = stats.triang(0.3, 2, 5)
weibull, gumbel = stats.weibull_min(1.7, 0, 4e-6), stats.gumbel_r(1013, 558)
STATED = [
    stated("uniform", stats.uniform(-1, 4), ["p05", "p90"]),
    stated("uniform", stats.uniform(-1, 4), ["mean", "sd"]),
    stated("log-uniform", stats.loguniform(1e-9, 1e-6), ["p10", "p95"]),
    stated("normal", normal, ["p01", "p75"]),
    stated("log-normal", log_normal, ["p05", "p95"]),
    stated("triangular", triangle, ["mode", "p05", "p95"], dict(mode=2 + 0.3 * 5)),
    stated("weibull", weibull, ["mean", "sd"]),
    stated("weibull", weibull, ["p25", "p99"]),
    stated("gumbel", gumbel, ["mean", "sd"]),
    stated("gumbel", gumbel, ["p10", "p90"]),
]

target = pathlib.Path(__file__).with_suffix(".json")
lines = [",\n".join(json.dumps(case) for case in cases) for cases in (KINDS, STATED)]
target.write_text('{"kinds": [\n' + lines[0] + '\n],\n"stated": [\n' + lines[1] + "\n]}\n")
