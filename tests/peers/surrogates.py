"""Surrogates of OpenTURNS at the rows of ours: docs/accuracy/surrogate.md.

    cargo bench --bench surrogate -- FOLDER
    python tests/peers/surrogates.py FOLDER

needs `requirements.txt` next to it. Half an hour on two cores.
"""

import concurrent.futures
import json
import math
import os
import pathlib
import sys
import time

import numpy as np
import openturns as ot

WAYS = ["apportion", "chaos", "Gaussian process"]
NORMS = [0.5, 0.75, 1.0]
MAX_TERMS = 1000
# Maximum degree of up to so many factors: those of higher ones take minutes to list.
MAX_DEGREES = {10: 14, 20: 3, 30: 2}
# Rows of a Gaussian process at most: the search for its lengths takes half a minute at 200.
MAX_ROWS_OF_PROCESS = 100
# Digits of the exact indices.
ROUNDING = 1e-8
# Base samples for its indices: they err by less than it does.
BASE_SAMPLES = 1 << 13


def law(given):
    """A distribution of OpenTURNS."""
    values = {key: value for key, value in given.items() if key != "name"}
    low, high = values.get("min"), values.get("max")
    match given["name"]:
        case "uniform":
            return ot.Uniform(low, high)
        case "normal":
            return ot.Normal(values["mean"], values["sd"])
        case "log-normal":
            return ot.LogNormal(values["log_mean"], values["log_sd"])
        case "triangular":
            return ot.Triangular(low, values["mode"], high)
        case "truncated-normal":
            return ot.TruncatedDistribution(ot.Normal(values["mean"], values["sd"]), low, high)
        case "truncated-gumbel":
            return ot.TruncatedDistribution(ot.Gumbel(values["scale"], values["location"]), low, high)
        case name:
            raise ValueError(name)


def by_chaos(x, y, laws):
    """Sparse chaos by least angles; the hyperbolic norm and the degree that leave least by the corrected leave-one-out error."""
    d = len(laws)
    bases = [ot.StandardDistributionPolynomialFactory(law) for law in laws]
    best = (math.inf, None)
    # Of so many factors, .75 and 1 have the same terms of degree 2, and those of 1 take minutes to list.
    for norm in NORMS if d <= 20 else NORMS[:2]:
        enumerate_function = ot.HyperbolicAnisotropicEnumerateFunction(d, norm)
        product = ot.OrthogonalProductPolynomialFactory(bases, enumerate_function)
        worse = 0
        for degree in range(1, 1 + next(degree for factors, degree in MAX_DEGREES.items() if d <= factors)):
            terms = enumerate_function.getBasisSizeFromTotalDegree(degree)
            if terms > MAX_TERMS or worse == 2:
                break
            adaptive = ot.FixedStrategy(product, terms)
            selection = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
            projection = ot.LeastSquaresStrategy(selection)
            algorithm = ot.FunctionalChaosAlgorithm(x, y, ot.JointDistribution(laws), adaptive, projection)
            algorithm.run()
            result = algorithm.getResult()
            error = min(result.getErrorHistory())
            worse = 0 if error < best[0] else worse + 1
            if error < best[0]:
                best = (error, result)
    indices = ot.FunctionalChaosSobolIndices(best[1])
    return [indices.getSobolIndex(j) for j in range(d)], [indices.getSobolTotalIndex(j) for j in range(d)]


