import multiprocessing
import shutil
import subprocess
import sys
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import apportion as ap
import numpy as np
import pytest
from conftest import polynomial
from functions_elsewhere import DiesOnce, row, slow_row

from apportion import _progress

HERE = Path(__file__).resolve().parent


def expected(cube, base_samples):
    return dict(ap.analyse(polynomial, cube, base_samples=base_samples, vectorised=False).total)


def test_processes_and_threads_give_the_same_bits(cube):
    here = expected(cube, 64)
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        assert dict(ap.analyse(polynomial, cube, base_samples=64, executor=executor).total) == here
        assert dict(ap.analyse(row, cube, base_samples=64, vectorised=False, executor=executor).total) == here
    with ThreadPoolExecutor(3) as executor:
        assert dict(ap.analyse(polynomial, cube, base_samples=64, executor=executor, in_flight=5).total) == here


def test_functions_without_a_module_are_sent(cube):
    pytest.importorskip("cloudpickle")
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        result = ap.analyse(lambda x1, x2, x3: x1 + 2 * x2, cube, base_samples=64, executor=executor)
    assert abs(result.total["x2"].estimate - 0.8) < 1e-6


def test_a_broken_pool_stops_the_run_and_its_journal_resumes(cube, tmp_path):
    journal = tmp_path / "f.journal"
    function = DiesOnce(str(tmp_path / "mark"))
    options = {"base_samples": 64, "outputs": ["y"], "call": "columns", "version": "1"}
    study = ap.Study(function, cube, **options)
    study._tried = {}
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        with pytest.raises(ap.RunError, match="the executor failed"):
            study.run(executor=executor, journal=journal)
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        assert dict(study.run(executor=executor, journal=journal).total) == expected(cube, 64)


def test_dask_loses_a_worker_and_no_row(cube, tmp_path):
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(2, threads_per_worker=1, processes=True, dashboard_address=None)
    try:
        client = distributed.Client(cluster)
        client.run(lambda: sys.path.insert(0, str(HERE)))
        study = ap.Study(DiesOnce(str(tmp_path / "mark")), cube, base_samples=64, outputs=["y"], call="columns")
        study._tried = {}
        assert dict(study.run(executor=client.get_executor()).total) == expected(cube, 64)
        assert (tmp_path / "mark").exists()
        client.close()
    finally:
        cluster.close()


def test_mpi4py_futures(cube, tmp_path):
    pytest.importorskip("mpi4py")
    if not shutil.which("mpirun"):
        pytest.skip("mpirun is not here")
    script = tmp_path / "ranks.py"
    script.write_text(
        f"import sys; sys.path.insert(0, {str(HERE)!r})\n"
        "from mpi4py.futures import MPIPoolExecutor\nimport apportion as ap\nfrom functions_elsewhere import slow_row\n"
        "if __name__ == '__main__':\n    with MPIPoolExecutor() as executor:\n"
        "        factors = {f'x{k}': (-3.141592653589793, 3.141592653589793) for k in (1, 2, 3)}\n"
        "        result = ap.analyse(slow_row, factors, base_samples=64, vectorised=False, executor=executor)\n"
        "    print(*result.total['x1'])\n"
    )
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "3", sys.executable, "-m", "mpi4py.futures", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    found = tuple(map(float, done.stdout.split()))
    assert found == tuple(expected(cube, 64)["x1"])


def test_slow_rows_one_at_a_time(cube):
    assert dict(ap.analyse(slow_row, cube, base_samples=16, vectorised=False).total)


MAIN = """
import functools, multiprocessing
from concurrent.futures import Future, ProcessPoolExecutor
import apportion as ap, numpy as np

def model(x1, x2, k=1.0):
    return x1 + k * x2

def decorated(f):
    @functools.wraps(f)
    def inner(x1, x2):
        return f(x1, x2, 2.0)
    return inner

class Model:
    def __call__(self, x1, x2):
        return model(x1, x2, 2.0)

if __name__ == "__main__":
    factors = {"x1": (0, 1), "x2": (0, 1)}
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        for f in (functools.partial(model, k=2.0), np.vectorize(lambda x1, x2: x1 + 2 * x2), np.vectorize(functools.partial(model, k=2.0)),
                  decorated(model), Model(), Model().__call__):
            found = ap.analyse(f, factors, base_samples=16, executor=executor, call="columns")
            print(round(found.total["x2"].estimate, 6))
"""


