import importlib
import io
import pickle
import warnings
from contextlib import redirect_stdout
from pathlib import Path

import numpy as np
import pytest
from conftest import ishigami

import apportion as ap
from apportion import salib

PROBLEM = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}
EXACT = np.array([0.3139, 0.4424, 0.0]), np.array([0.5576, 0.4424, 0.2437])
SCRIPTS = sorted((Path(__file__).parent / "salib_scripts").glob("*.py"))


@pytest.mark.parametrize("second_order", [True, False])
def test_indices_of_a_known_function(second_order):
    x = salib.sample.sobol.sample(PROBLEM, 4096, calc_second_order=second_order, seed=1)
    assert x.shape == (4096 * (8 if second_order else 5), 3)
    found = salib.analyze.sobol.analyze(PROBLEM, ishigami(*x.T), calc_second_order=second_order)
    assert np.abs(found["S1"] - EXACT[0]).max() < 0.02 and np.abs(found["ST"] - EXACT[1]).max() < 0.02
    if second_order:
        assert abs(found["S2"][0, 2] - 0.2437) < 0.02 and np.isnan(found["S2"][2, 0])


def layout(a, b):
    """The points A, AB_j, B of all base points, and their numbers."""
    rows = np.repeat(a[:, None, :], a.shape[1] + 2, axis=1)
    rows[:, -1] = b
    for j in range(a.shape[1]):
        rows[:, 1 + j, j] = b[:, j]
    return rows.reshape(-1, a.shape[1])


def analysed(x, problem=PROBLEM, y=None):
    y = ishigami(*x.T) if y is None else y
    return salib.analyze.sobol.analyze(problem, y, calc_second_order=False, X=x, seed=1)


def test_points_made_elsewhere_are_checked():
    rng = np.random.default_rng(1)
    a, b = rng.uniform(-np.pi, np.pi, (2, 400, 3))
    x = layout(a, b)
    found = analysed(x)
    plain = salib.analyze.sobol.analyze(PROBLEM, ishigami(*x.T), calc_second_order=False, seed=1)
    assert all(np.array_equal(found[key], plain[key]) for key in plain)
    with pytest.warns(UserWarning, match="1200 base points repeat earlier ones"):
        assert np.array_equal(analysed(np.vstack([x] * 4))["S1_conf"], found["S1_conf"])
    # Two base points have lost rows; their other rows are left out.
    with pytest.warns(UserWarning, match="7 rows"):
        kept = analysed(np.delete(x, [7, 8, 900], 0))
    assert np.array_equal(kept["ST"], analysed(np.delete(x.reshape(400, 5, 3), [1, 180], 0).reshape(-1, 3))["ST"])
    normal = rng.normal(size=(2, 400, 3)) @ np.linalg.cholesky([[1, 0.8, 0], [0.8, 1, 0], [0, 0, 1]]).T
    shifted = layout(a, b + 1)
    together = layout(a, b)
    together.reshape(400, 5, 3)[:, 2, 2] = b[:, 2]
    refused = {
        "x1 in matrix A and x1 in B": layout(a, 0.7 * a + 0.3 * b),
        "x1 and x2 are correlated": layout(*normal),
        "x1 has other values": shifted,
        "x2 and x3 change together": together,
        "not in SALib's order": x[rng.permutation(len(x))],
    }
    for what, points in refused.items():
        with pytest.raises(ap.StudyError, match=what):
            analysed(points)


def run(script, package):
    """What a script prints with `package` in the place of SALib, and its names."""
    text, names, printed = script.read_text(encoding="utf-8").replace("from SALib", f"from {package}"), {}, io.StringIO()
    with redirect_stdout(printed):
        exec(compile(text, script.name, "exec"), names)
    return printed.getvalue(), names


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_for_salib_says_the_same_of_the_same_points(script, monkeypatch, tmp_path):
    pytest.importorskip("SALib")
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    for method in salib.sample.__all__:
        sampler = importlib.import_module(f"SALib.sample.{method}")
        theirs, ours = sampler.sample, getattr(salib.sample, method).sample

        def sample(problem, *args, theirs=theirs, ours=ours, **keywords):
            of_salib, points = theirs(problem, *args, **keywords), ours(problem, *args, **keywords)
            assert points.shape == of_salib.shape
            spread = of_salib.std(axis=0)
            assert (np.abs(points.mean(axis=0) - of_salib.mean(axis=0)) < 0.5 * spread).all()
            assert (np.abs(points.std(axis=0) - spread) < 0.3 * spread).all()
            return points

        monkeypatch.setattr(sampler, "sample", sample)
    printed, names = run(script, "apportion.salib")
    expected, theirs = run(script, "SALib")
    assert printed == expected
    assert set(names["Si"]) == set(theirs["Si"])
    for key, values in theirs["Si"].items():
        if key == "names":
            assert list(names["Si"][key]) == list(values)
        else:
            assert np.allclose(names["Si"][key], np.ma.filled(values, np.nan), rtol=0, atol=1e-12, equal_nan=True), key
    again = pickle.loads(pickle.dumps(names["Si"]))
    assert again.to_df()[0].equals(names["Si"].to_df()[0]) if "ST" in again else again.to_df().equals(names["Si"].to_df())


