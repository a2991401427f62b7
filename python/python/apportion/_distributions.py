"""How factors vary: the distributions of study files, and those of SciPy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ._engine import StudyError

__all__ = [
    "Beta",
    "Boolean",
    "Categorical",
    "Constant",
    "Discrete",
    "Empirical",
    "Exponential",
    "Factor",
    "Gamma",
    "Gumbel",
    "Histogram",
    "Integer",
    "InverseGaussian",
    "LogNormal",
    "LogUniform",
    "Logistic",
    "Mixture",
    "Normal",
    "Pareto",
    "Poisson",
    "Seed",
    "StudentT",
    "Triangular",
    "TruncatedGumbel",
    "TruncatedNormal",
    "Uniform",
    "Weibull",
    "from_scipy",
]

_LEAST, _MOST = 2.0**-54, 1.0 - 2.0**-53  # nearest numbers to 0 and 1 at which a quantile function is asked


class Factor:
    """An input whose influence is asked for: how it varies, and in which unit.

    Made by `Uniform`, `Normal` and the others. `keys` are those of a factor in a study file.
    """

    def __init__(self, keys: Mapping[str, Any], quantile: Callable[[np.ndarray], np.ndarray] | None = None):
        self.keys = {key: value for key, value in keys.items() if value is not None}
        self.quantile = quantile

    def __repr__(self) -> str:
        return f"Factor({', '.join(f'{key}={value!r}' for key, value in self.keys.items())})"

    def truncated(self, min: float = -math.inf, max: float = math.inf) -> "Factor":
        """The same on the condition that it lies between `min` and `max`; parameters are those before that."""
        if self.quantile is not None or "truncate" in self.keys:
            raise StudyError(f"{self!r} cannot be truncated: it is {'known by its quantiles' if self.quantile else 'truncated'}")
        return Factor({**self.keys, "truncate": [float(min), float(max)]})

    @classmethod
    def of(cls, value: Any) -> "Factor":
        """A factor from what stands for one: itself, a mapping of keys, a pair (min, max), a frozen distribution of SciPy."""
        if isinstance(value, Factor):
            return value
        if isinstance(value, Mapping):
            return cls(value)
        if hasattr(value, "ppf"):
            return from_scipy(value)
        if isinstance(value, (tuple, list)) and len(value) == 2:
            return Uniform(*value)
        raise StudyError(f"{value!r} is no factor: expected a distribution such as ap.Normal(0, 1), or a pair (min, max)")


def _factor(distribution: str, keys: dict[str, Any], unit: str | None, group: str | None, nominal: Any) -> Factor:
    return Factor({"distribution": distribution, **keys, "unit": unit, "group": group, "nominal": nominal})


def _plain(values: Sequence[float] | np.ndarray | None) -> list | None:
    return None if values is None else np.asarray(values).tolist()


def Uniform(min: float, max: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """Uniform between `min` and `max`."""
    return _factor("uniform", {"min": min, "max": max}, unit, group, nominal)


def LogUniform(min: float, max: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """Uniform in the logarithm, between `min` and `max` above 0."""
    return _factor("log-uniform", {"min": min, "max": max}, unit, group, nominal)


def Normal(mean: float, sd: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """Normal with standard deviation `sd`."""
    return _factor("normal", {"mean": mean, "sd": sd}, unit, group, nominal)


def TruncatedNormal(
    mean: float, sd: float, min: float, max: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None
) -> Factor:
    """Normal, cut off at `min` and `max`; `mean` and `sd` are those before the cut."""
    return _factor("truncated-normal", {"mean": mean, "sd": sd, "min": min, "max": max}, unit, group, nominal)


def LogNormal(
    mean: float | None = None,
    sd: float | None = None,
    *,
    log_mean: float | None = None,
    log_sd: float | None = None,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Log-normal: by mean and standard deviation of the factor itself, or by those of its natural logarithm."""
    keys = {"mean": mean, "sd": sd, "log_mean": log_mean, "log_sd": log_sd}
    return _factor("log-normal", keys, unit, group, nominal)


def Triangular(
    min: float, mode: float, max: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None
) -> Factor:
    """Triangular with its peak at `mode`."""
    return _factor("triangular", {"min": min, "mode": mode, "max": max}, unit, group, nominal)


