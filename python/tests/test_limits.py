"""Wrong sizes, wrong input and signals: what is said, and when."""

import inspect
import json
import os
import re
import subprocess
import sys
import time
import typing

import apportion as ap
import numpy as np
import pytest
import typed_script

from apportion import _keys
from apportion.salib.analyze import sobol
from apportion.salib.sample import sobol as sobol_sample

UNIT = {"x1": (0, 1), "x2": (0, 1)}
PROBLEM = {"names": ["a"], "bounds": [[0, 1]]}


def add(x1, x2):
    return x1 + x2


def test_points_beyond_memory_are_refused():
    study = ap.Study(None, UNIT, base_samples=2**34)
    with pytest.raises(MemoryError, match="68719476736 points of 2 factors need 1100 GB"):
        study.sample()


def test_invalid_numbers_are_refused():
    study = ap.Study(add, UNIT, base_samples=16)
    y = list(range(8))
    cases = [
        (lambda: study.run(threads=-1), "threads must be a whole number from 0 to 1024, not -1"),
        (lambda: study.run(threads=1025), "threads must"),
        (lambda: study.run(threads="4"), "threads must"),
        (lambda: study.screen(-1), "trajectories must"),
        (lambda: study.screen(4, levels=-2), "levels must"),
        (lambda: study.screen(4, seed=-1), r"seed must be a whole number from 0 to 2\*\*64 - 1"),
        (lambda: study.sweep("x1", points=-1), "points must"),
        (lambda: study.sweep("x1", points=2**40), "points must"),
        (lambda: ap.given_data(np.ones((30, 1)), np.ones(30), seed=-1), "seed must"),
        (lambda: sobol.analyze(PROBLEM, y, num_resamples=2**40), "num_resamples must be a whole number from 0 to 1000000"),
        (lambda: sobol.analyze(PROBLEM, y, num_resamples=-1), "num_resamples must"),
        (lambda: sobol.analyze(PROBLEM, y, seed=-1), "seed must"),
        (lambda: sobol_sample.sample(PROBLEM, -8), "N must"),
        (lambda: sobol_sample.sample(PROBLEM, 8, seed=-1), "seed must"),
        (lambda: study.run(executor=3), r"executor=3: expected an executor of concurrent\.futures"),
    ]
    for wrong, words in cases:
        with pytest.raises(ap.StudyError, match=words):
            wrong()


def test_unknown_keywords_are_errors_whatever_their_value():
    for keywords, words in [
        ({"sed": 0}, "unknown keyword sed: did you mean seed"),
        ({"n_jobs": 0}, "unknown keyword n_jobs: did you mean threads, which run"),
        ({"second_ordr": False}, "did you mean second_order"),
        ({"target": 0.01}, "did you mean accuracy"),
        ({"nonsense_of_mine": None}, "expected one of "),
        ({"x1": (0, 1)}, "factors come as a mapping"),
    ]:
        with pytest.raises(ap.StudyError, match=words):
            ap.Study(add, UNIT, **keywords)
        if "n_jobs" not in keywords:
            with pytest.raises(ap.StudyError, match=words):
                ap.analyse(add, UNIT, **keywords)


def test_errors_name_the_argument():
    for keywords, words in [
        ({"sampler": "halton"}, "^unknown sampler `halton`; known: sobol, random, latin-hypercube$"),
        ({"base_samples": -4}, "^base_samples = -4: invalid value"),
        ({"accuracy": -1}, "^`accuracy` must be a finite number above 0, not -1$"),
    ]:
        with pytest.raises(ap.StudyError, match=words):
            ap.Study(add, UNIT, **keywords)


def test_keywords_are_in_the_signature_and_a_generator_is_a_seed():
    of_study, of_call = inspect.signature(ap.Study).parameters, inspect.signature(ap.analyse).parameters
    assert {"base_samples", "second_order", "measures"} < set(of_study) < set(of_call) and "journal" in of_call
    made = [ap.Study(None, UNIT, base_samples=16, seed=np.random.default_rng(3)).sample() for _ in range(2)]
    assert np.array_equal(*made)
    assert not np.array_equal(made[0], ap.Study(None, UNIT, base_samples=16).sample())


def test_types_are_the_choices_of_the_engine(program):
    schema = json.loads(subprocess.run([program, "schema", "study"], capture_output=True, text=True, check=True).stdout)
    for section, options in (("DesignSection", _keys.DesignOptions), ("AnalysisSection", _keys.AnalysisOptions)):
        keys = schema["definitions"][section]["properties"]
        assert set(keys) == set(options.__annotations__)
        for key, of in keys.items():
            names = of.get("enum") or of.get("items", {}).get("enum") or []
            assert set(re.findall("'(.*?)'", str(typing.get_type_hints(options)[key]))) == set(names), key


def test_the_script_of_a_user_has_types():
    # That its types are right is checked by mypy, in the recipe.
    typed_script.main()


