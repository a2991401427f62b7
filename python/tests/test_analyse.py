import json
import math
import pickle
import subprocess
import sys
import threading
import time

import apportion as ap
import numpy as np
import pytest
from conftest import ishigami, polynomial

# Ishigami and Homma (1990) with a = 7, b = 0.1.
FIRST = {"x1": 0.3139051911, "x2": 0.4424111448, "x3": 0.0}
TOTAL = {"x1": 0.5575888552, "x2": 0.4424111448, "x3": 0.2436836641}


def near(indices, exact, tolerance):
    assert set(indices) == set(exact)
    for name, value in exact.items():
        assert abs(indices[name].estimate - value) < tolerance, (name, indices[name])


def test_five_lines(cube, tmp_path):
    result = ap.analyse(ishigami, cube, base_samples=4096)
    near(result.first_order, FIRST, 2e-3)
    near(result.total, TOTAL, 2e-3)
    assert np.asarray(result.total).shape == (3,)
    assert all(low <= e <= high for e, low, high in result.total.values())
    page = result._repr_html_()
    assert "<svg" in page and "<table>" in page and "<th>S_T</th>" in page and "x2" in repr(result)
    page = result.save(tmp_path / "out")
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    again = ap.load_result(tmp_path / "out" / "study.json")
    assert again.total["x1"] == result.total["x1"]
    assert json.loads(result.to_json())["outputs"][0]["name"] == "y"
    assert result.runs == 4096 * 5


def test_frames_and_plots(cube):
    pandas = pytest.importorskip("pandas")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    result = ap.analyse(ishigami, cube, base_samples=256)
    frame = result.to_frame()
    assert isinstance(frame, pandas.DataFrame) and list(frame.index) == ["x1", "x2", "x3"]
    assert frame.loc["x2", "total"] == result.total["x2"].estimate
    assert len(result.plot().patches) == 6


def test_every_way_to_call_gives_the_same_bits(cube):
    def matrix(x):
        return polynomial(x[:, 0], x[:, 1], x[:, 2])

    ways = [
        (polynomial, {}),
        (matrix, {}),
        (lambda x3, x2, x1: polynomial(x1, x2, x3), {}),
        (lambda *x: polynomial(*x), {}),
        (lambda **x: polynomial(**x), {}),
        (lambda x1, x2, x3: {"y": polynomial(x1, x2, x3)}, {}),
        (lambda x1, x2, x3: (polynomial(x1, x2, x3),), {}),
        (lambda x1, x2, x3: polynomial(x1, x2, x3), {"vectorised": False}),
        (lambda x: [polynomial(*x)], {"vectorised": False, "call": "matrix"}),
    ]
    found = [ap.analyse(f, cube, base_samples=64, surrogate="off", **more).total for f, more in ways]
    for other in found[1:]:
        assert dict(other) == dict(found[0])


def test_same_bits_on_any_number_of_threads(cube):
    one, two = (ap.analyse(ishigami, cube, base_samples=1024, threads=threads) for threads in (1, 2))
    assert one.to_dict()["outputs"] == two.to_dict()["outputs"]


def test_the_same_bits_as_the_program(studies, program, tmp_path):
    for name, more in [("ishigami", {}), ("coulomb-general", {"design.base_samples": 1024})]:
        overrides = [part for key, value in more.items() for part in ("--set", f"{key}={value}")]
        out = tmp_path / name
        command = [program, "run", studies / f"{name}.toml", "--out", out, "--no-journal", "--charts", "none", *overrides]
        subprocess.run(command, check=True, capture_output=True)
        theirs = json.loads((out / f"{name}.json").read_text(encoding="utf-8"))
        ours = ap.Study.load(studies / f"{name}.toml", **more).run().to_dict()
        assert ours["outputs"] == theirs["outputs"] and ours["factors"] == theirs["factors"]


