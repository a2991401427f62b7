"""What functions may do, hold and return."""

import dataclasses
import decimal
import functools
import os
import subprocess
import sys
import typing

import apportion as ap
import numpy as np
import pytest

UNIT = {"x1": (0, 1), "x2": (0, 1)}
PROBED = [[0.5, 0.25], [0.75, 0.5]]


def linear(x1, x2, k=1.0):
    return x1 + k * x2


class Linear:
    def __init__(self, k):
        self.k = k
        self.calls = 0

    def __call__(self, x1, x2):
        self.calls += 1
        return x1 + self.k * x2

    def method(self, x1, x2):
        self.calls += 1
        return x1 + self.k * x2


def with_closure(k):
    def f(x1, x2):
        return x1 + k * x2

    return f


def with_keyword(k):
    def f(x1, x2, *, c=k):
        return x1 + c * x2

    return f


def with_array(k):
    def f(x1, x2, c=np.array([0.0, k])):
        return x1 + c[1] * x2

    return f


def with_decorator(k):
    def scaled(f):
        @functools.wraps(f)
        def inner(x1, x2):
            return f(x1, k * x2)

        return inner

    return scaled(linear)


WAYS = {
    "partial keyword": lambda k: functools.partial(linear, k=k),
    "partial argument": lambda k: functools.partial(lambda c, x1, x2: x1 + c[0] * x2, np.array([k])),
    "closure": with_closure,
    "keyword default": with_keyword,
    "array default": with_array,
    "decorator": with_decorator,
    "cache": lambda k: functools.lru_cache(with_keyword(k)),
}
# What may change unseen.
OTHERS = {
    "instance": Linear,
    "method": lambda k: Linear(k).method,
    "partial method": lambda k: functools.partial(Linear(k).method),
    "nested": lambda k: with_nested((Linear(k),)),
    "list": lambda k: with_nested([with_keyword(k)]),
}


def with_nested(held):
    return lambda x1, x2: held[0](x1, x2)


def total(function, journal, **version):
    options = {"base_samples": 16, "vectorised": False, "call": "columns", "journal": journal, **version}
    return dict(ap.analyse(function, UNIT, **options).total)


@pytest.mark.parametrize("way", [*WAYS, *OTHERS])
def test_a_journal_tells_a_function_from_another(way, tmp_path):
    def of(k, journal):
        version = {"version": str(k)} if way in OTHERS else {}
        return total({**WAYS, **OTHERS}[way](k), tmp_path / journal, **version)

    made = {k: of(k, f"{k}.journal") for k in (1.0, 5.0)}
    assert of(1.0, "1.0.journal") == made[1.0] and len(list(tmp_path.iterdir())) == 2
    assert of(1.0, "5.0.journal") == made[1.0] != made[5.0]
    # The runs of the other one are kept aside.
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize("way", OTHERS)
def test_a_journal_refuses_functions_that_change_unseen_without_a_version(way, tmp_path):
    with pytest.raises(ap.StudyError, match="version="):
        total(OTHERS[way](1.0), tmp_path / "f.journal")
    assert not list(tmp_path.iterdir())


def test_a_version_stands_for_the_code(tmp_path):
    one = total(lambda x1, x2: x1 + x2, tmp_path / "f.journal", version="1")
    other = lambda x1, x2: x1 + 3 * x2  # noqa: E731
    assert total(other, tmp_path / "f.journal", version="1") == one != total(other, tmp_path / "f.journal", version="2")


def test_a_journal_knows_the_distributions_of_scipy(tmp_path):
    stats = pytest.importorskip("scipy.stats")
    histograms = [stats.rv_histogram(np.histogram([1.0, 2.0, shift], bins=4))() for shift in (5.0, 9.0)]
    for name, pair in {"skew": (stats.skewnorm(1), stats.skewnorm(1, scale=20)), "data": histograms}.items():
        means = []
        for law in pair:
            result = ap.analyse(linear, {"x1": (0, 1), "x2": law}, base_samples=16, vectorised=False, journal=tmp_path / name)
            means.append(result["y"].mean)
            alone = ap.analyse(linear, {"x1": (0, 1), "x2": law}, base_samples=16, vectorised=False)
            assert alone["y"].mean == means[-1]
        assert means[0] != means[1]


