"""How factors vary: the distributions of study files, and those of SciPy."""

from __future__ import annotations

import inspect
import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _engine
from ._engine import StudyError

_LEAST, _MOST = 2.0**-54, 1.0 - 2.0**-53  # nearest numbers to 0 and 1 at which a quantile function is asked


class Factor:
    """An input of the model: its distribution and its unit.

    Made by `Uniform`, `Normal` and the others. `keys` are those of a factor in a study file.
    """

    def __init__(self, keys: Mapping[str, Any], quantile: Callable[[np.ndarray], np.ndarray] | None = None):
        self.keys = {key: value for key, value in keys.items() if value is not None}
        self.quantile = quantile

    def __repr__(self) -> str:
        return f"Factor({', '.join(f'{key}={value!r}' for key, value in self.keys.items())})"

    def truncated(self, min: float = -math.inf, max: float = math.inf) -> "Factor":
        """The same distribution, truncated to values between `min` and `max`; parameters are those before truncation."""
        if self.quantile is not None or "truncate" in self.keys:
            raise StudyError(f"{self!r} cannot be truncated: it is {'known by its quantiles' if self.quantile else 'truncated'}")
        return Factor({**self.keys, "truncate": [float(min), float(max)]})

    @classmethod
    def of(cls, value: Any) -> "Factor":
        """A factor from a factor, a mapping of keys, a pair (min, max), a distribution of SciPy, or a number, which is a constant."""
        if isinstance(value, Factor):
            return value
        if isinstance(value, Mapping):
            return cls(value)
        if hasattr(value, "ppf") or hasattr(value, "icdf"):
            return from_scipy(value)
        if isinstance(value, numbers.Real) and not isinstance(value, bool):
            return cls({"distribution": "constant", "value": float(value)})
        if isinstance(value, (tuple, list, np.ndarray)) and np.shape(value) == (2,):
            return Uniform(*value)
        raise StudyError(f"{value!r} is not a factor: expected a distribution such as ap.Normal(0, 1), or a pair (min, max)")


def _plain(values: Sequence[float] | np.ndarray | None) -> list | None:
    return None if values is None else np.asarray(values).tolist()


# Keywords that a factor of a family does not take: what has labels has no unit, and a constant does not vary.
_WITHOUT = {"boolean": {"unit"}, "categorical": {"unit"}, "seed": {"unit", "group"}, "constant": {"group", "nominal"}}
# What the engine's description of a family leaves out.
_REMARKS = {
    "gamma": "Its mean is `location + shape * scale`.",
    "exponential": "`scale` is the standard deviation, one over the rate.",
    "student-t": "More than 2 degrees of freedom, unless it is truncated on both sides.",
    "pareto": "`shape` is above 2, unless it is truncated above.",
    "seed": "A whole number from 0 to 2**31 - 1: the noise, which is not one of the factors.",
}
_READ: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "number": ("float", lambda value: value),
    "numbers": ("Sequence[float]", _plain),
    "texts": ("Sequence[str]", list),
}


def _constructor(family: str, summary: str, parameters: Sequence[tuple[str, str, str, bool, float | None]]) -> Callable[..., Factor]:
    """The constructor of a factor of a family of the engine; for each parameter the table has the key, the kind of value,
    the description, whether it is optional, and the default."""
    kinds = inspect.Parameter
    arguments, reads = [], {}
    for key, kind, _, is_optional, default in parameters:
        annotation, reads[key] = _READ[kind]
        if is_optional and default is None:
            annotation += " | None"
        default = default if is_optional else kinds.empty
        arguments.append(kinds(key, kinds.POSITIONAL_OR_KEYWORD, default=default, annotation=annotation))
    common = {"unit": "str | None", "group": "str | None", "nominal": "Any"}
    for key in common.keys() - _WITHOUT.get(family, set()):
        arguments.append(kinds(key, kinds.KEYWORD_ONLY, default=None, annotation=common[key]))
    order = [*reads, *common]
    signature = inspect.Signature(sorted(arguments, key=lambda argument: order.index(argument.name)), return_annotation="Factor")

    def made(*positional: Any, **named: Any) -> Factor:
        bound = signature.bind(*positional, **named)
        bound.apply_defaults()
        keys = {key: value if value is None or key not in reads else reads[key](value) for key, value in bound.arguments.items()}
        return Factor({"distribution": family, **keys})

    made.__name__ = made.__qualname__ = _name_of(family)
    made.__signature__ = signature  # type: ignore[attr-defined]
    described = [f"{key}: {description}" for key, _, description, _, _ in parameters]
    made.__doc__ = "\n".join([" ".join([summary, _REMARKS.get(family, "")]).strip(), *([""] if described else []), *described])
    return made


def _name_of(family: str) -> str:
    return "".join(word.capitalize() for word in family.split("-"))


# Those of the engine, each by its table; some that take more than keys follow.
_FAMILIES = {_name_of(family): _constructor(family, *rest) for family, *rest in _engine.distributions()}
globals().update(_FAMILIES)
__all__ = ["Factor", "from_scipy", *_FAMILIES]