def test_several_outputs(cube):
    def f(x1, x2, x3):
        return {"a": x1 + 2 * x2, "b": x3}

    result = ap.analyse(f, cube, base_samples=256)
    assert list(result.outputs) == ["a", "b"]
    near(result["a"].total, {"x1": 0.2, "x2": 0.8, "x3": 0.0}, 1e-6)
    with pytest.raises(ValueError, match="several outputs"):
        result.total
    with pytest.raises(KeyError, match="the outputs are a, b"):
        result["c"]
    tuples = ap.analyse(lambda x1, x2, x3: (x1, x2), cube, base_samples=64)
    assert list(tuples.outputs) == ["y1", "y2"]


def test_units_of_factors_and_outputs():
    result = ap.analyse(
        lambda k, x: k * x,
        {"k": ap.Uniform(0.5, 1.5, unit="N/m"), "x": ap.Uniform(10, 20, unit="nm")},
        outputs={"force": "nN"},
        base_samples=256,
    )
    assert abs(result.outputs["force"].mean - 15.0) < 1e-3 and result["force"].unit == "nN"


def test_distributions_have_their_moments():
    made = {
        "a": ap.Normal(1, 2),
        "b": ap.LogNormal(2, 1),
        "c": ap.Triangular(0, 1, 4),
        "d": ap.Beta(2, 3),
        "e": ap.Weibull(2, 1),
        "f": ap.Gumbel(0, 1),
        "g": ap.Integer(1, 6),
        "h": ap.Boolean(0.25),
        "i": ap.Discrete([1, 5], [3, 1]),
        "j": ap.Categorical(["u", "v"]),
        "k": ap.Empirical([1.0, 2.0, 6.0]),
        "l": ap.LogUniform(1, 10),
        "m": ap.TruncatedNormal(0, 1, -1, 1),
        "n": ap.TruncatedGumbel(0, 1, -1, 3),
        "o": ap.LogNormal(log_mean=0, log_sd=0.5),
        "p": ap.Gamma(2, 0.5),
        "q": ap.Exponential(1, 2),
        "r": ap.Poisson(3),
        "s": ap.StudentT(5, 1),
        "t": ap.Logistic(2, 0.5),
        "u": ap.Pareto(4, 3),
        "w": ap.Histogram([1, 3], [0, 1, 3]),
        "x": ap.Histogram({0: 1, 0.5: 2, 1: 5}),
        "ab": ap.Exponential(1).truncated(100),
    }
    means = {
        "a": 1,
        "b": 2,
        "c": 5 / 3,
        "d": 0.4,
        "e": math.gamma(1.5),
        "f": 0.5772,
        "g": 3.5,
        "h": 0.25,
        "i": 2,
        "j": 0.5,
        "k": 3,
        "l": 9 / math.log(10),
        "m": 0,
        "o": math.exp(0.125),
        "p": 1,
        "q": 3,
        "r": 3,
        "s": 1,
        "t": 2,
        "u": 4,
        "v": 1,
        "w": 1.625,
        "x": 2.5,
        "aa": 2,
        "ab": 101,
    }
    points = ap.Study(None, made, base_samples=8192).sample()
    for place, name in enumerate(made):
        if name in means:
            assert abs(points[:, place].mean() - means[name]) < 0.02, name


def test_scipy_distributions_by_their_quantile_functions():
    stats = pytest.importorskip("scipy.stats")
    result = ap.analyse(
        lambda a, b, c: a + b + c, {"a": stats.gamma(2), "b": stats.norm(1, 2), "c": stats.uniform(3, 4)}, base_samples=4096
    )
    parts = {"a": 2.0, "b": 4.0, "c": 16 / 12}
    near(result.total, {name: part / sum(parts.values()) for name, part in parts.items()}, 5e-3)
    assert abs(result["y"].mean - (2 + 1 + 5)) < 0.01
    with pytest.raises(ap.StudyError, match="work only with functions of Python"):
        ap.Study("ishigami", {"x1": stats.rayleigh(2)})
    with pytest.raises(ap.StudyError, match="not a distribution of scipy.stats"):
        ap.from_scipy(stats.gamma)
    with pytest.raises(ap.StudyError, match="is not one distribution"):
        ap.from_scipy(stats.norm([0, 1]))


