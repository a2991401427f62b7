//! Programs that print more or fewer lines than they should, at several speeds: no row gets the answer of another row.

use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use apportion::run::RowValues;
use apportion::run::journal::read_journal;

use super::{Case, only_reason};
use crate::common::stderr;
use crate::messages::messages;

/// The beginning of every program: `ans(y)` is the answer to the row, `STRAY` a line that could be one.
const HEAD: &str = r#"
import os, sys, time, threading
if not CSV: import json
def say(line): sys.stdout.write(line + "\n"); sys.stdout.flush()
def rows():
    if CSV: sys.stdin.readline()
    while line := sys.stdin.readline():
        if CSV:
            number, *cells = line.split(",")
            x = [float(cell) for cell in cells]
        else:
            cells = json.loads(line)
            number = cells.pop("id")
            x = [cells[name] for name in ("x1", "x2", "x3")]
        time.sleep(DELAY)
        yield number, x
def answer(number, y):
    return f"{number},{y!r}" if CSV else f'{{"id": {number}, "y": {y!r}}}'
STRAY = "0.5" if CSV else '{"y": 0.5}'
n = 0
"#;

const EACH: &str =
    "for number, x in rows():\n    n += 1\n    y = x[0] + 2*x[1] + x[0]*x[2]\n    a = answer(number, y)\n";

/// The outcome of a study of a program.
#[derive(Clone, Copy, PartialEq, Debug)]
enum End {
    /// All rows have their numbers.
    Whole,
    /// Some rows may have failed.
    Failures,
    /// Some rows may have failed, or the run is given up.
    Any,
    /// The program has to be changed.
    Refused,
}
use End::{Any, Failures, Refused, Whole};

struct Program {
    name: &'static str,
    before: &'static str,
    each: &'static str,
    after: &'static str,
    end: End,
    /// Whether it is silent for so long before its first answer that it may not flush its output.
    is_hinted: bool,
}

const fn each(name: &'static str, each: &'static str, end: End) -> Program {
    Program { name, before: "", each, after: "", end, is_hinted: false }
}

const PROGRAMS: [Program; 20] = [
    Program { is_hinted: true, ..each("a late first answer", "    if n == 1: time.sleep(11)\n    say(a)\n", Whole) },
    each("no numbers", "    say(STRAY)\n", Refused),
    each("an answer without a number", "    say(a)\n    if n == 12: say(STRAY)\n", Refused),
    each("an empty line", "    say(a)\n    if n == 12: say('')\n", Whole),
    each("an answer twice", "    say(a)\n    if n == 12: say(a)\n", Any),
    each("a row skipped", "    if n == 12: continue\n    say(a)\n", Whole),
    each("rows skipped by their values", "    if x[0] > 0.8: continue\n    say(a)\n", Failures),
    each("numbers of its own", "    say(answer(n, y))\n", Refused),
    Program {
        before: "def tick():\n    while True:\n        time.sleep(0.015)\n        say('tick')\n\
                 threading.Thread(target=tick, daemon=True).start()\n",
        ..each("a thread that prints", "    time.sleep(0.002)\n    say(a)\n", Any)
    },
    Program { before: "say('Loading')\n", ..each("a banner", "    say(a)\n", Refused) },
    each("words now and then", "    say(a)\n    if n % 10 == 9: say('step 9')\n", Whole),
    each("a log of steps", "    say(a)\n    if n % 10 == 9: say('step,1,0.5')\n", Whole),
    Program { after: "say('done')\n", ..each("words at the end", "    say(a)\n", Whole) },
    each(
        "half an answer at the end",
        "    if x[0] > 0.8:\n        sys.stdout.write(a[:-1]); sys.stdout.flush(); os._exit(0)\n    say(a)\n",
        Failures,
    ),
    each("a row skipped before a crash", "    if n == 6: continue\n    if n == 15: os._exit(3)\n    say(a)\n", Whole),
    each("an end in between", "    say(a)\n    if n == 15: sys.exit()\n", Whole),
    each("an end after every answer", "    say(a)\n    sys.exit()\n", Whole),
    each("two answers in one line", "    if n == 12: a += a\n    say(a)\n", Failures),
    each("lines that end as on Windows", "    say(a + '\\r')\n", Whole),
    each(
        "an answer in two pieces",
        "    half = len(a) // 2\n    sys.stdout.write(a[:half]); sys.stdout.flush(); time.sleep(0.02)\n    say(a[half:])\n",
        Whole,
    ),
];

/// One program with one protocol.
#[derive(Clone, Copy)]
struct Trial {
    program: &'static Program,
    csv: bool,
    delay: &'static str,
}

/// Rows of a trial: two replicates of two points.
const ROWS: usize = 20;

impl Trial {
    /// Every program in both forms, at one of the speeds each.
    fn all() -> Vec<Self> {
        let delays = ["0", "0.001", "0.01"];
        let trial = |(number, program): (usize, &'static Program)| {
            [true, false].map(|csv| Self { program, csv, delay: delays[(number + usize::from(csv)) % 3] })
        };
        PROGRAMS.iter().enumerate().flat_map(trial).collect()
    }

    fn name(self) -> String {
        let protocol = if self.csv { "CSV" } else { "JSON" };
        format!("{}, {protocol}, {} s a row", self.program.name, self.delay)
    }

    fn case(self) -> Case {
        let Program { before, each, after, .. } = self.program;
        let (csv, protocol) = if self.csv { ("True", "csv") } else { ("False", "json-lines") };
        let constants = format!("CSV, DELAY = {csv}, {}", self.delay);
        Case::new(&format!("protocol = \"{protocol}\""), &format!("{constants}{HEAD}{before}{EACH}{each}{after}"))
            .replace("workers = 2", "workers = 1")
            .replace("base_samples = 32", "base_samples = 4")
    }

