"""Elementary effects from outputs along trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._checks import whole
from ..._engine import StudyError
from ..._tables import numbers
from .._problem import Seed, generator, members_of
from ..util import ResultDict, confidence


def analyze(
    problem: Mapping[str, Any],
    X: Any,
    Y: Any,
    num_resamples: int = 100,
    conf_level: float = 0.95,
    scaled: bool = False,
    print_to_console: bool = False,
    num_levels: int = 4,
    seed: Seed = None,
) -> ResultDict:
    """mu, mu_star, sigma and mu_star_conf, (D,), of D factors or groups, and their names, from outputs `Y`, (rows,), at the points
    `X`, (rows, factors), of `sample.morris` with as many `num_levels`, or of SALib's own.

    Effects are per unit of the range of a factor; those that are `scaled` per standard deviation, of input and output. Of groups
    they are means over their factors, and sigma is NaN. A `StudyError` says that the numbers of rows are wrong.
    """
    num_resamples, num_levels = whole("num_resamples", num_resamples, 0, 10**6), whole("num_levels", num_levels, 2, 2**16)
    z, rng = confidence(conf_level), generator(seed)
    members = members_of(problem)
    points, d = len(members) + 1, len(problem["names"])
    x, y = numbers(X, "the points are"), numbers(Y, "the outputs are").ravel()
    if x.shape != (len(y), d) or not len(y) or len(y) % points:
        expected = f"expected (rows, {d}) and (rows,), and a multiple of {points} rows"
        raise StudyError(f"points of shape {x.shape} and {len(y)} outputs: {expected}")
    x, y = x.reshape(-1, points, d), y.reshape((-1, points))
    effects = np.einsum("tsk,ts->kt", np.sign(np.diff(x, axis=1)), np.diff(y, axis=1))
    if scaled:
        spread = y.std(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            effects *= np.where(spread > 0, x.std(axis=1).T / spread, 0.0) / np.ptp(x, axis=1).T
    else:
        effects /= num_levels / (2 * (num_levels - 1))
    sizes = np.ascontiguousarray(np.abs(effects))
    means = [size[rng.integers(len(y), size=(num_resamples, len(y)))].mean(axis=1) for size in sizes]
    conf = z * np.std(means, axis=1, ddof=1) if num_resamples > 1 else np.full(d, np.nan)

    def joint(of: np.ndarray) -> np.ndarray:
        return np.array([of[columns].mean() for columns in members.values()])

    sigma = effects.std(axis=1, ddof=1) if len(y) > 1 else np.full(d, np.nan)
    found = ResultDict(
        names=list(members),
        mu=joint(effects.mean(axis=1)),
        mu_star=joint(sizes.mean(axis=1)),
        sigma=np.array([sigma[columns[0]] if len(columns) == 1 else np.nan for columns in members.values()]),
        mu_star_conf=joint(conf),
    )
    if print_to_console:
        print(found.to_df())
    return found