def test_scipy_distributions_that_the_engine_has():
    stats = pytest.importorskip("scipy.stats")
    frozen = {
        "uniform": stats.uniform(3, 4),
        "norm": stats.norm(1, 2),
        "loguniform": stats.loguniform(1, 10),
        "lognorm": stats.lognorm(0.5, scale=3),
        "triang": stats.triang(0.25, 1, 4),
        "beta": stats.beta(2, 3, loc=1, scale=5),
        "weibull": stats.weibull_min(2, scale=3),
        "gumbel": stats.gumbel_r(1, 2),
        "gamma": stats.gamma(a=2.5, scale=3),
        "expon": stats.expon(1, 2),
        "logistic": stats.logistic(1, 2),
        "t": stats.t(4, 1, 2),
        "pareto": stats.pareto(3, scale=2),
        "truncnorm": stats.truncnorm(-1, np.inf, 3, 2),
        "poisson": stats.poisson(3.5),
        "randint": stats.randint(1, 7),
    }
    factors = {name: ap.from_scipy(law) for name, law in frozen.items()}
    assert all(factor.quantile is None for factor in factors.values())
    points = ap.Study(None, factors, base_samples=64).sample()
    # The same coordinates, as seen through uniform factors.
    cube = ap.Study(None, {name: (0, 1) for name in factors}, base_samples=64).sample()
    for place, (name, law) in enumerate(frozen.items()):
        assert np.allclose(points[:, place], law.ppf(cube[:, place]), rtol=1e-9), name
    for law, mean in [
        (stats.bernoulli(0.03, loc=2), 2.03),
        (stats.binom(5, 0.2), 1.0),
        (stats.rv_discrete(values=([1, 2, 5], [0.2, 0.3, 0.5]))(loc=1), 4.3),
    ]:
        keys = ap.from_scipy(law).keys
        assert keys["distribution"] == "discrete" and abs(np.dot(keys["values"], keys["weights"]) - mean) < 1e-12
    assert ap.from_scipy(stats.t(1)).quantile is not None and ap.from_scipy(stats.gamma(2), group="g").keys["group"] == "g"


def test_scipy_distributions_as_objects():
    stats = pytest.importorskip("scipy.stats")
    if not hasattr(stats, "make_distribution"):
        pytest.skip("SciPy has no distributions as objects before 1.15")
    gamma = stats.make_distribution(stats.gamma)(a=2.0)
    factors = {"a": stats.Normal(mu=1, sigma=2), "b": stats.Uniform(a=1, b=4), "c": 3 * gamma + 1, "d": 2 * stats.Normal()}
    made = {name: ap.from_scipy(law) for name, law in factors.items()}
    assert made["a"].keys == ap.Normal(1.0, 2.0).keys and made["b"].keys == ap.Uniform(1.0, 4.0).keys
    study = ap.Study(lambda a, b, c, d: a + b + c + d, factors, base_samples=64)
    cube = ap.Study(None, {name: (0, 1) for name in factors}, base_samples=64).sample()
    expected = [law.icdf(u) for law, u in zip(factors.values(), cube.T)]
    assert np.allclose(study.sample(), np.transpose(expected), rtol=1e-9)
    again = pickle.loads(pickle.dumps(made["d"]))
    assert again.quantile.identity() == made["d"].quantile.identity() != ap.from_scipy(3 * stats.Normal()).quantile.identity()
    if hasattr(stats, "Binomial"):
        assert ap.from_scipy(stats.Binomial(n=5, p=0.2)).keys["values"] == [0, 1, 2, 3, 4, 5]


