"""A slow model to a stated accuracy, with a journal that a second call goes on from."""

import tempfile
from pathlib import Path

import apportion as ap

with tempfile.TemporaryDirectory() as folder:
    calls = []

    def bending(load, length, width):
        calls.append(1)
        return load * length**3 / width

    factors = {"load": ap.Normal(10, 1), "length": (0.9, 1.1), "width": ap.Triangular(0.1, 0.2, 0.3)}
    options = {"accuracy": 0.02, "vectorised": False, "journal": Path(folder, "bending.journal"), "version": "1"}
    result = ap.analyse(bending, factors, **options)
    assert max(index.high - index.low for index in result.total.values()) <= 0.04
    made = len(calls)
    again = ap.analyse(bending, factors, **options)
    assert dict(again.total) == dict(result.total) and len(calls) - made < 10
