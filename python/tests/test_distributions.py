"""The constructors of distributions are those of the engine's table, and their stub is theirs."""

import importlib
import inspect
import os
from pathlib import Path

import apportion as ap
import pytest
from apportion import _engine

# The package has a list of the same name.
_distributions = importlib.import_module("apportion._distributions")
STUB = Path(_distributions.__file__).with_suffix(".pyi")
HEAD = '''"""Made by `tests/test_distributions.py` with `APPORTION_WRITE=1`, and checked by it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

__all__ = {names}

class Factor:
    keys: dict[str, Any]
    quantile: Callable[[np.ndarray], np.ndarray] | None
    def __init__(self, keys: Mapping[str, Any], quantile: Callable[[np.ndarray], np.ndarray] | None = None): ...
    def truncated(self, min: float = ..., max: float = ...) -> Factor: ...
    @classmethod
    def of(cls, value: Any) -> Factor: ...

'''


def test_the_stub_has_every_constructor_with_its_signature():
    functions = sorted(set(_distributions.__all__) - {"Factor"})
    lines = [f"def {name}{inspect.signature(getattr(ap, name))}: ...\n".replace("'", "") for name in functions]
    head = HEAD.replace("{names}", str(["Factor", *functions]).replace("'", '"'))
    if "APPORTION_WRITE" in os.environ:
        STUB.write_text(head + "".join(lines), encoding="utf-8")
    assert STUB.read_text(encoding="utf-8") == head + "".join(lines)


def test_every_family_of_the_engine_has_a_constructor():
    for family, summary, _ in _engine.distributions():
        name = _distributions._name_of(family)
        assert name in ap.__all__ and getattr(ap, name).__name__ == name, family
        assert name in ("LogNormal", "Histogram") or getattr(ap, name).__doc__.startswith(summary)
    assert ap.Normal(1, sd=2, unit="nm").keys == {"distribution": "normal", "mean": 1, "sd": 2, "unit": "nm"}
    assert ap.Beta(2, 3).keys == {"distribution": "beta", "alpha": 2, "beta": 3, "min": 0.0, "max": 1.0}
    for wrong in (lambda: ap.Normal(1), lambda: ap.Boolean(unit="m"), lambda: ap.Uniform(0, 1, 2)):
        with pytest.raises(TypeError):
            wrong()
