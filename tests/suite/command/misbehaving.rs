//! Programs that print more or fewer lines than they should, at several speeds: whatever they do, no row ever gets another
//! number than its own.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use apportion::report::read_result;
use apportion::run::journal::read_journal;
use apportion::run::{Job, RowValues};
use apportion::study::Study;

use super::{Case, contains, failures};
use crate::common::{stderr, text};

/// The beginning of every program: `ans(y)` is the answer to the row, `STRAY` a line that could be one.
const HEAD: &str = r#"
import os, sys, time, threading
if not CSV: import json
def say(line): sys.stdout.write(line + "\n"); sys.stdout.flush()
def rows():
    if CSV: sys.stdin.readline()
    while line := sys.stdin.readline():
        if CSV:
            cells = line.split(",")
            number = cells.pop(0) if NUMBERED else None
            x = [float(cell) for cell in cells]
        else:
            cells = json.loads(line)
            number = cells.pop("id", None)
            x = [cells[name] for name in ("x1", "x2", "x3")]
        time.sleep(DELAY)
        yield number, x
def answer(number, y):
    if CSV: return f"{number},{y!r}" if NUMBERED else repr(y)
    return f'{{"id": {number}, "y": {y!r}}}' if NUMBERED else f'{{"y": {y!r}}}'
STRAY = "0.5" if CSV else '{"y": 0.5}'
n = 0
"#;

const EACH: &str =
    "for number, x in rows():\n    n += 1\n    y = x[0] + 2*x[1] + x[0]*x[2]\n    a = answer(number, y)\n";

/// What becomes of a study of a program.
#[derive(Clone, Copy, PartialEq, Debug)]
enum End {
    /// All rows have their numbers.
    Whole,
    /// Some rows may have failed.
    Failures,
    /// That, or the run is given up.
    Any,
}
use End::{Any, Failures, Whole};

struct Program {
    name: &'static str,
    before: &'static str,
    each: &'static str,
    after: &'static str,
    /// Without row numbers, and with them.
    ends: [End; 2],
}

const fn each(name: &'static str, each: &'static str, ends: [End; 2]) -> Program {
    Program { name, before: "", each, after: "", ends }
}

const PROGRAMS: [Program; 30] = [
    each("a line too many once", "    say(a)\n    if n == 12: say(STRAY)\n", [Whole, Whole]),
    each("a line too many before the answer", "    if n == 12: say(STRAY)\n    say(a)\n", [Whole, Whole]),
    each("an empty line after the answer", "    say(a)\n    if n == 12: say('')\n", [Whole, Whole]),
    each("an empty line before the answer", "    if n == 12: say('')\n    say(a)\n", [Whole, Whole]),
    each("a line too many now and then", "    say(a)\n    if n % 10 == 9: say(STRAY)\n", [Whole, Whole]),
    each("an answer twice", "    say(a)\n    if n == 12: say(a)\n", [Whole, Any]),
    each("answers twice", "    say(a)\n    if n % 7 == 6: say(a)\n", [Whole, Any]),
    each("a line with every answer", "    say(STRAY)\n    say(a)\n", [Any, Whole]),
    each("a row skipped", "    if n == 12: continue\n    say(a)\n", [Whole, Failures]),
    each("rows skipped", "    if n % 5 == 4: continue\n    say(a)\n", [Whole, Failures]),
    each("rows skipped by their values", "    if x[0] > 0.8: continue\n    say(a)\n", [Failures, Failures]),
    each("a line too many by value", "    say(a)\n    if x[0] > 0.8: say(STRAY)\n", [Any, Whole]),
    each(
        "a late line of a thread",
        "    say(a)\n    if n == 5: threading.Timer(0.03, say, [STRAY]).start()\n",
        [Whole, Whole],
    ),
    Program {
        name: "a thread that prints",
        before: "def tick():\n    while True:\n        time.sleep(0.015)\n        say(STRAY)\n\
                 threading.Thread(target=tick, daemon=True).start()\n",
        each: "    say(a)\n",
        after: "",
        ends: [Any, Whole],
    },
    Program {
        name: "a number at the start",
        before: "say('1.0')\n",
        each: "    say(a)\n",
        after: "",
        ends: [Any, Whole],
    },
    Program { name: "a banner", before: "say('Loading')\n", each: "    say(a)\n", after: "", ends: [Any, Whole] },
    each("words now and then", "    if n % 10 == 9: say('step 9')\n    say(a)\n", [Whole, Whole]),
    each("a log of steps", "    if n % 10 == 9: say('1,0.5')\n    say(a)\n", [Whole, Whole]),
    Program {
        name: "a number at the end",
        before: "",
        each: "    say(a)\n",
        after: "say(STRAY)\n",
        ends: [Any, Whole],
    },
    Program {
        name: "words at the end",
        before: "",
        each: "    say(a)\n",
        after: "say('done')\n",
        ends: [Whole, Whole],
    },
    each(
        "half an answer at the end",
        "    if x[0] > 0.8:\n        sys.stdout.write('1.'); sys.stdout.flush(); os._exit(0)\n    say(a)\n",
        [Failures, Failures],
    ),
    each(
        "a row skipped before a crash",
        "    if n == 6: continue\n    if n == 15: os._exit(3)\n    say(a)\n",
        [Whole, Failures],
    ),
    each(
        "a line too many before a crash",
        "    if n == 6: say(STRAY)\n    if n == 15: os._exit(3)\n    say(a)\n",
        [Whole, Whole],
    ),
    each("an end in between", "    say(a)\n    if n == 4: say(STRAY)\n    if n == 15: sys.exit()\n", [Whole, Whole]),
    each("two answers in one line", "    if n == 12: a += a\n    say(a)\n", [Whole, Failures]),
    each("blanks now and then", "    if n % 6 == 5: say('   ')\n    say(a)\n", [Whole, Whole]),
    each("lines that end as on Windows", "    say(a + '\\r')\n", [Whole, Whole]),
    each("no number now and then", "    say(answer(number, float('nan')) if n % 6 == 5 else a)\n", [Any, Any]),
    each("a row skipped and another answered twice", "    if n != 6: say(a)\n    if n == 12: say(a)\n", [Any, Any]),
    each(
        "an answer in two pieces",
        "    half = len(a) // 2\n    sys.stdout.write(a[:half]); sys.stdout.flush(); time.sleep(0.02)\n    say(a[half:])\n",
        [Whole, Whole],
    ),
];

