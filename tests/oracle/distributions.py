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
]

cases = [
    dict(
        distribution=name,
        parameters={key: float(value) for key, value in parameters.items()},
        u=U,
        quantile=[float(x) for x in frozen.ppf(U)],
        mean=float(frozen.mean()),
        sd=float(frozen.std()),
    )
    for name, parameters, frozen in CASES
]
target = pathlib.Path(__file__).with_suffix(".json")
target.write_text("[\n" + ",\n".join(json.dumps(case) for case in cases) + "\n]\n")
