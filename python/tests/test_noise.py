import apportion as ap
import numpy as np
import pytest


def noisy(x1, x2, seed):
    return x1 + 2 * x2 + np.random.default_rng(int(seed)).normal()


def test_the_noise_is_listed_with_the_factors():
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


def test_repetitions_give_mean_and_variance_as_in_the_engine():
    factors = {"x1": (0, 1), "x2": (0, 1)}
    noise = {"repetitions": 5}
    options = {"noise": noise, "base_samples": 64, "seed": 3}
    formula = ap.analyse("expression", factors, outputs={"y": "(x1 + 2 * x2) * seed / 2147483648"}, **options)
    calls = []

    def one(x1, x2, seed):
        calls.append(seed)
        return (x1 + 2 * x2) * seed / 2147483648

    assert list(formula.outputs) == ["y_mean", "y_variance"]
    for function, vectorised in [(one, False), (lambda x1, x2, seed: (x1 + 2 * x2) * seed / 2147483648, True)]:
        result = ap.analyse(function, factors, vectorised=vectorised, **options)
        assert list(result.outputs) == list(formula.outputs)
        for name in result.outputs:
            for own, expected in zip(result[name].total.values(), formula[name].total.values()):
                assert own.estimate == pytest.approx(expected.estimate, abs=1e-12)
    # A row at a time is asked once more, for the names of the outputs, and some rows at the end, for the same answer.
    runs = 5 * formula.to_dict()["provenance"]["model_runs"]
    assert runs + 1 <= len(calls) <= 1.01 * runs + 1
    with pytest.raises(ap.StudyError, match="from 1 to 1000"):
        ap.Study(one, factors, noise={"repetitions": 0}, vectorised=False)


def test_repetitions_of_series_failures_and_units():
    def walk(x, seed):
        if x > 0.9:
            raise ValueError("too far")
        steps = np.random.default_rng(int(seed)).normal(size=3)
        return {"path": x + np.cumsum(steps), "end": x + steps.sum()}

    outputs = {"path": {"unit": "nm", "length": 3, "axis": "step"}, "end": "nm/s"}
    noise = {"repetitions": 4, "name": "seed"}
    study = ap.Study(walk, {"x": (0, 1)}, noise=noise, outputs=outputs, vectorised=False, base_samples=64)
    with pytest.warns(UserWarning, match="too far"):
        values = study.evaluate([[0.5, 7.0], [0.95, 7.0]])
    assert study.outputs == [f"path_{p}[{k}]" for p in ("mean", "variance") for k in range(3)] + ["end_mean", "end_variance"]
    assert np.isfinite(values[0]).all() and np.isnan(values[1]).all()
    assert values[0, 2] == pytest.approx(values[0, 6]) and values[0, 5] == pytest.approx(values[0, 7])
    units = dict(study._study.outputs)
    assert units["path_variance[0]"] == "nm^2" and units["end_variance"] == "(nm/s)^2"