@pytest.mark.parametrize("style", ["columns", "matrix"])
def test_a_function_may_change_its_arguments(style):
    def good(x1, x2):
        if np.any(x2 > 0.95):
            raise ValueError("too large")
        return (x1 + 1) ** 2 + x2

    def in_place(*arguments):
        x1, x2 = arguments if style == "columns" else arguments[0].T
        is_bad = np.any(x2 > 0.95)
        x1 += 1
        if is_bad:
            raise ValueError("too large")
        return x1**2 + x2

    one, two = (ap.analyse(f, UNIT, base_samples=64, call=call) for f, call in ((good, "columns"), (in_place, style)))
    assert one["y"].runs_failed == two["y"].runs_failed > 0
    assert dict(one.total) == dict(two.total) and one["y"].mean == two["y"].mean


def test_points_of_the_user_are_in_units_whatever_the_distribution():
    stats = pytest.importorskip("scipy.stats")
    study = ap.Study(linear, {"x1": stats.skewnorm(3, loc=10), "x2": (0, 1)}, base_samples=16)
    points = study.sample()
    assert points[:, 0].min() > 9
    assert np.array_equal(study.evaluate(points)[:, 0], linear(*points.T))


def masked(x1, x2):
    return np.ma.masked_where(np.asarray(x1) > 0.95, x1 + x2)


def missing(x1, x2):
    return np.where(np.asarray(x1) > 0.95, np.nan, x1 + x2)


def test_masked_and_missing_values_fail_their_rows():
    pandas = pytest.importorskip("pandas")
    expected = ap.analyse(missing, UNIT, base_samples=64)

    def with_na(x1, x2):
        return pandas.Series(x1 + x2, dtype="Float64").mask(x1 > 0.95)

    for f in (masked, lambda x1, x2: {"y": masked(x1, x2)}, lambda x1, x2: (masked(x1, x2),), with_na):
        result = ap.analyse(f, UNIT, base_samples=64)
        assert result["y"].runs_failed == expected["y"].runs_failed > 0 and dict(result.total) == dict(expected.total)
    one_by_one = ap.analyse(lambda x1, x2: np.ma.masked if x1 > 0.95 else x1 + x2, UNIT, base_samples=64, vectorised=False)
    assert dict(one_by_one.total) == dict(expected.total)
    study = ap.Study(None, UNIT, base_samples=64)
    told = study.analyse(masked(*study.sample().T))
    assert told["y"].runs_failed == expected["y"].runs_failed and dict(told.total) == dict(expected.total)


def test_none_fails_one_row_of_a_function_of_one_row():
    result = ap.analyse(lambda x1, x2: None if x1 > 0.95 else x1 + x2, UNIT, base_samples=64, vectorised=False)
    expected = ap.analyse(missing, UNIT, base_samples=64)
    assert dict(result.total) == dict(expected.total)
    assert result["y"].record["failures"][0]["reason"] == "the function returned None"
    with pytest.raises(ap.AnswerError, match="returned None for 3 rows"):
        ap.analyse(lambda x1, x2: None, UNIT, base_samples=16)
    with pytest.raises(ap.AnswerError, match="the function returned None"):
        ap.analyse(lambda x1, x2: None, UNIT, base_samples=16, vectorised=False)


