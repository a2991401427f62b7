"""Results and studies as objects of Python."""

import copy
import pickle

import apportion as ap
import numpy as np
import pytest
from conftest import polynomial

UNIT = {"x1": (0, 1), "x2": (0, 1)}


def two(x1, x2):
    return {"a": x1 + x2, "b": 0 * x1 + 3}


@pytest.fixture(scope="module")
def result():
    return ap.analyse(two, UNIT, base_samples=64)


def test_results_are_copied_and_pickled(result):
    for again in (pickle.loads(pickle.dumps(result)), copy.copy(result), copy.deepcopy(result)):
        assert isinstance(again, ap.Result) and again.to_json() == result.to_json()
        assert repr(again) == repr(result) and again.to_html() == result.to_html()
    output = pickle.loads(pickle.dumps(result["a"]))
    assert dict(output.total) == dict(result["a"].total)
    screening = ap.Study(two, UNIT, outputs=["a", "b"]).screen(4)
    assert copy.deepcopy(screening).to_json() == screening.to_json()
    with pytest.raises(TypeError, match="only results of runs can be pickled"):
        pickle.dumps(screening)


def test_studies_are_copied_and_pickled(cube, studies):
    study = ap.Study(polynomial, cube, base_samples=64)
    total = dict(study.run().total)
    for again in (pickle.loads(pickle.dumps(study)), copy.deepcopy(study), copy.copy(study)):
        assert dict(again.run().total) == total and again.source == study.source
    loaded = ap.Study.load(studies / "ishigami.toml", **{"design.base_samples": 64})
    again = pickle.loads(pickle.dumps(loaded))
    assert again.runs == loaded.runs and np.array_equal(again.sample(), loaded.sample())
    assert copy.copy(ap.Study.parse('model = "ishigami"', **{"design.base_samples": 64})).runs == loaded.runs
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(ap.Study(lambda x1, x2: x1, UNIT))


def test_unknown_names_are_reported_with_the_known_ones(result):
    assert list(result) == ["a", "b"] and len(result) == 2 and "a" in result and "x1" not in result
    with pytest.raises(KeyError, match="no index of 'zz': there are 'x1', 'x2'"):
        result["a"].total["zz"]
    with pytest.raises(KeyError, match="there are none"):
        result["a"].second_order["x1", "x2"]
    assert "zz" not in result["a"].total and result["a"].total.get("zz") is None


def test_an_output_without_indices_is_nan_in_arrays(result):
    pytest.importorskip("xarray")
    data = result.to_xarray()
    assert data.total.shape == (2, 2, 3)
    assert data.total.sel(output="a", factor="x1", bound="estimate") == result["a"].total["x1"].estimate
    assert np.isnan(data.total.sel(output="b")).all()
    with pytest.raises(ap.RunError, match="there are no indices: y: ") as raised:
        ap.analyse(lambda x1, x2: x1 * np.nan, UNIT, base_samples=16, max_failed=1.0)
    assert raised.value.result.to_xarray().total.shape == (1, 0, 3)
    with pytest.raises(ap.RunError, match="there are no indices"):
        ap.analyse(lambda x1, x2: 0 * x1 + 3, UNIT, base_samples=16)


def test_warnings_of_a_result_are_python_warnings():
    with pytest.warns(UserWarning, match="not a power of two"):
        ap.analyse(polynomial, {f"x{k}": (0, 1) for k in (1, 2, 3)}, base_samples=24)


def test_pairs_are_found_in_either_order_and_in_frames():
    pandas = pytest.importorskip("pandas")
    result = ap.analyse(lambda x1, x2: x1 * x2, UNIT, base_samples=64, second_order=True)
    pairs = result.second_order
    assert pairs["x1", "x2"] == pairs["x2", "x1"] and ("x2", "x1") in pairs and ("x1", "x3") not in pairs
    frame = pairs.to_frame()
    assert isinstance(frame, pandas.DataFrame) and frame.loc[("x1", "x2"), "estimate"] == pairs["x1", "x2"].estimate
    assert list(result.total.to_frame().index) == ["x1", "x2"]


def test_outputs_and_series_are_drawn():
    pytest.importorskip("matplotlib").use("Agg")
    result = ap.analyse(lambda x1, x2: x1 + x2, UNIT, base_samples=64)
    assert len(result["y"].plot().patches) == 4
    wave = ap.analyse(lambda x1, x2: np.outer(x1, [1, 2, 3]) + x2[:, None], UNIT, outputs={"w": {"axis": "day"}}, base_samples=64)
    series = wave.series["w"]
    assert len(series.plot().lines) == 2 and series.plot("first_order").get_xlabel() == "day"


def test_a_default_of_many_runs_is_reported(capsys):
    ap.Study(lambda x1, x2: x1 + x2, UNIT, vectorised=False, name="slow").run()
    assert "slow: 65536 runs of the function" in capsys.readouterr().err
