"""Quantiles, means and standard deviations by scipy.stats 1.17, frozen in distributions.json.

Where scipy loses digits (truncated normal: quantiles near 1 by 1e-11, sd far out by 1e-9; sd of a Weibull of large
shape by 1e-10, of a narrow log-normal by 1e-11) mpmath 1.3 computes the same to 50 digits.

Run from anywhere: python3 distributions.py
"""

import json
import pathlib

import mpmath as mp
import numpy as np
from scipy import stats

mp.mp.dps = 50

U = [2.0**-64, 2.0**-33, 1e-6, 0.01, 0.1, 0.25, 0.5, 0.6, 0.75, 0.9, 0.99, 0.999999, 1 - 2.0**-33, 1 - 2.0**-53]


def log_normal(mean, sd):
    log_variance = np.log1p((sd / mean) ** 2)
    return stats.lognorm(np.sqrt(log_variance), scale=mean * np.exp(-log_variance / 2))


class TruncatedNormal:
    """Exact to 50 digits; scipy's quantile is only the start of the iteration."""

    def __init__(self, mean, sd, low, high):
        self.mean0, self.sd0 = mp.mpf(mean), mp.mpf(sd)
        self.a, self.b = (mp.mpf(low) - self.mean0) / self.sd0, (mp.mpf(high) - self.mean0) / self.sd0
        self.start = stats.truncnorm(float(self.a), float(self.b))
        self.mass = self.between(self.a, self.b)

    @staticmethod
    def between(a, b):
        return mp.ncdf(-a) - mp.ncdf(-b) if a > 0 else mp.ncdf(b) - mp.ncdf(a)

    def ppf(self, us):
        def quantile(u):
            z = mp.mpf(float(self.start.ppf(u)))
            for _ in range(8):
                z -= (self.between(self.a, z) - mp.mpf(u) * self.mass) / mp.npdf(z)
            return self.mean0 + self.sd0 * z

        return [quantile(u) for u in us]

    def moment(self, power, centre):
        points = sorted({self.a, self.b, *(p for p in map(mp.mpf, range(-30, 31)) if self.a < p < self.b)})
        # Divided inside, since the quadrature stops at an absolute error.
        return mp.quad(lambda z: (z - centre) ** power * mp.npdf(z) / self.mass, points)

    def mean(self):
        return self.mean0 + self.sd0 * self.moment(1, 0)

    def std(self):
        return self.sd0 * mp.sqrt(self.moment(2, self.moment(1, 0)))


class Weibull:
    """Moments to 50 digits, quantiles by scipy."""

    def __init__(self, shape, scale, location):
        self.frozen = stats.weibull_min(shape, location, scale)
        self.ppf = self.frozen.ppf
        self.power, self.scale, self.location = 1 / mp.mpf(shape), mp.mpf(scale), mp.mpf(location)

    def mean(self):
        return self.location + self.scale * mp.gamma(1 + self.power)

    def std(self):
        return self.scale * mp.sqrt(mp.gamma(1 + 2 * self.power) - mp.gamma(1 + self.power) ** 2)


class TruncatedGumbel:
    """Exact to 50 digits."""

    def __init__(self, location, scale, low, high):
        self.location, self.scale = mp.mpf(location), mp.mpf(scale)
        self.a, self.b = ((mp.mpf(x) - self.location) / self.scale for x in (low, high))
        self.below, self.mass = self.cdf(self.a), self.cdf(self.b) - self.cdf(self.a)

    @staticmethod
    def cdf(z):
        return mp.exp(-mp.exp(-z))

    def ppf(self, us):
        return [self.location - self.scale * mp.log(-mp.log(self.below + mp.mpf(u) * self.mass)) for u in us]

    def moment(self, power, centre):
        points = sorted({self.a, self.b, *(p for p in map(mp.mpf, range(-10, 120)) if self.a < p < self.b)})
        return mp.quad(lambda z: (z - centre) ** power * mp.exp(-z - mp.exp(-z)) / self.mass, points)

    def mean(self):
        return self.location + self.scale * self.moment(1, 0)

    def std(self):
        return self.scale * mp.sqrt(self.moment(2, self.moment(1, 0)))