/// One program, asked in one way.
#[derive(Clone, Copy)]
struct Trial {
    program: &'static Program,
    csv: bool,
    numbered: bool,
    delay: &'static str,
}

/// Rows of a trial: two replicates of two points. Programs that are out of step are started once for each.
const ROWS: usize = 20;

impl Trial {
    /// Every program in every form and at every speed if the environment has `MISBEHAVING=all`, which takes minutes;
    /// otherwise three of them each, which together are of all kinds.
    fn all() -> Vec<Self> {
        let delays = ["0", "0.001", "0.01"];
        let mut trials = Vec::new();
        for (number, program) in PROGRAMS.iter().enumerate() {
            let trial = |csv, numbered, delay: usize| Self { program, csv, numbered, delay: delays[delay % 3] };
            if std::env::var_os("MISBEHAVING").is_some_and(|value| value == "all") {
                let forms = [(true, false), (true, true), (false, false), (false, true)];
                trials
                    .extend(forms.iter().flat_map(|(csv, numbered)| (0..3).map(|delay| trial(*csv, *numbered, delay))));
            } else {
                trials.push(trial(true, false, number));
                trials.push(trial(number % 2 == 0, true, number + 1));
                trials.push(trial(false, false, number + 2));
            }
        }
        trials
    }

    fn name(self) -> String {
        let Self { program, csv, numbered, delay } = self;
        let (protocol, numbers) = (if csv { "CSV" } else { "JSON" }, if numbered { "with" } else { "without" });
        format!("{}, {protocol} {numbers} numbers, {delay} s a row", program.name)
    }

    fn case(self) -> Case {
        let truth = |is_true| if is_true { "True" } else { "False" };
        let Program { before, each, after, .. } = self.program;
        let (csv, numbered, delay) = (truth(self.csv), truth(self.numbered), self.delay);
        let constants = format!("CSV, NUMBERED, DELAY = {csv}, {numbered}, {delay}");
        let protocol = if self.csv { "csv" } else { "json-lines" };
        let keys = format!("protocol = \"{protocol}\"\nrow_numbers = {}", self.numbered);
        Case::new(&keys, &format!("{constants}{HEAD}{before}{EACH}{each}{after}"))
            .replace("[\"python3\", ", "[\"python3\", \"-S\", \"-E\", ")
            .replace("workers = 2", "workers = 1")
            .replace("base_samples = 32", "base_samples = 4")
    }

    /// Rows with a number of their own; why there is more to say, if there is.
    fn fault(self) -> Result<usize, String> {
        let case = self.case();
        let output = case.run();
        let (rows, right, wrong) = on_record(&case);
        let said = || format!("{}: {wrong} of {rows} rows wrong: {}", self.name(), stderr(&output));
        let end = self.program.ends[usize::from(self.numbered)];
        let is_known = match output.status.code() {
            Some(0) => (end != Whole || right == ROWS) && right > 0 && rows == ROWS,
            Some(1) => end == Any,
            _ => false,
        };
        if is_known && wrong == 0 { Ok(right) } else { Err(said()) }
    }
}