def test_functions_of_a_script_reach_new_processes(tmp_path):
    pytest.importorskip("cloudpickle")
    # The workers do not find the functions by themselves: they run another file of that name.
    script = tmp_path / "script.py"
    script.write_text(f"import sys\ncode = {MAIN!r}\nif __name__ == '__main__':\n    exec(code)\n")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["0.8"] * 6


def test_a_closed_executor_is_not_used_again(cube):
    executor = ProcessPoolExecutor(1)
    executor.shutdown()
    with pytest.raises(ap.RunError, match="over a block of .* rows: it accepts no more work: cannot schedule"):
        ap.analyse(polynomial, cube, base_samples=64, executor=executor)


def test_functions_that_cannot_be_sent_to_another_process_are_reported(cube):
    import threading

    lock = threading.Lock()

    def locked(x1, x2, x3):
        with lock:
            return polynomial(x1, x2, x3)

    with ProcessPoolExecutor(1) as executor:
        with pytest.raises(ap.RunError, match="cannot be sent to another process .*lock"):
            ap.analyse(locked, cube, base_samples=64, executor=executor)
    with ThreadPoolExecutor(2) as executor:
        assert dict(ap.analyse(locked, cube, base_samples=64, executor=executor).total) == dict(
            ap.analyse(polynomial, cube, base_samples=64).total
        )


class Unaligned:
    """Answers with arrays as they may come out of a message: one byte beside where numbers lie."""

    def submit(self, function, *arguments):
        values, failures = function(*arguments)
        buffer = np.zeros(values.nbytes + 1, dtype=np.uint8)
        moved = buffer[1:].view(float).reshape(values.shape)
        moved[:] = values
        assert not moved.flags.aligned
        future = Future()
        future.set_result((moved, failures))
        return future


def test_answers_may_lie_anywhere(cube):
    assert dict(ap.analyse(polynomial, cube, base_samples=64, executor=Unaligned(), in_flight=1).total) == expected(cube, 64)


class Job:
    """A job whose result() takes no timeout, and is there at the second look."""

    def __init__(self, function, arguments):
        self.work, self.looks = (function, arguments), 0

    def done(self):
        self.looks += 1
        return self.looks > 1

    def result(self):
        assert self.looks > 1
        function, arguments = self.work
        return function(*arguments)


class Queue:
    max_workers = 2

    def submit(self, function, *arguments):
        return Job(function, arguments)


def test_jobs_without_timeouts_are_asked_whether_they_are_done():
    factors = {"x1": (0, 1), "x2": (0, 1), "x3": (0, 1)}
    found = ap.analyse(polynomial, factors, base_samples=16, executor=Queue())
    assert np.array_equal(found.total, ap.analyse(polynomial, factors, base_samples=16).total)


def test_screenings_and_sweeps_take_executors_and_progress(cube):
    told = []
    study = ap.Study(row, cube, vectorised=False, call="matrix")
    expected = study.screen(8).to_dict()["outputs"], study.sweep(points=5).to_dict()["sweeps"]
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        screened = study.screen(8, executor=executor, progress=lambda done, total: told.append((done, total)))
        assert (screened.to_dict()["outputs"], study.sweep(points=5, executor=executor).to_dict()["sweeps"]) == expected
    assert told[-1] == (32, 32)


def test_progress_needs_no_tqdm(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(_progress, "_SECONDS_OF_A_LINE", 0.0)
    ap.analyse(slow_row, {"x": (0, 1), "y": (0, 1), "z": (0, 1)}, base_samples=64, vectorised=False, call="matrix", progress=True)
    lines = [line for line in capsys.readouterr().err.splitlines() if "minutes left" in line]
    assert lines and all("of 320 runs" in line for line in lines)