def test_bounds_are_numbers_and_arrays_of_numpy():
    made = ap.Study(None, {"a": (np.float32(0), np.int64(2)), "b": np.array([1, 3]), "c": ap.Normal(np.array(1.0), np.float64(2))})
    same = ap.Study(None, {"a": (0.0, 2.0), "b": (1.0, 3.0), "c": ap.Normal(1.0, 2.0)})
    assert np.array_equal(made.sample(), same.sample())
    with pytest.raises(ap.StudyError, match="is not a factor"):
        ap.Study(None, {"a": np.array([0, 1, 2])})


def test_what_cannot_be_truncated():
    with pytest.raises(ap.StudyError, match="it is truncated"):
        ap.Normal(0, 1).truncated(max=2).truncated(min=0)
    with pytest.raises(ap.StudyError, match="variance is infinite"):
        ap.Study(None, {"x": ap.StudentT(2)})


def test_rows_that_fail_have_the_reason(cube):
    def f(x1, x2, x3):
        if np.any(x1 > 3.1):
            raise ZeroDivisionError("x1 is too large")
        return ishigami(x1, x2, x3)

    result = ap.analyse(f, cube, base_samples=1024, max_failed=0.5)
    failed = result["y"].runs_failed
    share = (math.pi - 3.1) / (2 * math.pi)
    assert 0.5 * share < failed / result.runs < 2 * share
    reasons = [record["reason"] for record in result.to_dict()["outputs"][0]["failures"]]
    assert reasons == ["ZeroDivisionError: x1 is too large"]


def test_wrong_answers_are_reported(cube):
    cases = [
        (lambda x1, x2, x3: 1.0, "vectorised=False"),
        (lambda x1, x2, x3: x1[:1], "2 rows"),
        (lambda x1, x2, x3: ["a"] * len(x1), "real numbers"),
        (lambda x1, x2, x3: x1 + 1j, "real numbers"),
        (lambda x1, x2, x3: {}, "no outputs"),
    ]
    for function, words in cases:
        with pytest.raises(ap.AnswerError, match=words):
            ap.analyse(function, cube, base_samples=64)
    with pytest.raises(ValueError, match="own"):

        def fails(x1, x2, x3):
            raise ValueError("own")

        ap.analyse(fails, cube, base_samples=64)


def test_an_answer_that_changes_its_shape_ends_the_run(cube):
    def f(x1, x2, x3):
        return x1 if len(x1) == 2 else x1[:-1]

    with pytest.raises(ap.AnswerError, match="shape"):
        ap.analyse(f, cube, base_samples=1024)


def test_wrong_input_is_reported_with_advice(cube):
    cases = [
        (lambda: ap.Study(ishigami, cube, base_samples=0), "base samples"),
        (lambda: ap.Study(ishigami, {"x1": (3, 1)}), "x1"),
        (lambda: ap.Study(ishigami, {"x1": "wide"}), "pair"),
        (lambda: ap.Study("ishigamy"), "ishigami"),
        (lambda: ap.Study(ishigami, cube, sampler="sobl"), "sobol"),
        (lambda: ap.Study(ishigami, cube, colour="red"), "colour"),
        (lambda: ap.Study(lambda a, b: a, cube), "3 factors"),
        (lambda: ap.Study(ishigami, cube, call="rows"), "columns"),
        (lambda: ap.Study("ishigami").run(executor=object()), "executors"),
        (lambda: ap.Study(None, cube).run(), "sample"),
        (lambda: ap.Study.parse("model = 3"), "model"),
    ]
    for wrong, words in cases:
        with pytest.raises(ap.StudyError, match=words):
            wrong()


def test_ask_and_tell(cube):
    study = ap.Study(None, cube, base_samples=1024)
    points = study.sample()
    assert points.shape == (study.runs, 3)
    told = study.analyse(ishigami(*points.T))
    called = ap.analyse(ishigami, cube, base_samples=1024)
    assert dict(told.total) == dict(called.total)
    outputs = ishigami(*points.T)
    outputs[5] = np.nan
    assert study.analyse(outputs)["y"].runs_failed == 1
    two = ap.Study(None, cube, base_samples=64).analyse({"a": points[: 64 * 5, 0], "b": points[: 64 * 5, 1]})
    assert list(two.outputs) == ["a", "b"]
    with pytest.raises(ap.StudyError, match="shape"):
        study.analyse(outputs[:-1])


