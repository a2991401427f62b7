"""`apportion analyze --layout salib` against SALib's own analysis of the same outputs.

    python tests/peers/salib_layout.py PROGRAM

SALib makes the points, its test functions are evaluated here, and PROGRAM (target/release/apportion) reads what a user
would write down: CSV as NumPy and pandas print it, or NPY. Ends with code 1 if S1, ST or S2 differ by more than the tolerance.
"""

import json
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np
from SALib.analyze import sobol as analyze
from SALib.sample import saltelli
from SALib.sample import sobol as sample
from SALib.test_functions import Ishigami, Sobol_G

from check import Checks

ISHIGAMI = {"num_vars": 3, "names": ["x1", "x2", "x3"], "bounds": [[-np.pi, np.pi]] * 3}
SOBOL_G = {"num_vars": 8, "names": [f"x{j}" for j in range(1, 9)], "bounds": [[0, 1]] * 8}
GROUPS = {**SOBOL_G, "groups": ["first", "rest", "rest", "rest", "first", "last", "last", "last"]}
CASES = {
    "ishigami": (ISHIGAMI, Ishigami.evaluate),
    "sobol-g": (SOBOL_G, Sobol_G.evaluate),
    "sobol-g in groups": (GROUPS, Sobol_G.evaluate),
    "sobol-g + 1000": (SOBOL_G, lambda x: Sobol_G.evaluate(x) + 1000),
}


def points(sampler, problem, second_order):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # saltelli is deprecated, and still what many have.
        if sampler == "sobol":
            return sample.sample(problem, 512, calc_second_order=second_order, seed=7)
        return saltelli.sample(problem, 512, calc_second_order=second_order)


def written(folder, form, x, y, problem):
    """The file that a user would have, and the options that it needs."""
    if form == "npy":
        path = folder / "outputs.npy"
        np.save(path, y)
        return path, []
    path = folder / "table.csv"
    header = ",".join([*problem["names"], "y"])
    # 17 digits: the same bits.
    np.savetxt(path, np.column_stack([x, y]), fmt="%.17g", delimiter=",", header=header, comments="")
    return path, ["--outputs", "y"]


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: salib_layout.py PROGRAM")
    program, checks = Path(sys.argv[1]).resolve(), Checks()
    for name, (problem, function) in CASES.items():
        for sampler in ("sobol", "saltelli"):
            for second_order in (True, False):
                x = points(sampler, problem, second_order)
                y = function(x)
                theirs = analyze.analyze(problem, y, calc_second_order=second_order, num_resamples=2, seed=1)
                for form in ("csv", "npy"):
                    with tempfile.TemporaryDirectory() as folder:
                        folder = Path(folder)
                        (folder / "problem.json").write_text(json.dumps(problem))
                        path, options = written(folder, form, x, y, problem)
                        options += ["--second-order" if second_order else "--first-order-only"] if form == "npy" else []
                        command = [program, "analyze", path, "--layout", "salib", "--problem", folder / "problem.json"]
                        command += ["--resamples", "0", "--out", folder / "out", *options]
                        subprocess.run(command, check=True, capture_output=True)
                        ours = json.loads((folder / "out" / f"{path.stem}.json").read_text())["outputs"][0]
                    what = f"{name}, {sampler}, {'with' if second_order else 'without'} second order, {form}"
                    for key, index in (("first_order", "S1"), ("total", "ST")):
                        checks.close(f"{what}: {index}", [i[key]["estimate"] for i in ours["indices"]], theirs[index])
                    if second_order:
                        pairs = theirs["S2"][np.triu_indices(len(theirs["S1"]), 1)]
                        checks.close(f"{what}: S2", [p["index"]["estimate"] for p in ours["second_order"]], pairs)
    print(f"{checks.count} comparisons, {checks.failed} failed")
    sys.exit(1 if checks.failed else 0)


if __name__ == "__main__":
    main()
