#!/usr/bin/env python3
"""Two ranks against two threads: the table of docs/guide/scaling.md. Needs mpirun and `cargo build --release --features mpi`.

    benches/ranks.py target/release/apportion
"""

import os
import re
import statistics
import subprocess
import sys
import tempfile

PROGRAM = """import csv, sys, time
for row in csv.DictReader(sys.stdin):
    a, b = float(row["a"]), float(row["b"])
    time.sleep(0.005)
    print(row["id"], a + 2 * b * b, sep=",", flush=True)
"""
STUDY = """model = "command"
outputs = ["y"]
[command]
program = ["python3", "model.py"]
"""
FACTORS = "".join(f'[[factor]]\nname = "{name}"\nmin = 0.0\nmax = 1.0\n' for name in "ab")
REPEATS = 5


def run(program, folder, study, base_samples, ranks):
    """Seconds of a run, its rows, and messages and bytes between its ranks."""
    alone = [program, "run", study, "--base-samples", str(base_samples), "--no-journal", "--out", f"{folder}/out"]
    command = ["mpirun", "-n", "2", *alone] if ranks else [*alone, "--threads", "2"]
    environment = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "APPORTION_MPI": "count"}
    environment |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | environment, check=True)
    rows, seconds = re.search(r"(\d+) model runs in ([\d.]+) s", done.stderr).groups()
    counted = re.search(r"(\d+) messages of (\d+) bytes", done.stderr)
    return float(seconds), int(rows), [int(number) for number in counted.groups()] if counted else [0, 0]


def main():
    program = os.path.abspath(sys.argv[1])
    studies = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "studies")
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/model.py", "w") as file:
            file.write(PROGRAM)
        with open(f"{folder}/program.toml", "w") as file:
            file.write(STUDY + FACTORS)
        print("| study | rows | 2 threads (s) | 2 ranks (s) | efficiency | messages and bytes per million rows |")
        print("|---|---|---|---|---|---|")
        for study, base_samples in [
            (f"{studies}/sobol-g.toml", 1 << 22),
            (f"{studies}/soft-cantilever.toml", 1 << 22),
            (f"{folder}/program.toml", 1 << 9),
        ]:
            # In turn, so that whatever else the machine does is in both; the least disturbed of each counts.
            pairs = [[run(program, folder, study, base_samples, ranks) for ranks in (False, True)] for _ in range(REPEATS)]
            threads, ranks = (min(pair[side][0] for pair in pairs) for side in (0, 1))
            _, rows, _ = pairs[0][1]
            messages, size = (statistics.median(pair[1][2][place] for pair in pairs) * 1e6 / rows for place in (0, 1))
            name = os.path.basename(study)[:-5]
            print(f"| {name} | {rows} | {threads:.2f} | {ranks:.2f} | {threads / ranks:.2f} | {messages:.1f}, {size:.0f} |")


main()
