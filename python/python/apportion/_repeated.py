"""Stochastic functions that are called several times for each row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ._answers import expanded
from ._checks import whole
from ._functions import Call

_MOST = 1000
_PARTS = ("mean", "variance")


def taken_out(noise: Mapping[str, Any]) -> tuple[dict[str, Any], int]:
    """The table without its repetitions, and how many there are."""
    table = dict(noise)
    return table, whole("repetitions", table.pop("repetitions", 1), 1, _MOST)


def outputs_of(outputs: Any) -> Any:
    """The mean and the variance over the noise instead of every output: names, or names with their units and axes."""
    if isinstance(outputs, Mapping):
        return {f"{name}_{part}": _of(stated, part) for name, stated in outputs.items() for part in _PARTS}
    return None if outputs is None else [f"{name}_{part}" for name in outputs for part in _PARTS]


def _of(stated: Any, part: str) -> Any:
    if part == "mean":
        return stated
    if isinstance(stated, Mapping):
        return {**stated, "unit": _square(stated["unit"])} if "unit" in stated else stated
    return _square(stated)


def _square(unit: str) -> str:
    """A unit of variances; one that is no symbol by itself is a label."""
    if unit in ("", "1"):
        return unit
    return f"{unit}^2" if unit.isalpha() and unit not in ("degC", "degF") else f"({unit})^2"


class RepeatedCall:
    """A stochastic function whose values for a row are mean and variance (with the divisor n - 1) over `repetitions` calls, each
    with another seed: the same seeds as those of the engine's models."""

    def __init__(self, call: Call, seed: int, repetitions: int):
        self.call = call
        self.seed = seed
        self.repetitions = repetitions

    @property
    def function(self) -> Callable[..., Any]:
        return self.call.function

    @property
    def names(self) -> list[str]:
        return self.call.names

    @property
    def vectorised(self) -> bool:
        return self.call.vectorised

    @property
    def outputs(self) -> list[str] | None:
        return outputs_of(self.call.outputs)

    @property
    def lengths(self) -> dict[str, int | None]:
        return {f"{name}_{part}": length for name, length in self.call.lengths.items() for part in _PARTS}

    @property
    def columns(self) -> list[str]:
        """Names of all values, as those of `Call`."""
        return expanded(self.outputs or [], self.lengths)

    def rows(self, x: np.ndarray) -> np.ndarray:
        """The values that the function gets at the first of its calls for the rows `x`."""
        return self.call.rows(x)

    def probe(self, rows: np.ndarray) -> np.ndarray:
        """The outputs of `rows`, which must answer and show the names of the outputs."""
        self.call.probe(rows)
        values, failures = self.evaluate(rows)
        if failures:
            raise RuntimeError(failures[0][1])
        return values

    def evaluate(self, rows: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        """Outputs of `rows`, and (row, reason) of rows that failed: those without one of their repetitions."""
        calls = np.tile(rows, (self.repetitions, 1))
        numbers = np.repeat(np.arange(self.repetitions, dtype=np.uint64), len(rows))
        calls[:, self.seed] = _seeds(calls[:, self.seed], numbers)
        values, failed = self.call.evaluate(calls)
        values = values.reshape(self.repetitions, len(rows), -1)
        mean, squares = np.zeros(values.shape[1:]), np.zeros(values.shape[1:])
        # One by one (Welford 1962, Technometrics 4, 419-420), so that large values lose no digits.
        for number, value in enumerate(values):
            off = value - mean
            mean += off / (number + 1)
            squares += off * (value - mean)
        parts = {"mean": mean, "variance": squares / (self.repetitions - 1)}
        places = {name: place for place, name in enumerate(self.call.columns)}
        own = [
            parts[part][:, [places[column] for column in expanded([name], self.call.lengths)]]
            for name in self.call.outputs or []
            for part in _PARTS
        ]
        first: dict[int, str] = {}
        for place, reason in failed:
            first.setdefault(place % len(rows), reason)
        return np.column_stack(own), sorted(first.items())

    def identity(self, version: str | None) -> str:
        """Identifies this function and the number of calls."""
        return f"{self.call.identity(version)} {self.repetitions} times"


def _seeds(seeds: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """The seed of each repetition of a row with its seed: of the first the row's own, then mixed numbers (the finaliser of SplitMix64:
    Steele, Lea and Flood 2014)."""
    z: np.ndarray = seeds.astype(np.uint64) + numbers * np.uint64(0x9E37_79B9_7F4A_7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58_476D_1CE4_E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D0_49BB_1331_11EB)
    z ^= z >> np.uint64(31)
    return np.where(numbers == 0, seeds, (z >> np.uint64(33)).astype(float))