def test_models_of_the_engine_and_everything_that_can_be_asked(cube):
    result = ap.analyse("ishigami", second_order=True, base_samples=4096, subsets=[["x1", "x3"]])
    assert abs(result.second_order["x1", "x3"].estimate - 0.2437) < 5e-3
    assert abs(next(iter(result.subsets().values())).estimate - 0.5576) < 5e-3
    groups = {name: ap.Uniform(-np.pi, np.pi, group="g" if name != "x2" else None) for name in cube}
    assert abs(ap.analyse(ishigami, groups, base_samples=1024).groups()["g"].estimate - 0.5576) < 5e-3
    force = ap.analyse("afm", {"thickness": ap.Uniform(0.8, 1.2, unit="um")}, afm={"friction": "hk"}, base_samples=64)
    assert force.outputs["critical_force"].unit == "nN"
    study = ap.Study("ishigami")
    assert np.allclose(study.evaluate([[0.0, np.pi / 2, 0.0]]), [[7.0]])
    accurate = ap.analyse(ishigami, cube, accuracy=0.01)
    assert accurate.to_dict()["stopping"]["target_met"] is True
    near(accurate.total, TOTAL, 0.02)
    # Plain rows come first, as for a program: pick-freeze designs take several hundred runs.
    calls = []
    sparing = ap.analyse(lambda a, b: calls.append(a) or a + 2 * b, {"a": (0, 1), "b": (0, 1)}, accuracy=0.02, vectorised=False)
    assert sparing.runs <= 64 and len(calls) <= 80 and abs(sparing.total["b"].estimate - 0.8) < 1e-6


def test_screening_sweeps_and_given_data(cube):
    study = ap.Study(ishigami, cube)
    assert study.screen(16).to_dict()["format"] == "apportion-screening"
    assert study.sweep("x1", points=5).to_dict()["format"] == "apportion-sweep"
    random = np.random.default_rng(1)
    x = random.uniform(-np.pi, np.pi, (2000, 3))
    given = ap.given_data({"x1": x[:, 0], "x2": x[:, 1], "x3": x[:, 2]}, ishigami(*x.T), factors=cube)
    measured = ap.given_data(x, ishigami(*x.T), measures=True)
    values = json.loads(measured.to_json())["outputs"][0]["measures"][1]["measures"]
    assert values["delta"]["low"] < values["delta"]["estimate"] and values["r2_hsic"]["p_value"] < 0.05
    record = given.to_dict()
    assert record["format"] == "apportion-given-data"
    assert "<svg" in given.to_html()


def test_a_journal_resumes_an_interrupted_run(cube, tmp_path):
    calls = []

    def f(x):
        calls.append(1)
        if len(calls) == 100:
            raise KeyboardInterrupt
        return polynomial(*x)

    def run():
        options = {"base_samples": 64, "vectorised": False, "journal": tmp_path / "f.journal", "version": "1"}
        return ap.analyse(f, cube, call="matrix", **options)

    with pytest.raises(KeyboardInterrupt):
        run()
    assert len(calls) == 100
    result = run()
    # The row that was interrupted is asked again, and the one that shows the outputs.
    assert 64 * 5 <= len(calls) <= 64 * 5 + 2 + 64
    whole = ap.analyse(polynomial, cube, base_samples=64, vectorised=False)
    assert dict(result.total) == dict(whole.total)


