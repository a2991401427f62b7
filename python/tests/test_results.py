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


def shown():
    """One of each kind of result, with the output that is drawn."""
    study = ap.Study(two, UNIT, outputs=["a", "b"], base_samples=64, second_order=True)
    result, rng = study.run(), np.random.default_rng(1)
    inputs = {"x1": rng.random(100), "x2": rng.random(100)}
    waves = {"w": {"axis": "day"}}
    wave = ap.analyse(lambda x1, x2: np.outer(x1, [1, 2, 3]) + x2[:, None], UNIT, outputs=waves, base_samples=64)
    return {
        "result": (result, {"output": "a"}),
        "screening": (study.screen(8), {"output": "a"}),
        "sweep": (study.sweep(points=5), {"output": "a"}),
        "given data": (ap.given_data(inputs, inputs["x1"], measures=True, name="table"), {}),
        "output": (result["a"], {}),
        "indices": (result["a"].total, {}),
        "pairs": (result["a"].second_order, {}),
        "series": (wave.series["w"], {}),
    }


@pytest.mark.parametrize("kind", shown())
def test_every_kind_of_result_is_pickled_and_shown(kind):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    pytest.importorskip("matplotlib").use("Agg")
    found, of = shown()[kind]
    again = pickle.loads(pickle.dumps(found))
    assert type(again) is type(found) and repr(again) == repr(found) and again._repr_html_() == found._repr_html_()
    if isinstance(found, ap.Document):
        assert again.to_json() == found.to_json() and again.to_html() == found.to_html() and again.tables() == found.tables()
        assert copy.deepcopy(found).to_json() == found.to_json()
    frame = found.to_frame()
    assert (
        isinstance(frame, pandas.DataFrame) and frame.to_csv() == again.to_frame().to_csv() and None not in frame.index.names
    )
    assert isinstance(found.to_xarray(), xarray.Dataset)
    assert "x1" in found._repr_html_()
    axes = found.plot(**of)
    assert axes.patches or axes.lines


def test_columns_and_series_keep_their_names():
    pandas = pytest.importorskip("pandas")
    study = ap.Study(None, UNIT, base_samples=64)
    points = pandas.DataFrame(study.sample(), columns=study.factors)
    height = (points["x1"] + points["x2"]).rename("height")
    assert list(study.analyse(height)) == ["height"]
    drawn = pandas.DataFrame(np.random.default_rng(1).random((100, 2)), columns=["x1", "x2"])
    table = ap.given_data(drawn, (drawn["x1"] - drawn["x2"]).rename("slope"))
    assert list(table.to_frame().index) == [("slope", "x1"), ("slope", "x2")]
    assert list(ap.analyse(lambda x1, x2: pandas.Series(x1 + x2, name="height"), UNIT, base_samples=64)) == ["height"]
    screening = ap.Study("ishigami").screen(8)
    assert screening.to_frame().loc[("y", "x1"), "mu_star"] == float(screening.tables()["study-screen"][0]["mu_star"])
    with pytest.raises(KeyError, match="'b': the outputs are y"):
        screening.plot("b")


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
    wave = ap.analyse(
        lambda x1, x2: np.outer(x1, [1, 2, 3]) + x2[:, None], UNIT, outputs={"w": {"axis": "day"}}, base_samples=64
    )
    series = wave.series["w"]
    assert len(series.plot().lines) == 2 and series.plot("first_order").get_xlabel() == "day"


def test_a_default_of_many_runs_is_reported(capsys):
    ap.Study(lambda x1, x2: x1 + x2, UNIT, vectorised=False, name="slow").run()
    assert "slow: 65536 runs of the function" in capsys.readouterr().err


def test_names_of_outputs_belong_to_the_result():
    pd = pytest.importorskip("pandas")
    study = ap.Study(None, UNIT, base_samples=64)
    y = study.sample() @ [1, 2]
    for name in ("yield", "cost"):
        assert list(study.analyse(pd.Series(y, name=name))) == [name]
        assert list(study.analyse({name: y, "other": y})) == [name, "other"]
    assert list(study.analyse(y)) == ["y"] and study.outputs == ["y"]


def test_rows_of_pandas_go_by_their_index():
    pd = pytest.importorskip("pandas")
    study = ap.Study(None, UNIT, base_samples=64)
    y = pd.Series(study.sample() @ [1, 2], name="y")
    shuffled = y.sample(frac=1, random_state=1)
    assert dict(study.analyse(shuffled).total) == dict(study.analyse(y).total)
    assert dict(study.analyse(shuffled.to_frame()).total) == dict(study.analyse(y).total)


def test_an_index_is_a_number():
    index = ap.Index(0.25, 0.2, 0.3)
    assert float(index) == 0.25 and f"{index:.3f}" == "0.250"
    assert index < 0.3 and index <= ap.Index(0.25, 0.1, 0.9) and 0.1 < index and np.float64(0.1) < index
    assert index + index == 0.5 and 1 - index == 0.75 and index * 2 == 0.5 and sum([index, index]) == 0.5
    estimate, low, high = index
    assert (estimate, low, high) == index and pickle.loads(pickle.dumps(index)) == index