def by_gaussian_process(x, y, laws):
    """The kernel of three that has the largest likelihood, each with a length for every factor; indices of its mean."""
    d = len(laws)
    u = np.column_stack([np.array(law.computeCDF(x[:, [j]])).ravel() for j, law in enumerate(laws)])
    z = np.column_stack([to_scores(u[:, j], law) for j, law in enumerate(laws)])
    best = (-math.inf, None)
    for kernel in [ot.SquaredExponential(d), ot.MaternModel([1.0] * d, 1.5), ot.MaternModel([1.0] * d, 2.5)]:
        kernel.setScale([2.0] * d)
        fitter = ot.GaussianProcessFitter(z, y, kernel, ot.ConstantBasisFactory(d).build())
        fitter.setOptimizationBounds(ot.Interval([0.05] * d, [50.0] * d))
        # The default one (Cobyla) stops far from the optimum.
        fitter.setOptimizationAlgorithm(ot.TNC())
        try:
            fitter.run()
        except (RuntimeError, TypeError):
            continue
        fitted = fitter.getResult()
        likelihood = fitted.getOptimalLogLikelihood()
        if likelihood > best[0]:
            regression = ot.GaussianProcessRegression(fitted)
            regression.run()
            best = (likelihood, regression.getResult().getMetaModel())
    points = np.array(ot.LowDiscrepancyExperiment(ot.SobolSequence(), ot.JointDistribution([ot.Uniform(0, 1)] * (2 * d)), BASE_SAMPLES, True).generate())
    a, b = (np.column_stack([to_scores(half[:, j], law) for j, law in enumerate(laws)]) for half in (points[:, :d], points[:, d:]))
    y_a, y_b = values(best[1], a), values(best[1], b)
    mean, variance = np.mean([y_a, y_b]), np.var(np.concatenate([y_a, y_b]))
    first, total = [], []
    for j in range(d):
        mixed = a.copy()
        mixed[:, j] = b[:, j]
        y_ab = values(best[1], mixed)
        first.append(np.mean((y_b - mean) * (y_ab - y_a)) / variance)
        total.append(np.mean((y_a - y_ab) ** 2) / 2 / variance)
    return first, total


def values(function, rows):
    return np.array(function(rows)).ravel()


def to_scores(u, law):
    """Scores of size 1: normal ones of what has normal tails, else uniform ones."""
    if law.getName() in ("Normal", "LogNormal"):
        return np.array(ot.Normal().computeQuantile(np.clip(u, 1e-15, 1 - 1e-15))).ravel()
    return 2 * math.sqrt(3) * (u - 0.5)


def squares(indices, table):
    """Sums of squared errors of first-order and of total indices."""
    both = zip(indices, (table["first_order"], table["total"]), strict=True)
    return [float(np.sum((np.array(ours) - np.array(exact)) ** 2)) for ours, exact in both]


def measured(table):
    """Squared errors, seconds, and coverage and half width of our intervals."""
    ot.Log.Show(ot.Log.NONE)
    ot.TBB.Disable()
    x, y = np.array(table["x"]).T, np.array(table["y"])
    # Of variance 1, as some of its optimisers expect.
    y = ((y - y.mean()) / y.std())[:, None]
    laws = [law(given) for given in table["distributions"]]
    kinds = ("first_order", "total")
    ours = [[index["estimate"] for index in table["ours"][kind]] for kind in kinds]
    rows = [(squares(ours, table), table["ours"]["seconds"])]
    for way in (by_chaos, by_gaussian_process) if len(y) <= MAX_ROWS_OF_PROCESS else (by_chaos,):
        start = time.perf_counter()
        rows.append((squares(way(x, y, laws), table), time.perf_counter() - start))
    held = [
        sum(index["low"] - ROUNDING <= exact <= index["high"] + ROUNDING for index, exact in zip(table["ours"][kind], table[kind], strict=True))
        for kind in kinds
    ]
    widths = [sum(index["high"] - index["low"] for index in table["ours"][kind]) / 2 for kind in kinds]
    return {"rows": rows, "held": held, "widths": widths, "count": len(laws)}


def of_function(results):
    """Root mean square errors of each way, its median seconds, and coverage and mean half width of ours."""
    count, ways = sum(result["count"] for result in results), len(results[0]["rows"])
    errors = [
        [math.sqrt(sum(result["rows"][way][0][kind] for result in results) / count) for kind in (0, 1)] for way in range(ways)
    ]
    seconds = [float(np.median([result["rows"][way][1] for result in results])) for way in range(ways)]
    coverage, widths = ([sum(result[key][kind] for result in results) / count for kind in (0, 1)] for key in ("held", "widths"))
    return {"errors": errors, "seconds": seconds, "coverage": coverage, "widths": widths}