@pytest.mark.parametrize("way", ["screen", "sweep"])
def test_a_screening_and_a_sweep_that_were_interrupted_go_on(way, cube, tmp_path):
    calls, journal = [], tmp_path / "f.journal"

    def f(x):
        calls.append(1)
        if len(calls) == 50:
            raise KeyboardInterrupt
        return polynomial(*x)

    def run():
        study = ap.Study(f, cube, call="matrix", vectorised=False, version="1")
        if way == "screen":
            return study.screen(32, journal=journal).to_dict()["outputs"]
        return study.sweep(points=41, journal=journal).to_dict()["sweeps"]

    with pytest.raises(KeyboardInterrupt):
        run()
    again = len(calls)
    resumed = run()
    assert len(calls) - again < (32 * 4 if way == "screen" else 41 * 3)
    journal.unlink()
    assert run() == resumed


def test_an_edited_function_does_not_use_the_runs_of_another(cube, tmp_path):
    journal = tmp_path / "f.journal"
    options = {"base_samples": 64, "vectorised": False, "journal": journal}
    ap.analyse(lambda x1, x2, x3: x1 + x2, cube, **options)
    result = ap.analyse(lambda x1, x2, x3: x1 + 2 * x2, cube, **options)
    assert abs(result.total["x2"].estimate - 0.8) < 1e-6