def test_a_row_that_fails_first_is_a_row_that_fails():
    calls = []

    def first_fails(x1, x2):
        calls.append((x1, x2))
        if len(calls) == 1:
            raise RuntimeError("the simulator has crashed")
        return x1 + x2

    result = ap.analyse(first_fails, UNIT, base_samples=64, vectorised=False)
    assert result["y"].runs_failed == 1
    assert result["y"].record["failures"][0]["reason"] == "RuntimeError: the simulator has crashed"
    # Rows of the trial are not asked again; at the end some rows are, to see whether they have the same answer.
    assert result.runs <= len(calls) <= 1.01 * result.runs

    study = ap.Study(changed := Linear(1.0), UNIT, base_samples=16, vectorised=False)
    study.run()
    changed.k = 5.0
    assert dict(study.run().total) == dict(ap.analyse(Linear(5.0), UNIT, base_samples=16, vectorised=False).total)

    def all_fail(x1, x2):
        calls.append(1)
        raise RuntimeError(f"call {len(calls)}")

    calls.clear()
    with pytest.raises(RuntimeError, match="^call 1$"):
        ap.analyse(all_fail, UNIT, base_samples=64, vectorised=False)

    def in_blocks(x1, x2):
        calls.append(1)
        if len(calls) == 1:
            raise RuntimeError("not yet")
        return x1 + x2

    calls.clear()
    assert ap.analyse(in_blocks, UNIT, base_samples=64)["y"].runs_failed == 0


def test_outputs_by_name_come_in_any_order():
    pandas = pytest.importorskip("pandas")

    def swapping(x1, x2):
        return {"a": x1, "b": x2} if x1 > 0.5 else {"b": x2, "a": x1}

    result = ap.analyse(swapping, UNIT, base_samples=64, vectorised=False)
    assert result["a"].total["x1"].estimate > 0.99 and result["b"].total["x2"].estimate > 0.99
    framed = ap.analyse(lambda x1, x2: pandas.DataFrame({"b": x2, "a": x1}), UNIT, outputs=["a", "b"], base_samples=64)
    assert framed["a"].mean == result["a"].mean and framed["b"].mean == result["b"].mean
    numbered = ap.analyse(lambda x1, x2: pandas.DataFrame(np.column_stack([x1, x2])), UNIT, base_samples=64)
    assert list(numbered.outputs) == ["y1", "y2"]
    with pytest.raises(ap.AnswerError, match=r"\['a', 'c'\], and \['a', 'b'\] were expected"):
        ap.analyse(lambda x1, x2: {"a": x1, "c": x2}, UNIT, outputs=["a", "b"], base_samples=64)
    polars = pytest.importorskip("polars")
    assert list(ap.analyse(lambda x1, x2: polars.DataFrame({"a": x1}), UNIT, base_samples=64).outputs) == ["a"]


def test_points_and_outputs_go_by_the_names_of_their_columns():
    pandas = pytest.importorskip("pandas")
    study = ap.Study(None, UNIT, outputs=["a", "b"], base_samples=16)
    x1, x2 = study.sample().T
    expected = study.analyse(np.column_stack([x1, x2]))
    for table in ({"b": x2, "a": x1}, pandas.DataFrame({"b": x2, "a": x1}), pandas.DataFrame(np.column_stack([x1, x2]))):
        assert study.analyse(table).to_dict()["outputs"] == expected.to_dict()["outputs"]
    for wrong, words in [
        ({"a": x1}, "without b: expected the columns a, b"),
        ({"a": x1, "b": x2, "c": x1}, "with c"),
        (pandas.DataFrame(np.column_stack([x1, x2]), columns=["a", "a"]), "two columns with the name 'a'"),
        ({"a": x1, "b": x2[:-1]}, "output b has the shape"),
        ({}, "no columns"),
        (np.ones((64, 3)), r"outputs of shape \(64, 3\): expected \(64, 2\), of a, b"),
        (3.0, "expected 64 rows"),
        (np.empty((0, 2)), "expected 64 rows"),
        ("abc", "expected real numbers"),
        (np.arange(64) * 1j, "expected real numbers"),
    ]:
        with pytest.raises(ap.StudyError, match=words):
            study.analyse(wrong)
    model = ap.Study(lambda x1, x2: x1 - 2 * x2, UNIT)
    engine = ap.Study("ishigami")
    frame = pandas.DataFrame({"x3": [0.0], "x2": [np.pi / 2], "x1": [0.0]})
    assert engine.evaluate(frame) == pytest.approx(7.0)
    assert model.evaluate(pandas.DataFrame({"x2": [1.0], "x1": [5.0]})) == 3.0
    assert model.evaluate(pandas.DataFrame([[5.0, 1.0]])) == 3.0 and model.evaluate([5.0, 1.0]) == 3.0
    for wrong, words in [({"x2": [1.0]}, "without x1"), ([[1.0, 2.0, 3.0]], r"\(1, 3\)"), ("abc", "real numbers")]:
        with pytest.raises(ap.StudyError, match=words):
            model.evaluate(wrong)


