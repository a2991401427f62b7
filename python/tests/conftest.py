import os
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


def ishigami(x1, x2, x3):
    return np.sin(x1) + 7.0 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1)


def polynomial(x1, x2, x3):
    """The same bits for numbers and arrays of any length, unlike sines."""
    return x1 + 2.0 * x2 * x3 + 0.1 * x3 * x3


@pytest.fixture
def cube():
    return {f"x{k}": (-np.pi, np.pi) for k in (1, 2, 3)}


@pytest.fixture
def studies():
    return ROOT / "studies"


@pytest.fixture
def program():
    """The program of the same sources, if it has been built."""
    path = os.environ.get("APPORTION")
    if not path:
        pytest.skip("APPORTION does not name the program")
    return path
