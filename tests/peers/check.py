"""Our points, functions and estimators against SALib, SciPy and the papers' formulas.

    cargo run --release --example dump_design -- FOLDER
    python tests/peers/check.py FOLDER

The first command writes designs, their outputs and our indices, and tables with our measures (`measures.py`); this script gives the same outputs to the estimators of
SALib and SciPy, and to formulas written here from the papers, in extended precision and without our rearrangements. It
ends with code 1 if anything differs by more than its tolerance.
"""

import csv
import json
import sys
import warnings
from pathlib import Path

import measures
import numpy as np
from SALib.analyze import sobol as salib
from SALib.test_functions import Ishigami, Sobol_G
from scipy import stats

# Of indices, which are of size 1. Centred sums are good to some 1e-15, ours and theirs. A formula that is not centred
# loses, with outputs of mean 100 and standard deviation 0.7, up to 100 * 100 / 0.5 = 2e4 of them; measured: 5e-12.
TOLERANCE = 1e-10

PRECISE = np.longdouble


def read(path):
    """Columns by name."""
    with open(path, newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        values = np.array([[float(value) for value in row] for row in rows])
    return dict(zip(names, values.T, strict=True))


class Checks:
    """Largest difference of each comparison, and whether all are within their tolerances."""

    def __init__(self):
        self.failed = 0
        self.count = 0

    def close(self, what, ours, theirs, tolerance=TOLERANCE):
        ours, theirs = np.asarray(ours, dtype=PRECISE), np.asarray(theirs, dtype=PRECISE)
        self.count += 1
        gap = float(np.max(np.abs(ours - theirs))) if ours.shape == theirs.shape else np.inf
        # Not "gap > tolerance": NaN is no agreement.
        bad = not gap <= tolerance
        self.failed += bad
        print(f"{'FAILED' if bad else 'ok':6} {gap:8.1e} of {tolerance:.0e}  {what}")


class Outputs:
    """The outputs of a case, a vector for A and B and a list of vectors, one per factor, for the others."""

    def __init__(self, table, d):
        def column(name):
            return table[name].astype(PRECISE)

        self.d = d
        self.a, self.b = column("y_A"), column("y_B")
        self.ab, self.ba = ([column(f"y_{row}_{j + 1}") for j in range(d)] for row in ("AB", "BA"))


# The papers' formulas. a, b, ... are the outputs at A, B, ...; j is the factor.


def mean_square(x):
    return np.mean(x * x)


def pooled(y):
    """Mean and variance of A and B together."""
    both = np.concatenate([y.a, y.b])
    return np.mean(both), np.var(both)


def sobol_1993(y, j):
    """Saltelli et al. (2010), table 2 (a), with mean and variance of the sample B alone."""
    return (np.mean(y.b * y.ab[j]) - np.mean(y.b) ** 2) / np.var(y.b)


def homma_saltelli_first(y, j):
    """Homma and Saltelli (1996): U_j less the squared mean."""
    f0, v = pooled(y)
    return (np.mean(y.b * y.ab[j]) - f0 * f0) / v


def homma_saltelli_total(y, j):
    """Saltelli et al. (2010), table 2 (d): V less (U_-j less the squared mean)."""
    f0, v = pooled(y)
    return 1 - (np.mean(y.a * y.ab[j]) - f0 * f0) / v


def saltelli_2002(y, j):
    """Saltelli (2002): U_j with the divisor n - 1, the squared mean as the mean of products of A and B."""
    n = len(y.a)
    u = np.dot(y.b, y.ab[j]) / (n - 1)
    return (u - np.dot(y.a, y.b) / n) / np.var(y.a, ddof=1)


def sobol_2007_first(y, j):
    """Sobol' et al. (2007), not centred."""
    return np.mean(y.b * (y.ab[j] - y.a)) / pooled(y)[1]


def sobol_2007_total(y, j):
    """Saltelli et al. (2010), table 2 (e), not centred."""
    return np.mean(y.a * (y.a - y.ab[j])) / pooled(y)[1]


def saltelli_2010(y, j):
    """Saltelli et al. (2010), table 2 (b), on outputs less their mean."""
    f0, v = pooled(y)
    return np.mean((y.b - f0) * ((y.ab[j] - f0) - (y.a - f0))) / v


def jansen_first(y, j):
    """Saltelli et al. (2010), table 2 (c)."""
    v = pooled(y)[1]
    return (v - mean_square(y.b - y.ab[j]) / 2) / v


def jansen_total(y, j):
    """Saltelli et al. (2010), table 2 (f)."""
    return mean_square(y.a - y.ab[j]) / 2 / pooled(y)[1]


def janon(x, z):
    """T_N of Janon et al. (2014)."""
    m = (np.mean(x) + np.mean(z)) / 2
    return (np.mean(x * z) - m * m) / ((mean_square(x) + mean_square(z)) / 2 - m * m)


def correlation(x, z):
    """Pearson's; numpy's own works in doubles."""
    x, z = x - np.mean(x), z - np.mean(z)
    return np.dot(x, z) / np.sqrt(np.dot(x, x) * np.dot(z, z))


def glen_isaacs(y, j):
    """Glen and Isaacs (2012), D3: the spurious correlation p is taken out of c_j and c_-j by a system of two equations."""
    c = (correlation(y.b, y.ab[j]) + correlation(y.a, y.ba[j])) / 2
    rest = (correlation(y.a, y.ab[j]) + correlation(y.b, y.ba[j])) / 2
    p = (correlation(y.a, y.b) + correlation(y.ab[j], y.ba[j])) / 2
    determinant = 1 - p * p
    u, w = (c - p * rest) / determinant, (rest - p * c) / determinant
    return c - p * w / (1 - u * w), 1 - (rest - p * u / (1 - u * w))


def azzini(y, j):
    """Azzini, Mara and Rosati (2021): first-order and total index."""
    a, b, ab, ba = y.a, y.b, y.ab[j], y.ba[j]
    denominator = np.sum((a - b) ** 2 + (ba - ab) ** 2)
    return 2 * np.sum((ba - b) * (a - ab)) / denominator, np.sum((b - ba) ** 2 + (a - ab) ** 2) / denominator


def differences(y, j, k):
    """V_jk as a mean of products of differences: the covariance over z of f(x_j, .) - f with f(x_k, .) - f."""
    products = [np.mean((y.ba[m] - y.b) * (y.ab[n] - y.a)) for m, n in ((j, k), (k, j))]
    return sum(products) / 2 / pooled(y)[1]


def mixture(numerator, of_none, of_one):
    """x = numerator/(x of_one + (1 - x) of_none), with x between 0 and 1 on the right side: by bisection."""
    of_one = max(of_one, of_none / 2)
    if numerator <= 0:
        return numerator / of_none
    if numerator >= of_one:
        return numerator / of_one
    # In extended precision, which NumPy's roots of polynomials do not have.
    low, high = np.longdouble(0), np.longdouble(1)
    for _ in range(100):
        x = (low + high) / 2
        low, high = (x, high) if x * (x * of_one + (1 - x) * of_none) < numerator else (low, x)
    return (low + high) / 2


def saltelli_pooled(y, j):
    f0, of_none = pooled(y)[0], np.var(np.concatenate([y.a, y.b, y.ab[j]]))
    covariance = np.clip(np.mean((y.a - f0) * (y.b - f0)), -of_none / 2, of_none / 2)
    of_one = np.var(np.concatenate([y.b, y.ab[j]]))
    return mixture(np.mean((y.b - f0) * (y.ab[j] - y.a)), of_none - covariance, of_one - covariance)


def jansen_pooled(y, j):
    of_none, of_one = np.var(np.concatenate([y.a, y.b, y.ab[j]])), np.var(np.concatenate([y.a, y.ab[j]]))
    return mixture(np.mean((y.a - y.ab[j]) ** 2) / 2, of_none, of_one)


FIRST_ORDER = {
    "sobol-1993": sobol_1993,
    "homma-saltelli-1996": homma_saltelli_first,
    "jansen-1999": jansen_first,
    "saltelli-2002": saltelli_2002,
    "sobol-2007": sobol_2007_first,
    "saltelli-2010": saltelli_2010,
    "saltelli-pooled": saltelli_pooled,
    "martinez-2011": lambda y, j: correlation(y.b, y.ab[j]),
    "glen-isaacs-2012": lambda y, j: glen_isaacs(y, j)[0],
    "janon-monod-2014": lambda y, j: janon(y.b, y.ab[j]),
    "azzini-2021": lambda y, j: azzini(y, j)[0],
}

TOTAL = {
    "homma-saltelli-1996": homma_saltelli_total,
    "jansen-1999": jansen_total,
    "jansen-pooled": jansen_pooled,
    "sobol-2007": sobol_2007_total,
    "martinez-2011": lambda y, j: 1 - correlation(y.a, y.ab[j]),
    "glen-isaacs-2012": lambda y, j: glen_isaacs(y, j)[1],
    "janon-monod-2014": lambda y, j: 1 - janon(y.a, y.ab[j]),
    "azzini-2021": lambda y, j: azzini(y, j)[1],
}

FUNCTIONS = {"ishigami": Ishigami.evaluate, "sobol-g": Sobol_G.evaluate}


def check_rows(checks, name, case, table):
    """Functions and rows: SALib's function at A and B, and at A with a column from B."""
    function, d = FUNCTIONS.get(case["function"]), case["factors"]
    if function is None:
        return
    a, b = (np.column_stack([table[f"x_{matrix}_{j + 1}"] for j in range(d)]) for matrix in "AB")
    rows = {"A": a, "B": b}
    for j in range(d):
        for row, base, other in (("AB", a, b), ("BA", b, a)):
            rows[f"{row}_{j + 1}"] = np.where(np.arange(d) == j, other, base)
    theirs = np.column_stack([function(x) for x in rows.values()])
    ours = np.column_stack([table[f"y_{row}"] for row in rows])
    # Rounding of values up to 120.
    checks.close(f"{name}: outputs at A, B, AB, BA, SALib", ours, theirs + case["offset"], 1e-12)


def check_peers(checks, name, case, y):
    """SALib's and SciPy's own estimators. SALib's functions leave the centring to their caller; SciPy centres."""
    d, f0 = y.d, pooled(y)[0]
    ours = case["indices"]
    a, b = ((column - f0).astype(float) for column in (y.a, y.b))
    ab, ba = ([(column - f0).astype(float) for column in columns] for columns in (y.ab, y.ba))
    first = [salib.first_order(a, ab[j], b) for j in range(d)]
    total = [salib.total_order(a, ab[j], b) for j in range(d)]
    checks.close(f"{name}: first order, SALib", ours["first_order"]["saltelli-2010"], first)
    checks.close(f"{name}: total, SALib", ours["total"]["jansen-1999"], total)
    as_given = {
        "f_A": y.a.astype(float)[None, :],
        "f_B": y.b.astype(float)[None, :],
        "f_AB": np.array(y.ab, dtype=float)[:, None, :],
    }
    if len(y.a) & (len(y.a) - 1) == 0:
        result = stats.sobol_indices(func=as_given, n=len(y.a), method="saltelli_2010")
        checks.close(f"{name}: first order, SciPy", ours["first_order"]["saltelli-2010"], np.ravel(result.first_order))
        checks.close(f"{name}: total, SciPy", ours["total"]["jansen-1999"], np.ravel(result.total_order))


def check_formulas(checks, name, case, y):
    """Every estimator against its paper's formula; an estimator without a formula here fails."""
    ours = case["indices"]
    for order, formulas in (("first_order", FIRST_ORDER), ("total", TOTAL)):
        for estimator, estimates in ours[order].items():
            checks.close(f"{name}: {order} {estimator}", estimates, [formulas[estimator](y, j) for j in range(y.d)])
    pairs = ours["second_order"]
    assert [(j, k) for j, k, _ in pairs] == [(j, k) for j in range(y.d) for k in range(j + 1, y.d)]
    checks.close(f"{name}: second order", [s for *_, s in pairs], [differences(y, j, k) for j, k, _ in pairs])


def check_sequence(checks, path):
    """Unscrambled points: SciPy's lie at the low end of their cell of width 2^-32, ours in its middle. Exactly."""
    first = int(path.stem.removeprefix("sobol-"))
    ours = np.column_stack(list(read(path).values()))
    for d in sorted({1, 2, 7, 20, ours.shape[1]}):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Numbers of points that are no power of two.
            engine = stats.qmc.Sobol(d, scramble=False, bits=32)
            if first > 0:  # SciPy cannot go forward by nothing.
                engine.fast_forward(first)
            theirs = engine.random(len(ours))
        checks.close(f"Sobol' points {first} on, {d} dimensions, SciPy", ours[:, :d] - 2.0**-33, theirs, 0.0)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check.py FOLDER (written by the example dump_design)")
    folder = Path(sys.argv[1])
    checks = Checks()
    sequences = sorted(folder.glob("sobol-[0-9]*.csv"))
    assert sequences, f"no sobol-FIRST.csv in {folder}"
    for path in sequences:
        check_sequence(checks, path)
    for name, case in json.loads((folder / "indices.json").read_text()).items():
        table = read(folder / f"{name}.csv")
        y = Outputs(table, case["factors"])
        check_rows(checks, name, case, table)
        check_peers(checks, name, case, y)
        check_formulas(checks, name, case, y)
    ours = json.loads((folder / "measures.json").read_text())
    measures.check(checks, ours, lambda name: read(folder / f"{name}.csv"))
    print(f"{checks.count} comparisons, {checks.failed} failed")
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