class Exact:
    """By its distribution function from below and from above, to 50 digits; `start` is a frozen distribution of SciPy."""

    def __init__(self, below, above, start, mean=None, std=None, kinks=()):
        self.below, self.above, self.start = below, above, start
        self.exact_mean, self.exact_std, self.kinks = mean, std, kinks

    def quantile(self, u):
        u = mp.mpf(u)
        low, high = map(mp.mpf, self.start)

        def miss(x):
            """In logarithms of the smaller probability."""
            if u > 0.5:
                above = self.above(x)
                return -mp.log(above / (1 - u)) if above > 0 else mp.mpf(2000)
            below = self.below(x)
            return mp.log(below / u) if below > 0 else mp.mpf(-2000)

        # Regula falsi in its Illinois form, with halvings by magnitude where it is slow.
        before, after, slow, moved = miss(low), miss(high), 0, 0
        if before >= 0 or after <= 0:
            return low if before >= 0 else high
        while high - low > mp.mpf(10) ** -19 * max(abs(low), abs(high)):
            width = high - low
            x = low + width * before / (before - after)
            by_secant = slow < 2 and low < x < high
            if not by_secant:
                x = mp.sqrt(low * high) if low > 0 else (low + high) / 2 if low > -1 or high < 1 else mp.mpf(0)
                x = -mp.sqrt(low * high) if high < 0 else x
            here = miss(x)
            if abs(here) < mp.mpf(10) ** -20:
                return x
            if here < 0:
                after *= mp.mpf("0.5") if moved == -1 else 1
                low, before, moved = x, here, -1
            else:
                before *= mp.mpf("0.5") if moved == 1 else 1
                high, after, moved = x, here, 1
            slow = slow + 1 if high - low > width / 2 and slow < 2 else 0
            moved = moved if by_secant else 0
        return (low + high) / 2

    def ppf(self, us):
        return [self.quantile(u) for u in us]

    def mean(self):
        return self.exact_mean

    def std(self):
        return self.exact_std


class Counts:
    """Of SciPy, from above where its distribution function rounds to 1."""

    def __init__(self, law):
        self.law = law
        self.mean, self.std = self.law.mean, self.law.std

    def ppf(self, us):
        return [self.law.ppf(u) if u < 0.5 else self.from_above(1 - u) for u in us]

    def from_above(self, v):
        k = max(int(self.law.support()[0]), int(self.law.isf(v)) - 5)
        while self.law.sf(k) >= v:
            k += 1
        return k


def t_tails(df):
    def tail(z):
        if z * z < df:
            constant = mp.gamma((df + 1) / 2) / mp.gamma(df / 2) / mp.sqrt(mp.pi * df)
            return mp.mpf("0.5") - abs(z) * constant * mp.hyp2f1(0.5, (df + 1) / 2, 1.5, -z * z / df)
        return mp.betainc(df / mp.mpf(2), mp.mpf("0.5"), 0, df / (df + z * z), regularized=True) / 2

    return lambda z: tail(z) if z < 0 else 1 - tail(z), lambda z: tail(z) if z > 0 else 1 - tail(z)


def gamma_tails(shape):
    return (
        lambda x: mp.gammainc(shape, 0, x, regularized=True),
        lambda x: mp.gammainc(shape, x, mp.inf, regularized=True),
    )


def moved(tails, location, scale):
    below, above = tails
    return lambda x: below((x - location) / scale), lambda x: above((x - location) / scale)


def truncated(tails, low, high, density):
    """Tails, mean and standard deviation of what is left between the bounds; moments by quadrature of the density."""
    below, above = tails
    b0 = below(mp.mpf(low)) if mp.isfinite(low) else mp.mpf(0)
    a1 = above(mp.mpf(high)) if mp.isfinite(high) else mp.mpf(0)
    mass = 1 - b0 - a1

    def integral(of, centre):
        points = [mp.mpf(p) for p in (low, centre, high)]
        return mp.quad(lambda x: of(x) * density(x), points) / mass

    def moments(centre):
        mean = integral(lambda x: x, centre)
        return mean, mp.sqrt(integral(lambda x: (x - mean) ** 2, centre))

    return (lambda x: (below(x) - b0) / mass, lambda x: (above(x) - a1) / mass), moments


def gamma_density(shape):
    return lambda x: mp.exp((shape - 1) * mp.log(x) - x - mp.loggamma(shape))


def log_normal_tails(m, s):
    return (lambda x: mp.ncdf((mp.log(x) - m) / s), lambda x: mp.ncdf(-(mp.log(x) - m) / s))


def pareto_tails(shape, least):
    return (lambda x: 1 - (least / x) ** mp.mpf(shape), lambda x: (least / x) ** mp.mpf(shape))