def test_a_problem_with_its_results_is_pickled_and_evaluated_in_processes():
    sp = ap.salib.ProblemSpec(PROBLEM).sample_latin(100, seed=1).evaluate(salib.test_functions.Ishigami.evaluate, nprocs=2)
    sp.analyze_rbd_fast(seed=1)
    again = pickle.loads(pickle.dumps(sp))
    assert np.array_equal(again.results, ishigami(*sp.samples.T)) and str(again) == str(sp)


def test_without_a_seed_points_differ():
    x = [salib.sample.sobol.sample(PROBLEM, 8, seed=seed) for seed in (None, None, 1, 1)]
    assert not np.array_equal(x[0], x[1]) and np.array_equal(x[2], x[3])
    assert np.array_equal(salib.sample.sobol.sample(PROBLEM, 4, skip_values=4, seed=1), x[2][32:])


def test_a_run_that_failed_leaves_its_base_point_out():
    y = ishigami(*salib.sample.sobol.sample(PROBLEM, 64, seed=1).T)
    whole = salib.analyze.sobol.analyze(PROBLEM, y[8:], seed=1)
    y[0] = np.nan
    with pytest.warns(UserWarning):
        found = salib.analyze.sobol.analyze(PROBLEM, y, seed=1)
    assert np.allclose(found["ST"], whole["ST"], atol=1e-12) and np.array_equal(found["ST_conf"], whole["ST_conf"])


def test_what_is_not_served_says_what_is():
    with pytest.raises(ImportError, match="analyze.delta is not there: use ap.given_data"):
        from apportion.salib.analyze import delta  # noqa: F401
    with pytest.raises(ImportError, match="analyze.fast is not there: use sample.sobol"):
        from apportion.salib.analyze.fast import analyze  # noqa: F401
    with pytest.raises(ImportError, match="fast_sampler is not there: use sample.sobol"):
        salib.ProblemSpec(PROBLEM).sample_fast(100)
    with pytest.raises(AttributeError, match="sample_nothing: there is no apportion.salib.sample.nothing"):
        salib.ProblemSpec(PROBLEM).sample_nothing(100)
    refusals = {
        "scramble=False": lambda: salib.sample.sobol.sample(PROBLEM, 8, scramble=False),
        "optimal_trajectories=4": lambda: salib.sample.morris.sample(PROBLEM, 8, optimal_trajectories=4),
        "dists": lambda: salib.sample.morris.sample({**PROBLEM, "dists": ["norm"] * 3}, 8),
        "groups": lambda: salib.sample.latin.sample({**PROBLEM, "groups": ["a", "b", "a"]}, 8),
        "conf_level": lambda: salib.analyze.sobol.analyze(PROBLEM, np.arange(16.0), conf_level=95),
        "there are no points": lambda: salib.ProblemSpec(PROBLEM).evaluate(ishigami),
        "there are no outputs": lambda: salib.ProblemSpec(PROBLEM).analyze_sobol(),
        "there is no result": lambda: salib.ProblemSpec(PROBLEM).to_df(),
    }
    for words, refused in refusals.items():
        with pytest.raises(ap.StudyError, match=words):
            refused()


def test_problems_become_factors():
    problem = {
        "names": ["a", "b", "c", "d", "e", "f"],
        "bounds": [[0, 1], [1, 10], [0, 2, 0.5], [1, 2], [-1, 1, 0, 2], [0, 0.5]],
        "dists": ["unif", "logunif", "triang", "norm", "truncnorm", "lognorm"],
        "groups": ["g", "g", "c", "d", "e", "f"],
    }
    result = ap.analyse(lambda a, b, c, d, e, f: a + b, ap.from_salib(problem), base_samples=256)
    assert abs(result.groups()["g"].estimate - 1) < 1e-6
    with pytest.raises(ap.StudyError, match="unif"):
        ap.from_salib({"names": ["a"], "bounds": [[0, 1]], "dists": ["cauchy"]})


