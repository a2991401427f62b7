//! What does the engine cost on top of a program that it keeps alive?
//!
//! A million rows of a trivial Python function of three factors: through the engine, on one worker and on all cores, by a
//! worker that answers row by row and by one in numpy that answers in blocks; and Python by itself, calling the same
//! function in a loop over rows that it draws. Prints a table: seconds, rows a second, and the share of the time that is
//! not Python's own.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

/// Base samples: 2^18 x 5 rows are 1.3 million, 200,000 x 5 are one.
const BASE_SAMPLES: u64 = 200_000;

const FUNCTION: &str = "def model(x1, x2, x3):\n    return x1 + 2 * x2 + x1 * x3\n";

/// The rows that the engine would ask for, drawn and computed by Python alone.
const ALONE: &str =
    "import random\nfor _ in range(1000000):\n    y = model(random.random(), random.random(), random.random())\n";

/// The shortest worker.
const WORKER: &str = "import sys\nsys.stdin.readline()\nfor line in sys.stdin:\n    number, *x = line.split(',')\n    print(number, model(*map(float, x)), sep=',', flush=True)\n";

/// The worker that the README shows.
const READER: &str = "import csv, sys\nfor row in csv.DictReader(sys.stdin):\n    number = row.pop('id')\n    x = {name: float(value) for name, value in row.items()}\n    \
                      print(number, model(**x), sep=',', flush=True)\n";

/// One that answers all rows that are waiting at once.
const BLOCKS: &str = "import sys\nsys.stdin.buffer.readline()\nrest = b''\nwhile block := sys.stdin.buffer.read1(1 << 20):\n    \
                      rows, _, rest = (rest + block).rpartition(b'\\n')\n    if rows:\n        \
                      cells = (row.split(b\",\") for row in rows.split(b'\\n'))\n        \
                      sys.stdout.write(''.join(f'{n.decode()},{model(*map(float, x))!r}\\n' for n, *x in cells))\n        \
                      sys.stdout.flush()\n";

fn seconds_of_study(folder: &Path, program: &str, workers: &str) -> (f64, u64) {
    std::fs::write(folder.join("model.py"), format!("{FUNCTION}{program}")).expect("the folder is ours");
    let mut text = format!(
        "model = \"command\"\noutputs = [\"y\"]\n[command]\nprogram = [\"python3\", \"model.py\"]\n{workers}\n\
         [design]\nbase_samples = {BASE_SAMPLES}\n"
    );
    for name in ["x1", "x2", "x3"] {
        text.push_str(&format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n"));
    }
    let study = apportion_files::parse_study(&text, &folder.join("study.toml"), &[]).expect("a study");
    let start = Instant::now();
    let result = study.run().expect("the program answers");
    (start.elapsed().as_secs_f64(), result.provenance.model_runs)
}

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let start = Instant::now();
    let script = format!("{FUNCTION}{ALONE}");
    let status = Command::new("python3").args(["-c", &script]).status().expect("python3 is installed");
    assert!(status.success());
    let alone = start.elapsed().as_secs_f64() / 1e6;
    println!("{:<44} {:>9} {:>9} {:>12} {:>22}", "", "rows", "seconds", "rows/s", "beside the function");
    println!(
        "{:<44} {:>9} {:>9.2} {:>12.0} {:>22}",
        "Python alone, in a loop",
        1_000_000,
        alone * 1e6,
        1.0 / alone,
        "-"
    );
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for (what, program) in [
        ("csv.DictReader, print(flush=True)", READER),
        ("split, print(flush=True)", WORKER),
        ("split, answers in blocks", BLOCKS),
    ] {
        for (workers, count) in [("workers = 1", 1), ("", cores)] {
            let (seconds, rows) = seconds_of_study(folder.path(), program, workers);
            let rate = rows as f64 / seconds;
            let share = 100.0 * (1.0 - alone * rate / count as f64);
            let name = format!("{what}, {count} worker{}", if count == 1 { "" } else { "s" });
            println!("{name:<44} {rows:>9} {seconds:>9.2} {rate:>12.0} {share:>20.0} %");
        }
    }
}