def test_an_interrupt_takes_effect_within_a_second(tmp_path):
    script = tmp_path / "slow.py"
    script.write_text(
        # Where tests run in the background, signals of the keyboard are ignored from the start.
        "import signal, time, apportion as ap\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def f(x1, x2):\n    time.sleep(0.02)\n    return x1 + x2\n"
        "print('begun', flush=True)\n"
        "ap.analyse(f, {'x1': (0, 1), 'x2': (0, 1)}, base_samples=4096, vectorised=False, journal='f.journal')\n"
    )
    process = subprocess.Popen([sys.executable, script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout.readline() == b"begun\n"
    time.sleep(2.0)
    process.send_signal(2)
    begun = time.monotonic()
    _, errors = process.communicate(timeout=60)
    assert time.monotonic() - begun < 20
    assert b"KeyboardInterrupt" in errors and process.returncode != 0
    assert (tmp_path / "f.journal").stat().st_size > 1000


def test_progress_and_other_threads(cube):
    told = []
    ap.analyse(ishigami, cube, base_samples=65536, progress=lambda done, total: told.append((done, total)))
    assert all(0 <= done <= total for done, total in told)
    found = []
    thread = threading.Thread(target=lambda: found.append(ap.analyse(ishigami, cube, base_samples=256).total["x1"]))
    thread.start()
    thread.join()
    assert found == [ap.analyse(ishigami, cube, base_samples=256).total["x1"]]


def test_dependent_factors_have_shapley_effects():
    factors = {"a": ap.Normal(0, 1), "b": ap.Normal(0, 2)}
    result = ap.analyse(lambda a, b: 2 * a + b, factors, dependence={("a", "b"): 0.6}, base_samples=4096)
    # E(Y | a) = (2 + 0.6 * 2) a, Var(Y) = 4 + 4 + 2 * 2 * 2 * 0.6.
    assert abs(result.first_order["a"].estimate - 3.2**2 / 12.8) < 0.01
    assert abs(result.total["a"].estimate - 4 * (1 - 0.36) / 12.8) < 0.01
    assert abs(result.shapley["a"].estimate - 0.5) < 0.01 and abs(sum(np.asarray(result.shapley)) - 1) < 1e-12
    tables = [{"factors": ["a", "b"], "correlation": np.array([[1, 0.6], [0.6, 1]]), "measure": "normal"}]
    again = ap.analyse(lambda a, b: 2 * a + b, factors, dependence=tables, base_samples=4096)
    assert np.array_equal(np.asarray(again.shapley), np.asarray(result.shapley))
    assert "shapley" in result.tables()["study"][0]
    grouped = ap.analyse(
        lambda a, b, c: 2 * a + b + c,
        {"a": ap.Normal(0, 1, group="g"), "b": ap.Normal(0, 2, group="g"), "c": ap.Normal(0, 1)},
        base_samples=4096,
        indices_of="groups",
        shapley=True,
        measures=["delta", "r2_hsic"],
    )
    assert list(grouped.measures) == ["delta", "r2_hsic"]
    delta = grouped.measures["delta"]["c"]
    assert delta.low < delta.estimate < delta.high < grouped.measures["delta"]["a"].low
    assert list(grouped.shapley) == list(grouped.total) == ["g", "c"] and grouped.runs == 4096 * (2 + 2)
    assert abs(grouped.shapley["g"].estimate - 8 / 9) < 0.01 and abs(grouped.total["g"].estimate - 8 / 9) < 0.01
    rng = np.random.default_rng(1)
    first = rng.normal(size=100)
    measured = np.column_stack([first, first**2 + 0.1 * rng.normal(size=100)])
    joint = [{"factors": ["a", "b"], "measurements": measured}]
    tied = ap.analyse(lambda a, b: b, factors, dependence=joint, base_samples=1024)
    assert tied.first_order["a"].estimate < 0.3
    with pytest.raises(ap.StudyError, match="nearest"):
        three = factors | {"c": ap.Normal(0, 1)}
        ap.analyse(lambda a, b, c: a, three, dependence={("a", "b"): 0.9, ("b", "c"): 0.9, ("a", "c"): -0.9})


def test_a_function_that_draws_random_numbers_is_noticed(cube):
    draw = np.random.default_rng(1)
    result = ap.analyse(lambda x1, x2, x3: x1 + draw.random(np.shape(x1)), cube, base_samples=256)
    assert any("stochastic-models.md" in warning for warning in result.warnings)
    result = ap.analyse(lambda x1, x2, x3: x1 + x2, cube, base_samples=256)
    assert not any("stochastic-models.md" in warning for warning in result.warnings)


def assert_same(found, expected):
    """The same indices but for the last bits, which the number of effects moves."""
    np.testing.assert_allclose([tuple(found[name]) for name in expected], [tuple(of) for of in expected.values()], atol=1e-12)


@pytest.mark.parametrize("size", [{"base_samples": 256}, {"runs": 300}, {"accuracy": 0.02}])
def test_constants_cost_nothing_and_their_indices_are_0(size):
    def f(x):
        return x[:, 0] + 2 * x[:, 21] * x[:, 32] + x[:, 53] ** 2

    varying = (0, 21, 32, 53)
    factors = {f"x{j}": ap.Uniform(0, 1) if j in varying else ap.Constant(1) for j in range(60)}
    all_of_them = ap.analyse(f, factors, **size)
    alone = ap.analyse(lambda x: x[:, 0] + 2 * x[:, 1] * x[:, 2] + x[:, 3] ** 2, {f"x{j}": (0, 1) for j in varying}, **size)
    assert all_of_them.runs == alone.runs
    for kind in ("first_order", "total"):
        ours, expected = getattr(all_of_them, kind), getattr(alone, kind)
        assert ours.names == list(factors)
        assert_same(ours, expected)
        assert set(ours[name] for name in ours if name not in expected) == {ap.Index(0.0, 0.0, 0.0)}


def test_constants_cost_nothing_in_any_kind_of_index():
    lines = [f'factors.{name} = {{ distribution = "uniform", min = 0, max = 1, group = "g{name}" }}' for name in "ace"]
    formula = "model = 'expression'\noutputs.y = { formula = 'a * c + e' }"
    options = "[design]\nbase_samples = 256\n[analysis]\nsecond_order = true\nshapley = true\nestimators = ['azzini']\n"
    fewer = ap.Study.parse("\n".join([formula, *lines, options])).run()
    lines += [f"factors.{name} = {{ distribution = 'constant', value = 7 }}" for name in "bd"]
    result = ap.Study.parse("\n".join([formula, *sorted(lines), options])).run()
    assert result.runs == fewer.runs
    for kind in ("first_order", "total", "shapley", "second_order"):
        ours, expected = getattr(result, kind), getattr(fewer, kind)
        assert_same(ours, expected)
        assert {float(ours[name]) for name in ours if name not in expected} == {0.0}
    assert_same(result.groups(), fewer.groups())