def Beta(
    alpha: float,
    beta: float,
    min: float = 0.0,
    max: float = 1.0,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Beta between `min` and `max`."""
    return _factor("beta", {"alpha": alpha, "beta": beta, "min": min, "max": max}, unit, group, nominal)


def Weibull(
    shape: float,
    scale: float,
    location: float = 0.0,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Weibull, beginning at `location`."""
    return _factor("weibull", {"shape": shape, "scale": scale, "location": location}, unit, group, nominal)


def Gumbel(location: float, scale: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """Gumbel, of largest values."""
    return _factor("gumbel", {"location": location, "scale": scale}, unit, group, nominal)


def TruncatedGumbel(
    location: float,
    scale: float,
    min: float,
    max: float,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Gumbel, cut off at `min` and `max`."""
    keys = {"location": location, "scale": scale, "min": min, "max": max}
    return _factor("truncated-gumbel", keys, unit, group, nominal)


def Gamma(
    shape: float,
    scale: float,
    location: float = 0.0,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Gamma, beginning at `location`; its mean is `location + shape * scale`."""
    return _factor("gamma", {"shape": shape, "scale": scale, "location": location}, unit, group, nominal)


def Exponential(
    scale: float, location: float = 0.0, *, unit: str | None = None, group: str | None = None, nominal: Any = None
) -> Factor:
    """Exponential with standard deviation `scale` (one over the rate), beginning at `location`."""
    return _factor("exponential", {"scale": scale, "location": location}, unit, group, nominal)


def Poisson(mean: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """A number of events: 0, 1, 2 and so on, with this mean."""
    return _factor("poisson", {"mean": mean}, unit, group, nominal)


def Seed(*, nominal: Any = None) -> Factor:
    """The seed of a stochastic model, a whole number from 0 to 2**31 - 1: the noise, which is none of the factors."""
    return _factor("seed", {}, None, None, nominal)


def StudentT(
    df: float,
    location: float = 0.0,
    scale: float = 1.0,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Student's t with `df` degrees of freedom, more than 2 unless it is truncated on both sides."""
    return _factor("student-t", {"df": df, "location": location, "scale": scale}, unit, group, nominal)


def Logistic(location: float, scale: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """Logistic with mean `location`."""
    return _factor("logistic", {"location": location, "scale": scale}, unit, group, nominal)


def Pareto(shape: float, min: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """A power law from `min` on, with `shape` above 2 unless it is truncated above."""
    return _factor("pareto", {"shape": shape, "min": min}, unit, group, nominal)


def InverseGaussian(
    mean: float, scale: float, *, unit: str | None = None, group: str | None = None, nominal: Any = None
) -> Factor:
    """Inverse Gaussian (Wald); `scale` is the lambda of textbooks, and the variance is `mean**3 / scale`."""
    return _factor("inverse-gaussian", {"mean": mean, "scale": scale}, unit, group, nominal)


def Histogram(
    weights: Sequence[float] | Mapping[float, float],
    edges: Sequence[float] | None = None,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Bins of constant density: weights and edges as `numpy.histogram` returns them, or a mapping of probabilities from 0 to
    1 to quantiles, as `{0: 1, 0.5: 2, 1: 5}`."""
    if isinstance(weights, Mapping):
        keys: dict[str, Any] = {"quantiles": {repr(float(p)): float(value) for p, value in weights.items()}}
        if edges is not None:
            raise StudyError("a histogram of quantiles has no edges")
    else:
        keys = {"weights": _plain(weights), "edges": _plain(edges)}
    return _factor("histogram", keys, unit, group, nominal)


def Mixture(
    components: Sequence[Any],
    weights: Sequence[float] | None = None,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """One of `components` (whatever stands for a factor), with `weights` (equal by default)."""
    factors = [Factor.of(component) for component in components]
    for factor in factors:
        beside = [key for key in ("unit", "group", "nominal") if key in factor.keys]
        if beside or factor.quantile is not None:
            what = f"has {beside[0]}, which belongs to the mixture" if beside else "is known by its quantiles alone"
            raise StudyError(f"{factor!r} cannot be in a mixture: it {what}")
    keys = {"components": [factor.keys for factor in factors], "weights": _plain(weights)}
    return _factor("mixture", keys, unit, group, nominal)


def Discrete(
    values: Sequence[float],
    weights: Sequence[float] | None = None,
    *,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """One of `values`, with `weights` (equal by default)."""
    return _factor("discrete", {"values": _plain(values), "weights": _plain(weights)}, unit, group, nominal)


def Integer(min: int, max: int, *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """A whole number from `min` to `max`, both included."""
    return _factor("integer", {"min": min, "max": max}, unit, group, nominal)


def Boolean(probability: float = 0.5, *, group: str | None = None, nominal: Any = None) -> Factor:
    """1 with `probability`, else 0."""
    return _factor("boolean", {"probability": probability}, None, group, nominal)


def Categorical(
    labels: Sequence[str],
    weights: Sequence[float] | None = None,
    values: Sequence[float] | None = None,
    *,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """One of `labels`; a function gets its number, or the one of `values`."""
    keys = {"labels": list(labels), "weights": _plain(weights), "values": _plain(values)}
    return _factor("categorical", keys, None, group, nominal)


def Empirical(values: Sequence[float], *, unit: str | None = None, group: str | None = None, nominal: Any = None) -> Factor:
    """As measured: one of `values`, each as probable as any other."""
    return _factor("empirical", {"values": _plain(values)}, unit, group, nominal)


def Constant(value: float, *, unit: str | None = None) -> Factor:
    """Always `value`."""
    return _factor("constant", {"value": value}, unit, None, None)


def from_scipy(distribution: Any, *, group: str | None = None) -> Factor:
    """A frozen distribution of `scipy.stats`, such as `stats.gamma(2)`, as a factor.

    Where the engine has the same one it becomes that: uniform, norm, loguniform, lognorm, triang, beta, weibull_min, gumbel_r,
    gamma, expon, logistic, t (more than 2 degrees of freedom), pareto (of a shape above 2), invgauss, truncnorm, poisson and
    randint, moved and stretched where that stays of the family; one of up to 1024 whole numbers, or of values with probabilities,
    becomes `Discrete`. Any other one becomes a number u between 0 and 1 to the
    engine, and the function gets `distribution.ppf(u)`: so it serves functions of Python, and no models of the engine.
    """
    name = getattr(getattr(distribution, "dist", None), "name", None)
    if not hasattr(distribution, "ppf") or name is None:
        raise StudyError(f"{distribution!r} is no frozen distribution of scipy.stats, as stats.gamma(2) is one")
    same = _of_engine(name, distribution) or _of_values(distribution)
    if same is not None:
        return Factor({**same.keys, "group": group})
    return Factor({"distribution": "uniform", "min": 0.0, "max": 1.0, "group": group}, _Quantile(distribution))


def _of_engine(name: str, frozen: Any) -> Factor | None:
    """The engine's own distribution that is the frozen one, if there is one."""
    try:
        # The shapes by their names, whichever way they were given.
        shapes, location, scale = frozen.dist._parse_args(*frozen.args, **frozen.kwds)
        a = [float(shape) for shape in shapes]
        loc, s = float(location), float(scale)
    except (AttributeError, TypeError, ValueError):
        return None
    at_zero = loc == 0.0
    if name in ("uniform", "norm"):
        return Uniform(loc, loc + s) if name == "uniform" else Normal(loc, s)
    if name in ("loguniform", "reciprocal") and at_zero:
        return LogUniform(a[0] * s, a[1] * s)
    if name == "lognorm" and at_zero:
        return LogNormal(log_mean=math.log(s), log_sd=a[0])
    if name == "triang":
        return Triangular(loc, loc + a[0] * s, loc + s)
    if name == "beta":
        return Beta(a[0], a[1], loc, loc + s)
    if name == "weibull_min":
        return Weibull(a[0], s, loc)
    if name == "gumbel_r":
        return Gumbel(loc, s)
    if name == "gamma":
        return Gamma(a[0], s, loc)
    if name == "expon":
        return Exponential(s, loc)
    if name == "logistic":
        return Logistic(loc, s)
    if name == "t" and a[0] > 2.0:
        return StudentT(a[0], loc, s)
    if name == "pareto" and at_zero and a[0] > 2.0:
        return Pareto(a[0], s)
    if name == "invgauss" and at_zero:
        return InverseGaussian(a[0] * s, s)
    if name == "truncnorm":
        return Normal(loc, s).truncated(loc + a[0] * s, loc + a[1] * s)
    if name == "poisson" and at_zero:
        return Poisson(a[0])
    if name == "randint":
        return Integer(int(a[0] + loc), int(a[1] + loc) - 1)
    return None


def _of_values(frozen: Any) -> Factor | None:
    """The values of a discrete distribution with their probabilities, if they are not many."""
    if not hasattr(frozen.dist, "pmf"):
        return None
    values = getattr(frozen.dist, "xk", None)
    if values is None:
        low, high = frozen.ppf(1e-13), frozen.ppf(1.0 - 1e-13)
        if not high - low < 1024.0:
            return None
        values = np.arange(low, high + 1.0)
    else:
        values = np.asarray(values, dtype=float) + frozen.support()[0] - np.min(values)
    weights = np.asarray(frozen.pmf(values), dtype=float)
    occurring = weights > 0.0
    if not occurring.any():
        return None
    return Discrete(values[occurring], weights[occurring])


class _Quantile:
    """A quantile function; a class, so that it goes to other processes."""

    def __init__(self, distribution: Any):
        self.distribution = distribution

    def identity(self) -> tuple[Any, ...]:
        """What tells it from others in journals: its parameters, the data of a histogram, the functions of a class of one's own."""
        dist, of = self.distribution.dist, type(self.distribution.dist)
        parameters: dict[str, Any] = getattr(dist, "_updated_ctor_param", dict)()
        made = {key: value for key, value in parameters.items() if key not in ("seed", "longname", "extradoc")}
        own = () if of.__module__.startswith("scipy.") else [vars(of).get(name) for name in ("_ppf", "_cdf", "_pdf", "_pmf")]
        return of.__module__, of.__qualname__, dist.name, self.distribution.args, self.distribution.kwds, made, own

    def __call__(self, u: np.ndarray) -> np.ndarray:
        return np.asarray(self.distribution.ppf(np.clip(u, _LEAST, _MOST)), dtype=float)