def LogNormal(
    mean: float | None = None,
    sd: float | None = None,
    *,
    log_mean: float | None = None,
    log_sd: float | None = None,
    median: float | None = None,
    gsd: float | None = None,
    unit: str | None = None,
    group: str | None = None,
    nominal: Any = None,
) -> Factor:
    """Log-normal: by mean and standard deviation of the factor, by those of its natural logarithm, or by median and geometric
    standard deviation."""
    keys = {"mean": mean, "sd": sd, "log_mean": log_mean, "log_sd": log_sd, "median": median, "gsd": gsd}
    return Factor({"distribution": "log-normal", **keys, "unit": unit, "group": group, "nominal": nominal})


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
    return Factor({"distribution": "histogram", **keys, "unit": unit, "group": group, "nominal": nominal})


def from_scipy(distribution: Any, *, group: str | None = None) -> Factor:
    """A distribution of `scipy.stats`, frozen as `stats.gamma(2)` or an object as `stats.Normal(mu=1)`, as a factor.

    Where the engine has the same one it becomes that: uniform, norm, loguniform, lognorm, triang, beta, weibull_min, gumbel_r,
    gamma, expon, logistic, t (more than 2 degrees of freedom), pareto (of a shape above 2), truncnorm, poisson and
    randint, moved and stretched where that stays of the family; one of up to 1024 whole numbers, or of values with probabilities,
    becomes `Discrete`; the objects `Normal`, `Uniform` and discrete ones are converted likewise. Any other one becomes a number u between 0 and 1 to
    the engine, and the function gets its quantile of u: so it serves functions of Python, and no models of the engine. A `StudyError`
    is raised for other objects and for arrays of distributions.
    """
    name = getattr(getattr(distribution, "dist", None), "name", None)
    if not hasattr(distribution, "icdf") and (not hasattr(distribution, "ppf") or name is None):
        raise StudyError(f"{distribution!r} is not a distribution of scipy.stats, such as stats.gamma(2) or stats.Normal(mu=1)")
    quantile = _Quantile(distribution)
    if quantile(np.array(0.5)).ndim or not np.isfinite(quantile(np.array(0.5))):
        raise StudyError(f"{distribution!r} is not one distribution: its parameters must be single numbers")
    same = _of_object(distribution) if name is None else _of_engine(name, distribution)
    same = same or _of_values(distribution, quantile)
    if same is not None:
        return Factor({**same.keys, "group": group})
    return Factor({"distribution": "uniform", "min": 0.0, "max": 1.0, "group": group}, quantile)


def _of_object(distribution: Any) -> Factor | None:
    """The engine's own distribution that an object of SciPy 1.15 or newer is, if there is one."""
    kind = type(distribution).__name__ if type(distribution).__module__.startswith("scipy.") else None
    if kind in ("Normal", "StandardNormal"):
        return Normal(float(distribution.mean()), float(distribution.standard_deviation()))
    if kind == "Uniform":
        return Uniform(*(float(end) for end in distribution.support()))
    return None


def _of_engine(name: str, frozen: Any) -> Factor | None:
    """The engine's distribution that equals the frozen one, if there is one."""
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
    if name == "truncnorm":
        return Normal(loc, s).truncated(loc + a[0] * s, loc + a[1] * s)
    if name == "poisson" and at_zero:
        return Poisson(a[0])
    if name == "randint":
        return Integer(int(a[0] + loc), int(a[1] + loc) - 1)
    return None


def _of_values(distribution: Any, quantile: _Quantile) -> Factor | None:
    """The values of a discrete distribution with their probabilities, if there are not too many."""
    dist = getattr(distribution, "dist", None)
    is_object = any(of.__name__ == "DiscreteDistribution" for of in type(distribution).__mro__)
    if not is_object and not hasattr(dist, "pmf"):
        return None
    values = getattr(dist, "xk", None)
    if values is None:
        low, high = quantile(np.array([1e-13, 1.0 - 1e-13]))
        if not high - low < 1024.0:
            return None
        values = np.arange(low, high + 1.0)
    else:
        values = np.asarray(values, dtype=float) + distribution.support()[0] - np.min(values)
    weights = np.asarray(distribution.pmf(values), dtype=float)
    occurring = weights > 0.0
    if not occurring.any():
        return None
    return Discrete(values[occurring], weights[occurring])


class _Quantile:
    """A quantile function; a class, so that it can be sent to other processes."""

    def __init__(self, distribution: Any):
        self.distribution = distribution

    def identity(self) -> tuple[Any, ...]:
        """Its identity in journals: its parameters, the data of a histogram, the functions of a user's class."""
        if not hasattr(self.distribution, "dist"):
            return type(self.distribution).__module__, type(self.distribution).__qualname__, repr(self.distribution)
        dist, of = self.distribution.dist, type(self.distribution.dist)
        parameters = {**getattr(dist, "_updated_ctor_param", dict)(), **self.distribution.kwds}
        made = sorted(item for item in parameters.items() if item[0] not in ("seed", "longname", "extradoc"))
        own = () if of.__module__.startswith("scipy.") else [vars(of).get(name) for name in ("_ppf", "_cdf", "_pdf", "_pmf")]
        return of.__module__, of.__qualname__, dist.name, self.distribution.args, *made, *own

    def __call__(self, u: np.ndarray) -> np.ndarray:
        quantile = self.distribution.icdf if hasattr(self.distribution, "icdf") else self.distribution.ppf
        return np.asarray(quantile(np.clip(u, _LEAST, _MOST)), dtype=float)
