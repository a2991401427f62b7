import apportion as ap
import numpy as np
import pytest

FACTORS = {"x1": (-1, 1), "x2": (-1, 1)}
T = np.linspace(0.1, 3.0, 7)


def waves(x1, x2):
    """Variances sin^2 t / 3 and cos^2 t / 3."""
    return np.outer(x1, np.sin(T)) + np.outer(x2, np.cos(T))


def check(series, name="wave"):
    assert (series.name, len(series.positions)) == (name, len(T))
    for factor, share in (("x1", np.sin(T) ** 2), ("x2", np.cos(T) ** 2)):
        for indices in (series.first_order, series.total):
            assert indices[factor].shape == (len(T), 3)
            assert np.abs(indices[factor][:, 0] - share).max() < 1e-6
        assert abs(series.total_of_all[factor].estimate - share.mean()) < 1e-6


def test_an_array_under_a_name_is_a_series():
    options = {"base_samples": 256}
    axis = {"axis": "time", "axis_unit": "s", "positions": T, "unit": "nN"}
    named = ap.analyse(lambda x1, x2: {"wave": waves(x1, x2), "sum": x1 + x2}, FACTORS, **options)
    check(named.series["wave"])
    assert list(named.outputs) == [f"wave[{k}]" for k in range(len(T))] + ["sum"]
    assert abs(named["sum"].total["x1"].estimate - 0.5) < 1e-6
    only = ap.analyse(waves, FACTORS, outputs="wave", **options)
    check(only.series["wave"])
    stated = ap.analyse(waves, FACTORS, outputs={"wave": axis}, **options)
    check(stated.series["wave"])
    assert stated.series["wave"].axis == "time" and stated.series["wave"].axis_unit == "s"
    assert np.array_equal(stated.series["wave"].positions, T)
    assert stated["wave[0]"].unit == "nN"
    assert "time" in stated.to_html()


def test_series_row_by_row_and_with_single_numbers():
    def of_row(x1, x2):
        return x1 - x2, waves([x1], [x2])[0]

    result = ap.analyse(of_row, FACTORS, vectorised=False, outputs={"diff": "1", "wave": {"axis": "day"}}, base_samples=128)
    check(result.series["wave"])
    assert result.series["wave"].axis == "day" and "diff" in result.outputs
    # One array of all: what is left is the series.
    both = ap.analyse(
        lambda x1, x2: np.column_stack([x1 - x2, waves(x1, x2)]),
        FACTORS,
        outputs={"diff": "1", "wave": {"axis": "day"}},
        base_samples=128,
    )
    assert np.array_equal(both.series["wave"].total["x1"], result.series["wave"].total["x1"])
    # Without a name every column is an output, as it always was.
    assert list(ap.analyse(waves, FACTORS, base_samples=64).outputs)[:2] == ["y1", "y2"]


def test_series_that_are_computed_elsewhere_and_saved(tmp_path):
    study = ap.Study(None, FACTORS, outputs={"wave": {"length": len(T), "axis": "time"}}, base_samples=128)
    x = study.sample()
    values = waves(x[:, 0], x[:, 1])
    check(study.analyse({"wave": values}).series["wave"])
    result = study.analyse(values)
    check(result.series["wave"])
    result.save(tmp_path)
    check(ap.load_result(tmp_path / "study.json").series["wave"])
    assert ap.analyse("ishigami", base_samples=64).series == {}


def test_errors_of_series_are_reported():
    def changing(x1, x2, calls=[]):
        calls.append(1)
        return {"wave": waves(x1, x2)[:, : 7 if len(calls) == 1 else 3]}

    with pytest.raises(ap.AnswerError, match="wave with 3 values, and 7 values were expected"):
        ap.analyse(changing, FACTORS, base_samples=64)
    with pytest.raises(ap.AnswerError, match="state their `length`"):
        ap.analyse(waves, FACTORS, outputs={"a": {"axis": "t"}, "b": {"axis": "t"}}, base_samples=64)
    with pytest.raises(ap.AnswerError, match="shape"):
        ap.analyse(lambda x1, x2: {"y": np.zeros((3, 2))}, FACTORS, base_samples=64)
    with pytest.raises(ap.StudyError, match="rising order"):
        ap.analyse(waves, FACTORS, outputs={"wave": {"positions": T[::-1]}}, base_samples=64)


def test_a_unit_of_the_axis_needs_positions():
    with pytest.raises(ap.StudyError, match="positions"):
        ap.Study(None, {"x": (0, 1)}, outputs={"w": {"axis": "time", "axis_unit": "s", "length": 3}})