def test_only_one_output_is_analysed_at_a_time():
    x = salib.sample.sobol.sample(PROBLEM, 64, seed=1)
    y = ishigami(*x.T)
    one = salib.analyze.sobol.analyze(PROBLEM, y[:, None], seed=1)
    assert np.array_equal(one["ST"], salib.analyze.sobol.analyze(PROBLEM, y, seed=1)["ST"])
    for several in (np.column_stack([y, y]), y[None], y.reshape(-1, 2, 1)):
        with pytest.raises(ValueError):
            salib.analyze.sobol.analyze(PROBLEM, several)


def test_arguments_that_are_not_there_or_out_of_range_are_named():
    with pytest.raises(ap.StudyError, match="names"):
        salib.sample.sobol.sample({"num_vars": 1, "bounds": [[0, 1]]}, 8)
    with pytest.raises(ap.StudyError, match="names"):
        salib.analyze.sobol.analyze({"num_vars": 1}, np.arange(8))
    g = salib.test_functions.Sobol_G.evaluate
    for values, of in (([[0.5, 2]], {"a": [0, 1]}), ([0.5, 0.5], {"a": [0, 1]}), ([[0.5, 0.5]], {"a": [0]})):
        with pytest.raises(ValueError):
            g(np.array(values), **of)
    with pytest.raises(ValueError):
        g(np.array([[0.5, 0.5]]), a=[0, 1], alpha=0)


def test_the_page_lists_what_is_refused():
    from apportion.salib import _others

    page = (Path(__file__).resolve().parents[2] / "docs/guide/from-salib.md").read_text(encoding="utf-8")
    assert [name for name in _others._INSTEAD if f"`{name}`" not in page] == []


def test_a_constant_output_has_indices_of_0_and_problems_show_their_methods():
    pytest.importorskip("matplotlib").use("Agg")
    problem = salib.ProblemSpec({"names": ["a", "b"], "bounds": [[0, 1]] * 2, "outputs": ["u", "v"]})
    assert {"sample_sobol", "analyze_morris", "evaluate"} < set(dir(problem))
    problem.sample_sobol(64).evaluate(lambda x: np.column_stack([x.sum(axis=1), np.full(len(x), 2.0)]))
    with pytest.warns(ap.SensitivityWarning, match="do not vary") as caught:
        problem.analyze_sobol()
    assert {warning.filename for warning in caught} == {__file__}
    assert not problem.analysis["v"]["ST"].any() and problem.analysis["u"]["ST"].all()
    axes = problem.heatmap()
    assert axes.get_title() == "u" and np.array_equal(axes.images[0].get_array(), [problem.analysis["u"][key] for key in ("ST", "S1")])
    assert problem.heatmap("v", "S1").images[0].get_array().shape == (1, 2)


def test_shuffled_trajectories_are_put_in_order():
    problem = {"names": [f"x{k}" for k in range(10)], "bounds": [[0, 1]] * 10}
    points = salib.sample.morris.sample(problem, 12, seed=1)
    outputs = points[:, 0] * points[:, 1] + points[:, 2]
    rows = np.random.default_rng(0).permutation(len(outputs))
    plain, shuffled = (salib.analyze.morris.analyze(problem, points[order], outputs[order]) for order in (slice(None), rows))
    for measure in ("mu", "mu_star", "sigma"):
        assert np.abs(plain[measure] - shuffled[measure]).max() < 1e-12
    with pytest.raises(ap.StudyError, match="no trajectories"):
        salib.analyze.morris.analyze(problem, np.random.default_rng(0).random(points.shape), outputs)


def test_a_code_among_outputs_that_all_differ_is_warned_of():
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[0, 1]] * 3}
    x = salib.sample.sobol.sample(problem, 512, calc_second_order=False, seed=1)
    y = 3 * x[:, 0] + x[:, 1] + 10
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        salib.analyze.sobol.analyze(problem, y, calc_second_order=False)
    y[np.random.default_rng(1).choice(len(y), 50, replace=False)] = -99
    with pytest.warns(ap.SensitivityWarning, match=r"-99\.0 occurs in 50 of 2560 rows"):
        salib.analyze.sobol.analyze(problem, y, calc_second_order=False)
