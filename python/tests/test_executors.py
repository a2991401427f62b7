import multiprocessing
import shutil
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import apportion as ap
import pytest
from conftest import polynomial
from functions_elsewhere import DiesOnce, row, slow_row

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


def test_functions_without_a_module_go_along(cube):
    pytest.importorskip("cloudpickle")
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        result = ap.analyse(lambda x1, x2, x3: x1 + 2 * x2, cube, base_samples=64, executor=executor)
    assert abs(result.total["x2"].estimate - 0.8) < 1e-6


def test_a_broken_pool_ends_the_run_and_its_journal_goes_on(cube, tmp_path):
    journal = tmp_path / "f.journal"
    function = DiesOnce(str(tmp_path / "mark"))
    options = {"base_samples": 64, "outputs": ["y"], "call": "columns", "journal": journal}
    study = ap.Study(function, cube, **{key: options[key] for key in ("base_samples", "outputs", "call")})
    study._first = (None, None)
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
        study._first = (None, None)
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