def geometric(values):
    return math.exp(np.mean(np.log(np.maximum(values, 1e-16))))


def pair(two):
    return f"{two[0]:.1e}, {two[1]:.1e}"


def page(found, seeds):
    """The page of functions by rows, as `of_function` has them."""
    lines = [
        "# Surrogates from few rows, compared with OpenTURNS",
        "",
        "Root mean square errors of first-order and of total indices from the same rows, those of a Latin hypercube, with the",
        f"distributions of the inputs known; {seeds} seeds. OpenTURNS {ot.__version__}: sparse chaos expansions by least angles on at most 1000 terms, of the degree and",
        "hyperbolic norm (.5, .75, 1) of the smallest corrected leave-one-out error; a Gaussian process with a length for each factor, of the",
        "kernel of three (squared exponential, Matern 3/2, 5/2) with the largest likelihood (up to 100 rows). Written by `cargo bench --bench surrogate --",
        "FOLDER` and `python tests/peers/surrogates.py FOLDER`.",
        "",
    ]
    sizes = sorted(found)
    for title, names in [
        ("The 13 dense functions, geometric means", lambda of: [name for name, entry in of.items() if entry["dense"]]),
        ("All 17, which adds Ishigami's, Friedman's, a step, and few of 30 factors", lambda of: list(of)),
    ]:
        lines += [f"## {title}", "", "| rows | " + " | ".join(WAYS) + " | best of the others over ours | coverage | half width |"]
        lines += ["|---|" + "---|" * (len(WAYS) + 3)]
        for rows in sizes:
            chosen = [found[rows][name] for name in names(found[rows])]
            ways = range(len(chosen[0]["errors"]))
            means = [[geometric([entry["errors"][way][kind] for entry in chosen]) for kind in (0, 1)] for way in ways]
            gains = [min(mean[kind] for mean in means[1:]) / means[0][kind] for kind in (0, 1)]
            coverage = [float(np.mean([entry["coverage"][kind] for entry in chosen])) for kind in (0, 1)]
            widths = [geometric([entry["widths"][kind] for entry in chosen]) for kind in (0, 1)]
            cells = [pair(way) for way in means] + ["-"] * (len(WAYS) - len(means)) + [f"{gains[0]:.1f}, {gains[1]:.1f}", f"{coverage[0]:.3f}, {coverage[1]:.3f}", pair(widths)]
            lines.append(f"| {rows} | " + " | ".join(cells) + " |")
        lines.append("")
    for rows in sizes:
        lines += [f"## Each function at {rows} rows", "", "In brackets the median seconds on one core; Morris's are for the list of terms of 20 factors.", ""]
        ways = WAYS[: len(next(iter(found[rows].values()))["errors"])]
        lines += ["| function | " + " | ".join(ways) + " | coverage |", "|---|" + "---|" * (len(ways) + 1)]
        for name, entry in found[rows].items():
            cells = [f"{pair(errors)} ({seconds:.2f})" for errors, seconds in zip(entry["errors"], entry["seconds"], strict=True)]
            lines.append(f"| {name} | " + " | ".join(cells) + f" | {entry['coverage'][0]:.2f}, {entry['coverage'][1]:.2f} |")
        lines.append("")
    return "\n".join(lines)


def main():
    folder = pathlib.Path(sys.argv[1])
    found, seeds = {}, 0
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        for path in sorted(folder.glob("*.json")):
            tables = json.loads(path.read_text())
            results = list(pool.map(measured, tables))
            first, seeds = tables[0], len(tables)
            entry = {"dense": first["dense"], **of_function(results)}
            found.setdefault(first["rows"], {})[first["function"]] = entry
            print(path.name, entry, flush=True)
    target = pathlib.Path(__file__).resolve().parents[2] / "docs/accuracy/surrogate.md"
    target.write_text(page(found, seeds), encoding="utf-8")


if __name__ == "__main__":
    main()