def t_density(df):
    constant = mp.gamma((df + 1) / mp.mpf(2)) / mp.gamma(df / mp.mpf(2)) / mp.sqrt(df * mp.pi)
    return lambda z: constant * (1 + z * z / mp.mpf(df)) ** (-(df + 1) / mp.mpf(2))


class Histogram:
    """Piecewise linear, exact to 50 digits from the nearer end; SciPy's rv_histogram has the same to some 1e-15 of the range."""

    def __init__(self, edges, weights):
        self.edges, total = [mp.mpf(edge) for edge in edges], mp.fsum(weights)
        self.shares = [mp.mpf(weight) / total for weight in weights]
        self.scipy = stats.rv_histogram((np.asarray(weights), np.asarray(edges)), density=False)

    def quantile(self, u):
        u, before = mp.mpf(u), mp.mpf(0)
        for low, high, share in zip(self.edges, self.edges[1:], self.shares):
            # At the end of a bin the value is that of the next one that is not empty.
            if u < before + share:
                return low + (high - low) * (u - before) / share
            before += share

    def ppf(self, us):
        exact = [self.quantile(u) for u in us]
        span = float(self.edges[-1] - self.edges[0])
        assert all(abs(float(x) - y) < 1e-14 * span for x, y in zip(exact[2:-2], self.scipy.ppf(us[2:-2])))
        return exact

    def moment(self, power, centre):
        def of_bin(low, high, share):
            return share * ((high - centre) ** (power + 1) - (low - centre) ** (power + 1)) / ((power + 1) * (high - low))

        return mp.fsum(of_bin(*bin) for bin in zip(self.edges, self.edges[1:], self.shares))

    def mean(self):
        return self.moment(1, 0)

    def std(self):
        return mp.sqrt(self.moment(2, self.mean()))


def truncated_cases():
    """Truncations of the families that are not solved for, by closed forms of their distribution functions."""
    inf = mp.inf
    logistic = (lambda x: 1 / (1 + mp.exp(-x)), lambda x: 1 / (1 + mp.exp(x)))
    exponential = (lambda x: -mp.expm1(-x), lambda x: mp.exp(-x))
    weibull = (lambda x: -mp.expm1(-(x ** mp.mpf("1.5"))), lambda x: mp.exp(-(x ** mp.mpf("1.5"))))
    beta = (
        lambda x: mp.betainc(2, 5, 0, x, regularized=True),
        lambda x: mp.betainc(2, 5, x, 1, regularized=True),
    )
    ramp = (lambda x: (x / 2) ** 2, lambda x: (1 - x / 2) * (1 + x / 2))
    for name, keys, tails, density, (low, high), ends, middle in [
        ("logistic", dict(location=0, scale=1), logistic, lambda x: mp.exp(-abs(x)) / (1 + mp.exp(-abs(x))) ** 2, (-1, 6), (-1, 6), 1),
        ("exponential", dict(scale=1, location=0), exponential, lambda x: mp.exp(-x), (0.25, 3), (0.25, 3), 1),
        ("weibull", dict(shape=1.5, scale=1, location=0), weibull, lambda x: mp.mpf("1.5") * mp.sqrt(x) * mp.exp(-(x ** mp.mpf("1.5"))), (0.5, 2), (0.5, 2), 1),
        ("beta", dict(alpha=2, beta=5, min=0, max=1), beta, lambda x: 30 * x * (1 - x) ** 4, (0.25, 0.75), (0.25, 0.75), 0.4),
        ("triangular", dict(min=0, mode=2, max=2), ramp, lambda x: x / 2, (0.5, 1.5), (0.5, 1.5), 1),
    ]:
        tails, moments = truncated(tails, low, high, density)
        yield name, dict(keys, truncate=[low, high]), Exact(*tails, ends, *moments(middle))