/// Rows in the journal of a case: all, those with the number of the formula, and those with another.
fn on_record(case: &Case) -> (usize, usize, usize) {
    let study = Study::load(&case.path("study.toml"), &[]).unwrap();
    let model = study.model();
    let job = Job { design: study.design(), space: study.space(), model: model.as_ref() };
    let journal = case.path("out/study.journal");
    let contents = read_journal(&journal, &std::fs::read(&journal).unwrap()).unwrap();
    let (mut all, mut right, mut wrong) = (0, 0, 0);
    for piece in &contents.pieces {
        let mut values = RowValues::default();
        let end = piece.first + piece.rows(1);
        let x = values.values(job, piece.replicate, piece.first..end);
        for (row, y) in piece.values.iter().enumerate() {
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
    let (faults, answered) = (Mutex::new(Vec::new()), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for _ in 0..6 {
            scope.spawn(|| {
                while let Some(trial) = trials.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match trial.fault() {
                        Ok(right) => drop(answered.fetch_add(right, Ordering::Relaxed)),
                        Err(fault) => faults.lock().unwrap().push(fault),
                    }
                }
            });
        }
    });
    let faults = faults.into_inner().unwrap();
    assert!(faults.is_empty(), "{} of {} trials:\n{}", faults.len(), trials.len(), faults.join("\n"));
    assert!(answered.into_inner() > ROWS * trials.len() / 2);
}

#[test]
fn a_result_says_that_the_program_was_out_of_step() {
    let extra = "    print(y, flush=True)\n    n = globals().get('n', 0) + 1\n    if n == 12: print(0.5, flush=True)\n";
    let case = Case::each_row("", extra).replace("workers = 2", "workers = 1");
    let case = case.replace("base_samples = 32", "base_samples = 8");
    let output = case.run_with(&["--save-outputs", text(&case.path("runs.csv"))]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    contains(
        &stderr(&output),
        &["warning: the program is out of step: it printed more answers than it had rows", "row_numbers = true"],
    );
    assert_eq!(on_record(&case), (40, 40, 0));
    let result = read_result(&case.path("out/study.json")).unwrap();
    assert_eq!(failures(&result.outputs[0]), []);
    let told: Vec<&String> = result.outputs[0].warnings.iter().filter(|w| w.starts_with("asked-alone")).collect();
    assert_eq!(told.len(), 1, "{:?}", result.outputs[0].warnings);
    assert_eq!(result.validity.len(), 1);
    let page = std::fs::read_to_string(case.path("out/study.html")).unwrap();
    assert!(page.contains("the program was out of step"));
    // What was asked alone stays known when the run goes on from its journal.
    let again = case.run_with(&["--resume"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    assert_eq!(read_result(&case.path("out/study.json")).unwrap().validity, result.validity);
}

#[test]
fn a_row_that_gives_two_lines_by_itself_ends_the_run_with_the_reason() {
    let case = Case::each_row("", "    print(y)\n    if x[0] > 0.9: print('0.5')\n    sys.stdout.flush()\n");
    case.gives_up(&["more than one line for a row, asked by a process of its own", "row_numbers = true"]);
    assert_eq!(on_record(&case).2, 0);
}

#[test]
fn a_row_without_an_answer_fails_alone() {
    let case = Case::each_row("", "    if x[0] > 0.9: continue\n    print(y, flush=True)\n");
    let (result, said) = case.result();
    contains(&said, &["the program is out of step: it printed fewer answers than it had rows"]);
    let bad = super::rows_where(|x| x > 0.9);
    assert_eq!(failures(&result.outputs[0]), [("the program gave no answer to the row", bad)]);
}

/// With row numbers a program may answer in any order.
#[test]
fn numbered_answers_may_come_in_any_order() {
    let backwards = "import sys\nsys.stdin.buffer.readline()\nrest = b''\nwhile block := sys.stdin.buffer.read1(65536):\n    \
                     lines, _, rest = (rest + block).rpartition(b'\\n')\n    for line in reversed(lines.splitlines()):\n        \
                     n, *x = line.decode().split(',')\n        x = [float(cell) for cell in x]\n        \
                     sys.stdout.write(f'{n},{x[0] + 2*x[1] + x[0]*x[2]!r}\\n')\n    sys.stdout.flush()\n";
    let case = Case::new("row_numbers = true", backwards);
    let (result, _) = case.result();
    assert_eq!(failures(&result.outputs[0]), []);
    assert_eq!(on_record(&case), (160, 160, 0));
    assert!(result.validity.is_empty() && result.outputs[0].warnings.iter().all(|w| !w.contains("step")));
}

#[test]
fn a_program_that_leaves_out_the_numbers_is_told_what_is_missing() {
    let case = Case::new(
        "row_numbers = true",
        "import sys\nsys.stdin.readline()\nfor line in sys.stdin: print(1.5, flush=True)\n",
    );
    case.gives_up(&[
        "answered none of its first 5 rows",
        "expected the row's number and a number, separated by a comma",
    ]);
    let twice = "    print(y, flush=True)\n    print(y, flush=True)\n";
    let case = Case::each_numbered_row(twice);
    case.gives_up(&["answered the row with the number", "twice"]);
}
