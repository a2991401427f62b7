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