def exact_cases():
    """(family, parameters, exact distribution) of the families that are solved for, and of truncations."""
    for a, s, x in [(0.01, 1, 0), (0.3, 2, 0), (1, 3, 1), (2.5, 1e-9, 0), (30, 1, -5), (1000, 0.5, 0)]:
        tails = moved(gamma_tails(mp.mpf(a)), mp.mpf(x), mp.mpf(s))
        ends = (x + s * mp.mpf(10) ** (-330 / a if a < 1 else -330), x + s * (a + 60 * mp.sqrt(a) + 800))
        yield "gamma", dict(shape=a, scale=s, location=x), Exact(*tails, ends, x + mp.mpf(a) * s, s * mp.sqrt(a))
    for df, m, s in [(2.5, 0, 1), (3, 1, 2), (7, -1e-6, 1e-6), (50, 0, 1)]:
        tails = moved(t_tails(mp.mpf(df)), mp.mpf(m), mp.mpf(s))
        end = 100 * s * mp.mpf(10) ** (330 / df)
        std = s * mp.sqrt(mp.mpf(df) / (mp.mpf(df) - 2))
        yield "student-t", dict(df=df, location=m, scale=s), Exact(*tails, (m - end, m + end), m, std)
    inf = mp.inf
    for low, high in [(0.5, 2), (0, 0.1), (8, inf), (40, 41), (1e-3, inf)]:
        tails, moments = truncated(gamma_tails(mp.mpf(2)), low, high, gamma_density(2))
        mean, std = moments(low + 1 if high == inf else (low + high) / 2)
        ends = (low + mp.mpf(10) ** -330, 900 if high == inf else high)
        yield "gamma", dict(shape=2, scale=1, location=0, truncate=[low, high]), Exact(*tails, ends, mean, std)
    for df, low, high in [(1, -5, 20), (4, 3, inf), (3, -inf, 0.5)]:
        tails, moments = truncated(t_tails(mp.mpf(df)), low, high, t_density(df))
        mean, std = moments(0 if low < 0 < high else 5)
        ends = (max(low, -mp.mpf(10) ** 110), min(high, mp.mpf(10) ** 90))
        yield "student-t", dict(df=df, location=0, scale=1, truncate=[low, high]), Exact(*tails, ends, mean, std)
    for m, s, low, high in [(0, 1, 0.5, 4), (1, 0.25, 0.1, 3)]:
        density = lambda x, m=m, s=s: mp.npdf((mp.log(x) - m) / s) / (x * s)
        tails, moments = truncated(log_normal_tails(mp.mpf(m), mp.mpf(s)), low, high, density)
        yield "log-normal", dict(log_mean=m, log_sd=s, truncate=[low, high]), Exact(*tails, (low, high), *moments(1.5))
    tails, moments = truncated(pareto_tails(0.8, 2), 2, 1000, lambda x: mp.mpf("0.8") / x * (2 / x) ** mp.mpf("0.8"))
    yield "pareto", dict(shape=0.8, min=2, truncate=[-inf, 1000]), Exact(*tails, (2, 1000), *moments(30))


