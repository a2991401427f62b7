import apportion as ap
import numpy as np
import pytest
from conftest import ishigami

PROBLEM = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}
EXACT = np.array([0.3139, 0.4424, 0.0]), np.array([0.5576, 0.4424, 0.2437])


@pytest.mark.parametrize("second_order", [True, False])
def test_a_script_for_salib_runs(second_order):
    x = ap.salib.sample(PROBLEM, 4096, calc_second_order=second_order)
    assert x.shape == (4096 * (8 if second_order else 5), 3)
    found = ap.salib.analyze(PROBLEM, ishigami(*x.T), calc_second_order=second_order)
    assert np.abs(found["S1"] - EXACT[0]).max() < 0.02 and np.abs(found["ST"] - EXACT[1]).max() < 0.02
    if second_order:
        assert abs(found["S2"][0, 2] - 0.2437) < 0.02 and np.isnan(found["S2"][2, 0])


def test_the_layout_and_the_estimates_are_those_of_salib():
    sobol = pytest.importorskip("SALib.analyze.sobol")
    for problem in (PROBLEM, {**PROBLEM, "groups": ["a", "b", "a"]}):
        x = ap.salib.sample(problem, 512)
        y = ishigami(*x.T)
        theirs = sobol.analyze(problem, y, print_to_console=False, seed=1)
        ours = ap.salib.analyze(problem, y)
        for key in ("S1", "ST", "S2"):
            assert np.allclose(ours[key], theirs[key], atol=1e-12, equal_nan=True), key
        frames, expected = ours.to_df(), theirs.to_df()
        for ours_frame, theirs_frame in zip(frames, expected):
            assert list(ours_frame.columns) == list(theirs_frame.columns)
            members = [row if isinstance(row, str) else tuple(map(str, row)) for row in theirs_frame.index]
            assert list(ours_frame.index) == members


def test_problems_become_factors():
    problem = {
        "names": ["a", "b", "c", "d", "e", "f"],
        "bounds": [[0, 1], [1, 10], [0, 2, 0.5], [1, 2], [-1, 1, 0, 2], [0, 0.5]],
        "dists": ["unif", "logunif", "triang", "norm", "truncnorm", "lognorm"],
        "groups": ["g", "g", "c", "d", "e", "f"],
    }
    result = ap.analyse(lambda a, b, c, d, e, f: a + b, ap.from_salib(problem), base_samples=256)
    assert abs(result.groups()["g"].estimate - 1) < 1e-6
    salib_sample = pytest.importorskip("SALib.sample.sobol")
    theirs = salib_sample.sample({**problem, "num_vars": 6, "groups": None}, 4096, calc_second_order=False, seed=1)
    ours = ap.salib.sample({**problem, "groups": None}, 4096, calc_second_order=False)
    assert np.allclose(
        np.quantile(ours, [0.1, 0.5, 0.9], axis=0), np.quantile(theirs, [0.1, 0.5, 0.9], axis=0), rtol=0.02, atol=0.02
    )
    with pytest.raises(ap.StudyError, match="unif"):
        ap.from_salib({"names": ["a"], "bounds": [[0, 1]], "dists": ["cauchy"]})
