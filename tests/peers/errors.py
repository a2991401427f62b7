"""Errors and seconds of first-order and total indices compared with SciPy and SALib, at equal runs: docs/accuracy/peers.md.

    python tests/peers/errors.py [SEEDS]

needs `requirements.txt` next to it and the package of `python/`. Some ten minutes on two cores with 20 seeds.
"""
import math
import pathlib
import sys
import time
import warnings

import numpy as np
from SALib.analyze import sobol as salib_analyze
from SALib.sample import sobol as salib_sample
from scipy import stats

import apportion as ap

SIZES = [64, 256, 1024, 4096, 16384, 65536]
WAYS = ["apportion", "without surrogates", "SciPy", "SALib"]


class Product:
    """The product of functions of one factor each, all of them of values on 0 to 1; exact by their means and variances."""

    def __init__(self, name, parts, moments, distributions=None):
        self.name, self.parts = name, parts
        self.distributions = distributions or [stats.uniform(0, 1)] * len(parts)
        relative = np.array([variance / mean**2 for mean, variance in moments])
        every = np.prod(1 + relative)
        self.first = relative / (every - 1)
        self.total = relative * every / (1 + relative) / (every - 1)

    def __call__(self, x):
        return math.prod(part(column) for part, column in zip(self.parts, x.T))


class Sum:
    """a b and rare switches, added."""

    def __init__(self, name, probability, count):
        self.name, self.probability, self.count = name, probability, count
        self.distributions = [stats.uniform(0, 1)] * 2 + [stats.bernoulli(probability)] * count
        product, one = 7 / 144, 1 / 48
        switch = probability * (1 - probability)
        whole = product + count * switch
        self.first = np.array([one, one] + [switch] * count) / whole
        self.total = np.array([product - one] * 2 + [switch] * count) / whole

    def __call__(self, x):
        return x[:, 0] * x[:, 1] + x[:, 2:].sum(axis=1)


class Ishigami:
    name = "Ishigami (smooth)"
    distributions = [stats.uniform(-math.pi, 2 * math.pi)] * 3

    def __init__(self):
        a, b = 7, 0.1
        v1 = 0.5 * (1 + b * math.pi**4 / 5) ** 2
        v2, v13 = a**2 / 8, 8 * b**2 * math.pi**8 / 225
        self.first = np.array([v1, v2, 0]) / (v1 + v2 + v13)
        self.total = np.array([v1 + v13, v2, v13]) / (v1 + v2 + v13)

    def __call__(self, x):
        return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def power(low, high, exponent):
    """A factor from `low` to `high` to some power, with its mean and variance."""
    moment = lambda k: (high ** (k + 1) - low ** (k + 1)) / ((k + 1) * (high - low))
    part = lambda u: (low + (high - low) * u) ** exponent
    return part, (moment(exponent), moment(2 * exponent) - moment(exponent) ** 2)


def functions():
    cantilever = [power(0.8, 1.2, exponent) for exponent in (1, 1, 3, -3)]
    g = [0, 1, 4.5, 9, 99, 99, 99, 99]
    steps = [(0.3, 1), (0.6, 2), (0.5, 0.5), (0.9, 1)]
    spreads = [0.8, 0.5, 0.3, 0.2]
    return [
        Ishigami(),
        Product("cantilever, powers (smooth)", [part for part, _ in cantilever], [moments for _, moments in cantilever]),
        Product(
            "Sobol' G, 8 factors (kinks)",
            [lambda u, a=a: (abs(4 * u - 2) + a) / (1 + a) for a in g],
            [(1, 1 / (3 * (1 + a) ** 2)) for a in g],
        ),
        Product(
            "product of steps",
            [lambda u, edge=edge, height=height: 1 + height * (u > edge) for edge, height in steps],
            [(1 + height * (1 - edge), height**2 * edge * (1 - edge)) for edge, height in steps],
        ),
        Product(
            "log-normal product (skewed)",
            [lambda x: x] * 4,
            [(math.exp(s * s / 2), (math.exp(s * s) - 1) * math.exp(s * s)) for s in spreads],
            [stats.lognorm(s) for s in spreads],
        ),
        Sum("a b + d + e, switches of .03 (rare levels)", 0.03, 2),
    ]


def ours(function, size, seed, surrogate):
    factors = {f"x{i}": distribution for i, distribution in enumerate(function.distributions)}
    result = ap.analyse(function, factors, call="matrix", base_samples=size, seed=seed, surrogate=surrogate)
    return tuple(np.array([indices[name].estimate for name in factors]) for indices in (result.first_order, result.total))


def scipy(function, size, seed):
    found = stats.sobol_indices(
        func=lambda x: function(x.T), n=size, dists=function.distributions, rng=np.random.default_rng(seed)
    )
    return found.first_order, found.total_order


def salib(function, size, seed):
    count = len(function.distributions)
    problem = {"num_vars": count, "names": [f"x{i}" for i in range(count)], "bounds": [[0, 1]] * count}
    unit = salib_sample.sample(problem, size, calc_second_order=False, seed=seed)
    x = np.column_stack([distribution.ppf(u) for distribution, u in zip(function.distributions, unit.T)])
    found = salib_analyze.analyze(problem, function(x), calc_second_order=False, seed=seed)
    return found["S1"], found["ST"]


def measured(function, size, seeds):
    """Root mean square error over indices and seeds, and the median seconds, of each way."""
    rows = []
    ways = [lambda *a: ours(*a, "auto"), lambda *a: ours(*a, "off"), scipy, salib]
    for way in ways:
        squares, seconds = [], []
        for seed in range(1, seeds + 1):
            start = time.perf_counter()
            first, total = way(function, size, seed)
            seconds.append(time.perf_counter() - start)
            squares.append(np.concatenate([first - function.first, total - function.total]) ** 2)
        rows.append((math.sqrt(np.mean(squares)), float(np.median(seconds))))
    return rows


def main():
    warnings.simplefilter("ignore")
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    page = pathlib.Path(__file__).resolve().parents[2] / "docs/accuracy/peers.md"
    lines = [
        "# Compared with SciPy and SALib, at equal runs",
        "",
        "Root mean square error of all first-order and total indices, and in brackets the median milliseconds from the function",
        f"to the indices, on one machine of two cores; N base samples, N (d + 2) runs; {seeds} seeds, {max(seeds // 4, 2)} from N = 16,384 on.",
        "SciPy (`scipy.stats.sobol_indices`) and SALib (`sobol`, scrambled) take one net; apportion takes four, for its intervals.",
        "Every way gets the same vectorised Python function. Written by `python tests/peers/errors.py`.",
        "",
    ]
    for function in functions():
        lines += [f"**{function.name}**", "", "| N | " + " | ".join(WAYS) + " |", "|---|" + "---|" * len(WAYS)]
        for size in SIZES:
            cells = measured(function, size, seeds if size < 16384 else max(seeds // 4, 2))
            row = " | ".join(f"{error:.1e} ({1000 * seconds:.0f})" for error, seconds in cells)
            lines.append(f"| {size} | {row} |")
            print(function.name, lines[-1], flush=True)
        lines.append("")
    page.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