def test_an_ambiguous_signature_needs_call():
    ab = {"a": (0, 1), "b": (0, 1)}
    for function in (lambda x, scale=1.0: x, lambda x=0, y=0: x, lambda b, c: b):
        with pytest.raises(ap.StudyError, match='call="columns"'):
            ap.Study(function, ab)
    whole = ap.analyse(lambda x, scale=2.0: scale * x[:, 0], ab, call="matrix", base_samples=64)
    assert whole.total["a"].estimate > 0.99
    assert ap.analyse(lambda x, scale=1.0: x * scale, ab, call="columns", base_samples=64).total["b"].estimate > 0.5
    # These can be told.
    for function in (
        lambda p, q, scale=1.0: p,
        lambda b, a: a,
        lambda a, b=2.0: a,
        lambda a, b, verbose=False: a,
        lambda x, k=1.0, m=2.0: x[:, 0],
        lambda x: x[:, 0],
        lambda a, other: a,
    ):
        assert ap.analyse(function, ab, base_samples=64).total["a"].estimate > 0.99


def test_a_function_of_numbers_that_gets_arrays_has_a_hint():
    import math

    three = UNIT | {"x3": (0, 1)}
    for function, factors in [
        (lambda x1, x2: math.sin(x1), UNIT),
        (lambda x1, x2: x1 if x1 > x2 else x2, UNIT),
        (lambda x1, x2: [1, 2, 3][x1], UNIT),
        (lambda x: x[0] + x[1] + x[2] + x[5], three),
    ]:
        with pytest.raises(ap.StudyError, match="vectorised=False"):
            ap.analyse(function, factors, base_samples=16)
    for function, factors in [(lambda x: x[0] + 2 * x[1], UNIT), (lambda x: x[0] + x[1], three)]:
        with pytest.raises(ap.AnswerError, match="vectorised=False"):
            ap.analyse(function, factors, base_samples=16)


def test_numbers_are_floats_whatever_the_factor():
    kinds = []

    def f(n, x):
        kinds.append(type(n))
        return n * x

    ap.analyse(f, {"n": ap.Integer(0, 2), "x": (0, 1)}, base_samples=16, vectorised=False)
    assert set(kinds) == {float}


HELD = """
import dataclasses
import decimal
import functools
import numpy as np
import apportion as ap

def kept(where=frozenset({"here", "there"})):
    def f(x1, x2, *, words={"p", "q", "r"} and frozenset({"p", "q", "r"}), table=(np.arange(3), np.float32(3), b"1")):
        return x1 if x2 in {"left", "right", "middle"} or held else f(x1, x2)
    held = np.sin, where, functools
    return f

for f in (kept(), functools.partial(kept(), words=None), functools.lru_cache(kept())):
    print(ap.Study(f, {"x1": (0, 1), "x2": (0, 1)}, call="columns")._call.identity(None))
"""