    /// Rows with their numbers, and the hint to flush, if it is given; the reason for a message, if there is one.
    fn fault(self) -> Result<(usize, Option<String>), String> {
        let case = self.case();
        let output = case.run();
        let (rows, right, wrong) = on_record(&case);
        let said = || format!("{}: {wrong} of {rows} rows wrong, {right} right: {}", self.name(), stderr(&output));
        // A busy machine may be as slow with the others.
        let hint = stderr(&output).lines().find(|line| line.contains("first answer: ")).map(str::to_owned);
        let hint = hint.filter(|_| self.program.is_hinted);
        let end = self.program.end;
        let is_known = match output.status.code() {
            Some(0) => (end != Whole || right == ROWS) && end != Refused && right > 0 && rows == ROWS,
            Some(1) => end == Any,
            Some(2) => matches!(end, Refused | Any),
            _ => false,
        };
        let is_right = is_known && wrong == 0 && hint.is_some() == self.program.is_hinted;
        if is_right { Ok((right, hint)) } else { Err(said()) }
    }
}

/// Rows in the journal of a case: all, those with the number of the formula, and those with another.
fn on_record(case: &Case) -> (usize, usize, usize) {
    let study = apportion_files::load_study(&case.path("study.toml"), &[]).unwrap();
    let journal = case.path("out/study.journal");
    let contents = read_journal(&journal, &std::fs::read(&journal).unwrap()).unwrap();
    let (mut all, mut right, mut wrong) = (0, 0, 0);
    for block in &contents.blocks {
        let mut values = RowValues::default();
        let end = block.first + block.rows(1);
        let x = values.values(study.space(), study.design(), block.replicate, block.first..end);
        for (row, y) in block.values.iter().enumerate() {
            let expected = x[0][row] + 2.0 * x[1][row] + x[0][row] * x[2][row];
            all += 1;
            right += usize::from(*y == expected);
            wrong += usize::from(y.is_finite() && *y != expected);
        }
    }
    (all, right, wrong)
}

#[test]
fn no_program_makes_a_wrong_number() {
    let (trials, next) = (Trial::all(), AtomicUsize::new(0));
    let (faults, hints, answered) = (Mutex::new(Vec::new()), Mutex::new(BTreeSet::new()), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        // The programs wait more than they compute.
        for _ in 0..16 {
            scope.spawn(|| {
                while let Some(trial) = trials.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match trial.fault() {
                        Ok((right, hint)) => {
                            answered.fetch_add(right, Ordering::Relaxed);
                            hints.lock().unwrap().extend(hint);
                        }
                        Err(fault) => faults.lock().unwrap().push(fault),
                    }
                }
            });
        }
    });
    let faults = faults.into_inner().unwrap();
    assert!(faults.is_empty(), "{} of {} trials:\n{}", faults.len(), trials.len(), faults.join("\n"));
    assert!(answered.into_inner() > ROWS * trials.len() / 2);
    let hints: Vec<String> = hints.into_inner().unwrap().into_iter().collect();
    messages!().add("a late first answer", &hints.join("\n"));
}

#[test]
fn only_the_row_without_an_answer_fails() {
    let case =
        Case::each_row("", "    if x[0] > 0.97: continue\n    answer(y)\n").replace("workers = 2", "workers = 8");
    let (result, _) = case.result();
    let bad = super::rows_where(|x| x > 0.97);
    messages!().add("no answer", only_reason(&result.outputs[0], bad));
}

#[test]
fn answers_may_come_in_any_order() {
    let backwards = "import sys\nsys.stdin.buffer.readline()\nrest = b''\nwhile block := sys.stdin.buffer.read1(65536):\n    \
                     lines, _, rest = (rest + block).rpartition(b'\\n')\n    for line in reversed(lines.splitlines()):\n        \
                     n, *x = line.decode().split(',')\n        x = [float(cell) for cell in x]\n        \
                     sys.stdout.write(f'{n},{x[0] + 2*x[1] + x[0]*x[2]!r}\\n')\n    sys.stdout.flush()\n";
    let case = Case::new("", backwards);
    let (result, _) = case.result();
    assert_eq!(result.outputs[0].runs_failed, 0);
    assert_eq!(on_record(&case), (160, 160, 0));
}

/// From other threads, each after another time: without numbers the answers could not be assigned to rows.
#[test]
fn answers_may_come_from_threads() {
    let threads = "import sys, threading, time\nlock = threading.Lock()\nsys.stdin.readline()\ndef work(line):\n    \
                   n, *x = line.split(',')\n    a, b, c = map(float, x)\n    time.sleep(0.01 * c)\n    \
                   with lock: print(n, a + 2*b + a*c, sep=',', flush=True)\n\
                   for line in sys.stdin: threading.Thread(target=work, args=[line]).start()\n";
    let case = Case::new("", threads);
    case.result();
    assert_eq!(on_record(&case), (160, 160, 0));
}

#[test]
fn a_program_that_leaves_out_the_numbers_gets_the_line_to_change() {
    let without = "import sys\nsys.stdin.readline()\nfor line in sys.stdin: print(1.5, flush=True)\n";
    let mut messages = messages!();
    Case::new("", without).ends_with(&mut messages, "CSV", 2);
    let case = Case::new("protocol = \"json-lines\"", "print('{\"y\": 1}', flush=True)\ninput()\n");
    case.ends_with(&mut messages, "JSON", 2);
}

#[test]
fn a_row_answered_twice_ends_the_run() {
    let case = Case::each_row("", "    answer(y)\n    answer(y)\n");
    assert_eq!(case.run().status.code(), Some(1));
}