def test_warnings_are_of_the_line_that_asks():
    for ask in (lambda: ap.analyse(two, UNIT, base_samples=65), lambda: ap.Study(two, UNIT, base_samples=65).run()):
        with pytest.warns(ap.SensitivityWarning) as caught:
            ask()
        assert {warning.filename for warning in caught} == {__file__}


def failing(a, b):
    if a > 0.9:
        raise ValueError(f"no root in {a}")
    if b > 0.95:
        raise ZeroDivisionError
    return a + b, a * b


@pytest.fixture(scope="module")
def rich():
    factors = {"a": ap.Uniform(0, 1, group="g"), "b": (0, 1)}
    options = {"measures": ["delta"], "aggregate": True, "subsets": [["a", "b"]], "max_failed": 0.5, "outputs": ["y", "z"]}
    with pytest.warns(ap.SensitivityWarning, match=r"most often ValueError \(\d+ runs\)"):
        return ap.analyse(failing, factors, vectorised=False, base_samples=64, **options)


def test_failures_are_counted_by_their_reasons(rich):
    assert sum(rich["y"].failures.values()) == rich["y"].runs_failed > 0
    assert next(iter(rich.failures)) == "ZeroDivisionError" and rich.failures == rich["y"].failures


def test_frames_and_tables_have_what_the_text_has(rich):
    pytest.importorskip("pandas")
    frame = rich.to_frame()
    assert list(frame.loc["y"].kind) == ["factor", "factor", "group", "subset"]
    assert frame.loc[("all outputs", "a"), "total"] == rich.aggregate.total["a"].estimate
    for column in ("interaction", "interaction_low", "probability_first", "probability_above_threshold", "delta"):
        assert np.isfinite(frame.loc[("y", "a"), column])
    y = rich["y"]
    assert y.probability_first["a"] + y.probability_first["b"] == pytest.approx(1, abs=1e-3)
    assert y.interaction["a"].estimate == y.total["a"].estimate - y.first_order["a"].estimate
    for table in (rich.to_markdown(), rich.to_latex(), rich._repr_html_()):
        assert table.count("all outputs") == 1 and "Measures of z" in table and "P(largest)" in table
    words = ap._engine.in_words(*y.total["a"])
    assert " ± " in words and words in str(rich) and words in rich.to_markdown() and words in y._repr_html_()
    assert words.replace("±", r"$\pm$") in rich.to_latex() and "$S_T$" in rich.to_latex()
    assert f"a: {words}" in repr(y.total)


def test_tables_say_what_they_cut():
    result = ap.analyse(lambda x: np.outer(x[:, 0], range(1, 7)), {f"x{k}": (0, 1) for k in range(40)}, base_samples=16, call="matrix")
    assert "the 30 largest of 40" in result._repr_html_() and "2 more outputs" in result._repr_html_()
    assert "x39" in result.to_markdown()


def test_the_only_series_is_what_a_result_shows():
    pytest.importorskip("matplotlib").use("Agg")
    result = ap.analyse(lambda x1, x2: np.outer(x1, [1, 2, 3]) + x2[:, None], UNIT, outputs={"w": {"axis": "day"}}, base_samples=64)
    assert dict(result.total) == dict(result.series["w"].total_of_all)
    assert len(result.plot().lines) == 2 and "w as a whole" in result._repr_html_() and "w[0]" not in result._repr_html_()


def test_charts_for_papers_are_files(result, tmp_path):
    result.save(tmp_path, charts=["pdf", "png"], width="88mm")
    kinds = {path.suffix for path in (tmp_path / "charts").iterdir()}
    assert kinds == {".pdf", ".png"}
    for wrong in ({"charts": ["gif"]}, {"width": "3 furlongs"}):
        with pytest.raises(ap.StudyError):
            result.save(tmp_path / "other", **wrong)
    assert not (tmp_path / "other").exists()


def test_all_kinds_of_results_warn_at_the_line_that_asks():
    rng = np.random.default_rng(1)
    y = rng.random(60)
    y[:20] = -999
    study = ap.Study(lambda x1, x2: np.where(x1 > 0.9, np.nan, x1), UNIT)
    for ask in (lambda: ap.given_data(rng.random((60, 2)), y), lambda: study.screen(8)):
        with pytest.warns(ap.SensitivityWarning) as caught:
            document = ask()
        assert {warning.filename for warning in caught} == {__file__}
        assert [str(warning.message) for warning in caught] == list(dict.fromkeys(document.warnings))


def test_many_outputs_warn_once_of_each_kind():
    def curve(x):
        return x[:, :1] * np.linspace(1, 2, 20) + (x[:, 1:] > 0.995) * 1e3

    with pytest.warns(ap.SensitivityWarning) as warned:
        result = ap.analyse(curve, {"a": ap.Uniform(0, 1), "b": ap.Uniform(0, 1)}, call="matrix", base_samples=64)
    assert len(result.warnings) >= 20
    kinds = {of["code"] for record in result.to_dict()["outputs"] for of in record["warnings"]}
    assert len([w for w in warned if issubclass(w.category, ap.SensitivityWarning)]) == len(kinds)