CASES = [
    ("uniform", dict(min=a, max=b), stats.uniform(a, b - a)) for a, b in [(0, 1), (-3, 5), (2e-6, 2.5e-6)]
] + [
    ("log-uniform", dict(min=a, max=b), stats.loguniform(a, b)) for a, b in [(1, 10), (1e-9, 1e-6), (1e-3, 1e12)]
] + [
    ("normal", dict(mean=m, sd=s), stats.norm(m, s)) for m, s in [(0, 1), (2e9, 1e8), (-5e-6, 1e-6)]
] + [
    ("truncated-normal", dict(mean=m, sd=s, min=a, max=b), TruncatedNormal(m, s, a, b))
    for m, s, a, b in [
        (0, 1, -2, 2),
        (0, 1, -0.1, 0.3),
        (0, 1, 8, 9),
        (0, 1, -30, -20),
        (0, 1, 1, 2),
        (0, 1, 0.2, 40),
        (0, 1, -12, -0.25),
        (70, 10, 60, 100),
        (3, 0.5, 0, 10),
        (0, 1e6, 0.1, 0.2),
        (-7, 2, 60, 61),
    ]
] + [
    ("log-normal", dict(mean=m, sd=s), log_normal(m, s)) for m, s in [(5, 1), (1e-9, 3e-9), (100, 10)]
] + [
    ("log-normal", dict(log_mean=m, log_sd=s), stats.lognorm(s, scale=np.exp(m))) for m, s in [(0, 1), (-20, 0.3)]
] + [
    ("triangular", dict(min=a, mode=m, max=b), stats.triang((m - a) / (b - a), a, b - a))
    for a, m, b in [(0, 1, 4), (-1, -1, 1), (2, 5, 5), (1e9, 1.5e9, 3e9)]
] + [
    ("pert", dict(min=a, mode=m, max=b), stats.beta(1 + 4 * (m - a) / (b - a), 1 + 4 * (b - m) / (b - a), a, b - a))
    for a, m, b in [(0, 1, 8), (-1, -1, 1), (5, 7, 9)]
] + [
    ("beta", dict(alpha=p, beta=q, min=a, max=b), stats.beta(p, q, a, b - a))
    for p, q, a, b in [
        (2, 5, 0, 1),
        (0.5, 0.5, 0, 1),
        (1, 1, -1, 3),
        (1, 3, 0, 1),
        (10, 1, 0, 1),
        (0.1, 0.2, 0, 1),
        (0.01, 50, 0, 1),
        (3, 0.2, 0, 1),
        (100, 30, 5, 6),
        (1000, 1000, 0, 1),
        (5000, 3, 0, 1),
        (1e5, 1e5, 0, 1),
        (1e5, 0.01, 0, 1),
        (300, 0.002, 0, 1),
        (0.06, 0.0012, 0, 1),
    ]
] + [
    ("weibull", dict(shape=k, scale=s, location=x), Weibull(k, s, x))
    for k, s, x in [(1, 2, 0), (0.5, 1, 0), (2, 3e-9, 0), (20, 1, 5), (1000, 1, 0)]
] + [
    ("gumbel", dict(location=m, scale=s), stats.gumbel_r(m, s)) for m, s in [(0, 1), (1013, 558)]
] + [
    ("truncated-gumbel", dict(location=m, scale=s, min=a, max=b), TruncatedGumbel(m, s, a, b))
    for m, s, a, b in [
        (1013, 558, 500, 3000),
        (0, 1, -2, 2),
        (0, 1, 30, 31),
        (0, 1, -5, -3),
        (0, 1, -40, 100),
        (5, 2, 4, 4.001),
        (3, 0.5, 0, 10),
    ]
] + [
    ("exponential", dict(scale=s, location=x), stats.expon(x, s)) for s, x in [(1, 0), (3e-9, 0), (2, -5)]
] + [
    ("logistic", dict(location=m, scale=s), stats.logistic(m, s)) for m, s in [(0, 1), (1e3, 5)]
] + [
    ("pareto", dict(shape=b, min=s), stats.pareto(b, scale=s)) for b, s in [(2.5, 1), (3, 1e-6), (40, 7)]
] + [
    ("poisson", dict(mean=m), Counts(stats.poisson(m))) for m in [1e-3, 0.7, 4, 36.5, 1000, 250000]
] + [
    ("binomial", dict(n=n, p=p), Counts(stats.binom(n, p))) for n, p in [(1, 0.3), (10, 0.25), (1000, 0.9), (1e6, 2e-6)]
] + [
    ("negative-binomial", dict(n=n, p=p), Counts(stats.nbinom(n, p)))
    for n, p in [(1, 0.5), (2.5, 0.25), (0.1, 0.01), (400, 0.75)]
] + [
    ("geometric", dict(p=p), Counts(stats.geom(p))) for p in [0.002, 0.25, 0.75]
] + [
    ("histogram", dict(edges=edges, weights=weights), Histogram(edges, weights))
    for edges, weights in [
        ([0, 1, 3], [1, 3]),
        ([-4, -1, 0.5, 2, 7], [0, 2, 0, 5]),
        ([1e-9, 2e-9, 5e-9], [1, 1e-6]),
        ([1000, 1000.5, 1002, 1010], [3, 3, 1]),
    ]
] + list(exact_cases()) + list(truncated_cases())

# Far out in the lower tail, of the families that are solved for here.
FAR = [1e-290, 1e-100]


def numbers(value):
    if isinstance(value, (list, tuple)):
        return [numbers(inner) for inner in value]
    if isinstance(value, dict):
        return {key: numbers(inner) for key, inner in value.items()}
    if isinstance(value, str):
        return value
    value = float(value)
    return value if np.isfinite(value) else "inf" if value > 0 else "-inf"


def us(frozen):
    return FAR + U if isinstance(frozen, Exact) else U


cases = [
    dict(
        distribution=name,
        parameters=numbers(parameters),
        u=us(frozen),
        quantile=[float(x) for x in frozen.ppf(us(frozen))],
        mean=float(frozen.mean()),
        sd=float(frozen.std()),
    )
    for name, parameters, frozen in CASES
]
target = pathlib.Path(__file__).with_suffix(".json")
target.write_text("[\n" + ",\n".join(json.dumps(case) for case in cases) + "\n]\n")
