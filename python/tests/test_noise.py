import apportion as ap
import numpy as np
import pytest


def noisy(x1, x2, seed):
    return x1 + 2 * x2 + np.random.default_rng(int(seed)).normal()


def test_the_noise_stands_beside_the_factors():
    factors = {"x1": (0, 1), "x2": (0, 1)}
    result = ap.analyse(noisy, factors, noise="seed", vectorised=False, base_samples=2048, subsets=[["x1", "seed"]])
    output = result["y"]
    # Variances 1/12, 4/12 and 1.
    assert list(output.first_order) == ["x1", "x2"]
    for index, exact in [(output.noise["total"], 12 / 17), (output.noise["mean_share"], 5 / 17)]:
        assert abs(index.estimate - exact) < 0.05
    assert abs(output.of_mean()["x2"].estimate - 0.8) < 0.2
    assert list(output.of_mean("total")) == ["x1"]
    with pytest.raises(ValueError):
        output.of_mean("both")
    assert ap.Seed().keys["distribution"] == "seed"


def test_total_indices_of_the_mean():
    # Variances 1/12 and 4/12 of the mean, which has no interactions, and 1 of the noise.
    factors = {"x1": (0, 1), "x2": (0, 1)}
    result = ap.analyse(noisy, factors, noise={"mean_totals": True}, vectorised=False, base_samples=2048)
    totals = result["y"].of_mean("total")
    assert list(totals) == ["x1", "x2"]
    assert abs(totals["x2"].estimate - 0.8) < 0.25 and abs(totals["x1"].estimate - 0.2) < 0.25
    named = ap.analyse(
        lambda x1, s: x1 + 0 * s, {"x1": (0, 1)}, noise={"name": "s", "mean_totals": True}, call="columns", base_samples=64
    )
    assert abs(named["y"].of_mean("total")["x1"].estimate - 1) < 1e-9
    with pytest.raises(ap.StudyError, match="mean and variance as outputs of its own"):
        ap.Study(noisy, factors, noise={"repetitions": 8}, vectorised=False)