def test_both_spellings_of_vectorised_are_honoured():
    seen = []
    for spelling in ("vectorised", "vectorized"):
        ap.analyse(lambda x1, x2: seen.append(np.ndim(x1)) or x1 + x2, UNIT, base_samples=16, **{spelling: False})
    assert set(seen) == {0}


def test_only_one_key_sets_the_length_of_a_run():
    assert ap.Study(add, UNIT, runs=100).runs <= 100
    with pytest.raises(ap.StudyError, match="`base_samples` must be the only key"):
        ap.Study(add, UNIT, runs=100, base_samples=16)
    with pytest.raises(ap.StudyError, match="`max_time` must be a time above 0"):
        ap.Study(add, UNIT, accuracy=0.01, max_time=0)


def test_invalid_factors_are_reported_with_an_example():
    for factors, words in [
        ({1: (0, 1)}, "the name 1 is not a text: expected a name such as '1'"),
        ([(0, 1), (0, 1)], "is not a mapping from names to distributions"),
        ("x1", "is not a mapping from names"),
    ]:
        with pytest.raises(ap.StudyError, match=words):
            ap.Study(None, factors)
    with pytest.raises(ap.StudyError, match="dependence=0.5: expected correlations by pairs"):
        ap.Study(None, UNIT, dependence=0.5)
    # A bound may be an array of no dimensions.
    study = ap.Study(None, {"x": (np.array(0), np.array(2.0)), "z": (0, 1)}, base_samples=16)
    assert 1.5 < study.sample()[:, 0].max() <= 2.0


def test_tables_that_cannot_be_used_name_the_column():
    pandas = pytest.importorskip("pandas")
    rng = np.random.default_rng(1)
    x = rng.uniform(size=(40, 2))
    y = x[:, 0]
    frame = pandas.DataFrame(x, columns=["a", "b"])
    for inputs, outputs, words in [
        (frame.assign(c=["red", *range(39)]), y, "the inputs have in the column 'c'.*expected real numbers"),
        (pandas.DataFrame(x, columns=["a", "a"]), y, "two columns with the name 'a'"),
        (frame[:0], y[:0], "the inputs have no rows"),
        (frame[[]], y, "the inputs have no rows"),
        ({}, y, "the inputs have no rows"),
        (3.0, y, "the inputs have no rows"),
        ({"a": x[:, 0], "b": x[:-1, 1]}, y, "40 in 'a', 39 in 'b'"),
        ({"a": x}, y, r"an array of shape \(40, 2\) in 'a'"),
        (x, "red", "the outputs are 'red'"),
        # What is masked or missing is NaN, which a table of rows cannot have.
        (np.ma.masked_where(x > 0.9, x), y, "x1"),
        (frame.assign(a=frame.a.astype("Float64").mask(frame.a > 0.9)), y, "`a`"),
        (x, np.full(40, np.nan), "`y`"),
    ]:
        with pytest.raises(ap.StudyError, match=words):
            ap.given_data(inputs, outputs)
    numbered = ap.given_data(pandas.DataFrame(x), y)
    assert numbered.to_json() == ap.given_data(x, y).to_json()


SIGNALLED = """
import signal, sys, time
import numpy as np, apportion as ap
signal.signal(signal.SIGINT, signal.default_int_handler)
x = np.random.default_rng(1).uniform(size=(200000, 6))
print("begun", flush=True)
try:
    ap.given_data(x, x[:, 0], measures=True)
except KeyboardInterrupt:
    print("heard", flush=True)
    sys.exit(7)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of the keyboard are others there")
def test_given_data_can_be_interrupted():
    process = subprocess.Popen([sys.executable, "-c", SIGNALLED], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"begun\n"
    time.sleep(1.0)
    begun = time.monotonic()
    process.send_signal(2)
    assert process.stdout.readline() == b"heard\n"
    assert time.monotonic() - begun < 3
    # The process ends, although the computation has not.
    assert process.wait(timeout=20) == 7


_NESTED = """
import apportion as ap
import numpy as np

x = {"x1": (0, 1), "x2": (0, 1)}

def inner(a):
    total = ap.analyse(lambda x1, x2: x1 + a * x2, x, base_samples=64, surrogate="off").total["x2"]
    rows = np.random.default_rng(0).random((30, 2))
    return float(total), len(ap.given_data(rows, rows[:, 0] ** 2).lead)

outer = ap.Study(inner, {"a": (1, 2)}, outputs=["total", "rows"], vectorised=False, base_samples=8)
assert outer.run(executor=executor).runs == 16
"""


@pytest.mark.parametrize("executor", ["None", "__import__('concurrent.futures').futures.ThreadPoolExecutor(2)"])
def test_a_function_may_run_an_analysis_of_its_own(executor):
    # In a process of its own: a run that waits for itself cannot be interrupted.
    script = f"executor = {executor}\n{_NESTED}"
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", script], timeout=120, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
