"""First-order indices from the spectrum of the outputs in the order of each input (Tarantola et al. 2006, Plischke 2010)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._checks import whole
from ..._engine import StudyError
from ..._tables import numbers
from .._problem import Seed, generator
from ..util import ResultDict, confidence


def analyze(
    problem: Mapping[str, Any],
    X: Any,
    Y: Any,
    M: int = 10,
    num_resamples: int = 100,
    conf_level: float = 0.95,
    print_to_console: bool = False,
    seed: Seed = None,
) -> ResultDict:
    """S1 and S1_conf, lists of a number a factor, and their names, from outputs `Y`, (rows,), at independent points `X`,
    (rows, factors), by the first `M` harmonics, without the expected noise (Tissot and Prieur 2012).

    S1_conf are from resamples of half of the rows. A `StudyError` says that there are too few rows, or that their numbers differ.
    """
    M, num_resamples = whole("M", M, 1, 2**16), whole("num_resamples", num_resamples, 0, 10**6)
    z, rng = confidence(conf_level), generator(seed)
    x, y = numbers(X, "the points are"), numbers(Y, "the outputs are").ravel()
    half = len(y) // 2
    if x.shape != (len(y), len(problem["names"])) or half <= 2 * M:
        expected = f"expected (rows, {len(problem['names'])}) and (rows,), more than {4 * M + 1} rows"
        raise StudyError(f"points of shape {x.shape} and {len(y)} outputs: {expected}")
    first, conf = [], []
    for column in x.T:
        order = np.argsort(column)
        first.append(_index(y[order], M))
        # In the order of the input without sorting it again: rows as often as they are drawn.
        drawn = (np.bincount(rng.choice(len(y), half), minlength=len(y))[order] for _ in range(num_resamples))
        resamples = [_index(y[np.repeat(order, counts)], M) for counts in drawn]
        conf.append(z * np.std(resamples, ddof=1) if num_resamples > 1 else np.nan)
    found = ResultDict(S1=first, S1_conf=conf, names=list(problem["names"]))
    if print_to_console:
        print(found.to_df())
    return found


def _index(y: np.ndarray, harmonics: int) -> float:
    """The index from outputs in the order of the input."""
    wave = np.concatenate([y[::2], y[1::2][::-1]])
    wave -= wave.mean()
    power = np.abs(np.fft.rfft(wave)[1 : harmonics + 1]) ** 2
    # By Parseval's theorem the sum over all frequencies.
    share = 2 * power.sum() / (len(wave) * np.square(wave).sum())
    noise = 2 * harmonics / len(wave)
    return float(share - noise / (1 - noise) * (1 - share))