def test_identities_are_the_same_in_every_process():
    found = set()
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run([sys.executable, "-c", HELD], capture_output=True, text=True, env=environment, timeout=120)
        assert done.returncode == 0, done.stderr
        found.add(done.stdout)
    assert len(found) == 1 and len(set(found.pop().split("\n"))) == 4


class Pair(typing.NamedTuple):
    u: float
    v: float


@dataclasses.dataclass
class Both:
    u: float
    v: float


def test_names_of_what_a_function_returns():
    pandas = pytest.importorskip("pandas")
    options = {"vectorised": False, "base_samples": 16}
    for made in (Pair, Both, lambda u, v: pandas.Series({"u": u, "v": v}), lambda u, v: {"u": decimal.Decimal(u), "v": v}):
        result = ap.analyse(lambda x1, x2: made(x1, x2), UNIT, **options)
        assert list(result) == ["u", "v"] and result["u"].total["x2"].estimate == 0
    many = ap.analyse(lambda x1, x2: Both(x1, x2), UNIT, base_samples=16)
    assert many["v"].total["x2"].estimate == 1


def test_a_number_is_a_fixed_factor():
    result = ap.analyse(lambda x1, x2, k: x1 + k * x2, {**UNIT, "k": 2.0}, base_samples=64)
    assert result.runs == 64 * 4 and result.total["k"] == ap.Index(0.0, 0.0, 0.0)
    assert abs(result.total["x2"].estimate - 0.8) < 1e-6


def test_matrices_are_correlations():
    pandas = pytest.importorskip("pandas")
    rows = np.random.default_rng(1).normal(size=(100, 3)) @ [[1, 1, 0], [0, 1, 0], [0, 0, 1]]
    frame = pandas.DataFrame(rows, columns=["a", "b", "c"])
    factors = {name: ap.Normal(0, 1) for name in "abc"}

    def total(dependence):
        return dict(ap.analyse(lambda a, b, c: a + b - c, factors, dependence=dependence, base_samples=64).total)

    matrix = np.corrcoef(rows.T)
    pairs = total({("a", "b"): matrix[0, 1], ("a", "c"): matrix[0, 2], ("b", "c"): matrix[1, 2]})
    for given in (matrix, frame.corr(), frame[["c", "a", "b"]].corr()):
        np.testing.assert_allclose([tuple(of) for of in total(given).values()], [tuple(of) for of in pairs.values()], atol=1e-9)
    with pytest.raises(ap.StudyError):
        total(rows)


def test_given_data_leaves_out_failed_rows_and_codes_texts():
    pandas = pytest.importorskip("pandas")
    rng = np.random.default_rng(1)
    table = pandas.DataFrame({"x": rng.random(200), "kind": rng.choice(["red", "green", "blue"], 200)})
    y = table["x"] + 2.0 * (table["kind"] == "red")
    whole = ap.given_data(table[2:], y[2:])
    y[:2] = np.nan
    with pytest.warns(ap.SensitivityWarning, match="^2 of 200 rows"):
        found = ap.given_data(table, y)
    assert found.to_dict()["outputs"] == whole.to_dict()["outputs"]
    coded = table.assign(kind=table["kind"].map({"blue": 0, "green": 1, "red": 2}))
    assert found.to_dict()["outputs"] == ap.given_data(coded[2:], y[2:]).to_dict()["outputs"]
    with pytest.raises(ap.StudyError):
        ap.given_data({"x": [1.0, "a", 2.0]}, [1.0, 2.0, 3.0])


def test_a_factor_may_be_called_y():
    factors = {"x": (0, 1), "y": (0, 1)}
    assert list(ap.analyse(lambda x, y: x + y, factors, base_samples=16)) == ["output"]
    study = ap.Study(None, factors, base_samples=16)
    assert list(study.analyse(study.sample().sum(axis=1))) == ["output"] and list(study.analyse({"z": np.arange(64.0)})) == ["z"]
