"""Our measures of a table against SALib, OpenTURNS and formulas.

OpenTURNS is asked where it is installed; all of its measures that are compared have a formula here too.
"""

import numpy as np
from SALib.analyze import delta, pawn, rbd_fast
from scipy import stats

try:
    import openturns
except ImportError:
    openturns = None

PROBLEM = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}


def columns(table):
    """Inputs as a matrix, and the output."""
    return np.column_stack([table[f"x_{j + 1}"] for j in range(3)]), table["y"]


def distances(x, y, classes):
    """Largest distances of the distribution functions of y above and below that of all, for classes of equal numbers of x, by number."""
    rank = np.empty(len(x), dtype=int)
    rank[np.argsort(x)] = np.arange(len(x))
    label = rank * classes // len(x)
    ends = []
    for own in (y[label == k] for k in range(classes)):
        above, below = (stats.ks_2samp(own, y, alternative=side).statistic for side in ("greater", "less"))
        ends.append((len(own), above, below))
    return np.array(ends)


def classes_for(rows):
    """Plischke, Borgonovo and Smith (2013), as in SALib."""
    return min(int(np.ceil(rows ** (2 / (7 + np.tanh((1500 - rows) / 500))))), 48)


def r2_hsic(x, y):
    """HSIC(x, y)/sqrt(HSIC(x, x) HSIC(y, y)), with Gaussian kernels of the width of the standard deviation: traces of centred matrices."""

    def centred(z):
        kernel = np.exp(-(((z[:, None] - z[None, :]) / np.std(z, ddof=1)) ** 2) / 2)
        return kernel - kernel.mean(0) - kernel.mean(1)[:, None] + kernel.mean()

    k, m = centred(x), centred(y)
    return np.sum(k * m) / np.sqrt(np.sum(k * k) * np.sum(m * m))


def reduced_delta(x, y, resamples=50):
    """Delta by SALib's densities of the normal scores of y, less the bias by resamples of the rows: ours has others, whose mean is off by
    some 0.003.

    SALib's `analyze` itself takes (since 1.6) one resample of the rows for its estimate.
    """
    y = stats.norm.ppf((stats.rankdata(y) - 0.5) / len(y))
    rows, grid = len(y), np.linspace(np.min(y), np.max(y), 100)
    ends = np.linspace(0, rows, classes_for(rows) + 1)
    random = np.random.default_rng(1)
    drawn = (random.integers(0, rows, rows) for _ in range(resamples))
    resampled = [delta.calc_delta(y[rows], grid, x[rows], ends) for rows in drawn]
    return 2 * delta.calc_delta(y, grid, x, ends) - np.mean(resampled)


def check_given(checks, ours, table):
    x, y = columns(table)
    values = {name: np.array(measure["values"]) for name, measure in ours.items()}
    theirs = rbd_fast.analyze(PROBLEM, x, y, M=10, num_resamples=2)["S1"]
    checks.close("given data: Fourier, SALib's rbd_fast", values["fourier"], theirs)
    theirs = [reduced_delta(x[:, j], y) for j in range(3)]
    # Wide kernels smooth densities, so that their delta is too small; ours is corrected by narrower ones.
    below = np.minimum(values["delta"] - theirs, 0)
    checks.close("given data: delta, not below that of SALib's densities", below, np.zeros(3), 0.015)
    # SALib leaves the largest row out of the last class of 100.
    theirs = pawn.analyze(PROBLEM, x, y, S=10)
    checks.close("given data: PAWN median, SALib", values["pawn_median"], theirs["median"], 0.01)
    checks.close("given data: PAWN max, SALib", values["pawn_max"], theirs["maximum"], 0.01)
    slides = [np.max(distances(x[:, j], y, 10)[:, 1:], axis=1) for j in range(3)]
    checks.close("given data: PAWN median, SciPy's distances", values["pawn_median"], np.median(slides, axis=1))
    checks.close("given data: PAWN max, SciPy's distances", values["pawn_max"], np.max(slides, axis=1))
    checks.close("given data: R2-HSIC, formula", values["r2_hsic"], [r2_hsic(x[:, j], y) for j in range(3)])
    if openturns is None:
        print("OpenTURNS is not installed: nothing compared with it")
        return
    kernels = [openturns.SquaredExponential([np.std(column, ddof=1)], [1.0]) for column in [*x.T, y]]
    hsic = openturns.HSICEstimatorGlobalSensitivity(kernels, x, y[:, None], openturns.HSICVStat())
    checks.close("given data: R2-HSIC, OpenTURNS", values["r2_hsic"], np.array(hsic.getR2HSICIndices()))
    checks.close("given data: p of HSIC, OpenTURNS", ours["r2_hsic"]["p"], np.array(hsic.getPValuesAsymptotic()), 1e-8)


def check(checks, ours, read):
    """`read` gives the table of a name."""
    check_given(checks, ours["given"], read("given"))
