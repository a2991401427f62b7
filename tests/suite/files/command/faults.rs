//! Faulty programs: every good row is used, every bad one has its reason.

use super::{Case, FORMULA, by_formula, only_reason, rows_where};
use crate::common::{apportion, numbers, succeed, text};
use crate::messages::{Messages, messages};

/// The result is that of a program without faults, to the bit.
#[track_caller]
fn is_whole(case: &Case) -> String {
    let (result, said) = case.result();
    let expected = by_formula(case, FORMULA);
    assert_eq!(result.outputs[0].runs_failed, 0);
    assert_eq!(numbers(&result.outputs[0]), numbers(&expected.outputs[0]));
    said
}

/// Rows with x1 above 0.9 fail for one reason, all others are used.
#[track_caller]
fn some_fail(messages: &mut Messages, name: &str, case: &Case) -> String {
    let (result, said) = case.result();
    let output = &result.outputs[0];
    let bad = rows_where(|x| x > 0.9);
    assert!((3..40).contains(&bad), "{bad}");
    messages.add(name, only_reason(output, bad));
    assert_eq!(output.runs_ok + output.runs_failed, 160);
    assert!(output.indices.is_some());
    said
}

#[test]
fn a_program_without_faults_gives_what_the_formula_gives() {
    is_whole(&Case::each_row("", "    answer(y)\n"));
    let objects = "import json, sys\nfor line in sys.stdin:\n    x = json.loads(line)\n    \
                   print(json.dumps({'id': x['id'], 'y': x['x1'] + 2*x['x2'] + x['x1']*x['x3']}), flush=True)\n";
    is_whole(&Case::new("protocol = \"json-lines\"", objects));
    is_whole(&Case::new("protocol = \"json-lines\"", objects));
}

#[test]
fn a_program_may_answer_in_blocks() {
    let blocks = "import sys\nsys.stdin.buffer.readline()\nrest = b''\nwhile block := sys.stdin.buffer.read1(65536):\n    \
                  lines, _, rest = (rest + block).rpartition(b'\\n')\n    for line in lines.splitlines():\n        \
                  n, *x = [float(cell) for cell in line.split(b',')]\n        \
                  sys.stdout.write(f'{n},{x[0] + 2*x[1] + x[0]*x[2]!r}\\n')\n    sys.stdout.flush()\n";
    is_whole(&Case::new("", blocks));
}

#[test]
fn the_program_reports_failed_rows() {
    let mut messages = messages!();
    for answer in ["'error: no root'", "'nan'", "'inf'", "f'step {x[0]} done'", "f'{y},{y}'"] {
        let program = format!("    answer({answer} if x[0] > 0.9 else y)\n");
        some_fail(&mut messages, answer, &Case::each_row("", &program));
    }
}

#[test]
fn only_the_row_that_crashes_the_program_fails() {
    let dies = "    if x[0] > 0.9:\n        print('no convergence at', x[0], file=sys.stderr, flush=True)\n        os._exit(3)\n    answer(y)\n";
    let mut messages = messages!();
    let said = some_fail(&mut messages, "an exit", &Case::each_row("", dies));
    assert!(said.contains("no convergence at 0.9"), "{said}");
    let by_signal = "    if x[0] > 0.9:\n        os.kill(os.getpid(), 11)\n    answer(y)\n";
    some_fail(&mut messages, "a signal", &Case::each_row("retries = 0", by_signal));
}

/// The row that causes the failure is found although the program had read others.
#[test]
fn only_the_row_that_crashes_a_program_of_blocks_fails() {
    let blocks = "import os, sys\nsys.stdin.buffer.readline()\nrest = b''\nwhile block := sys.stdin.buffer.read1(65536):\n    \
                  lines, _, rest = (rest + block).rpartition(b'\\n')\n    answers = ''\n    for line in lines.splitlines():\n        \
                  n, *x = [float(cell) for cell in line.split(b',')]\n        if x[0] > 0.9: os._exit(3)\n        \
                  answers += f'{n},{x[0] + 2*x[1] + x[0]*x[2]!r}\\n'\n    sys.stdout.write(answers)\n    sys.stdout.flush()\n";
    some_fail(&mut messages!(), "an exit", &Case::new("", blocks));
}

#[test]
fn crashing_rows_do_not_fail_other_rows() {
    let dies = "    if x[0] > 0.99:\n        os._exit(1)\n    answer(y)\n";
    let case = Case::each_row("", dies);
    let output = case.run_with(&["--base-samples", "512"]);
    assert_eq!(output.status.code(), Some(0), "{}", crate::common::stderr(&output));
    let result = case.result_file();
    let output = &result.outputs[0];
    assert!((10..60).contains(&output.runs_failed), "{}", output.runs_failed);
    messages!().add("an exit", only_reason(output, output.runs_failed));
    assert_eq!(output.runs_ok + output.runs_failed, 512 * 5);
    let expected = by_formula(&case, FORMULA);
    let (first, _) = numbers(output);
    let (exact, _) = numbers(&expected.outputs[0]);
    // 1 % of the rows less, and the other study has 32 base samples.
    assert!(first.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 0.2), "{first:?} {exact:?}");
}

#[test]
fn a_program_that_fails_once_is_tried_again() {
    let once = "    if x[0] > 0.9 and not os.path.exists(f'tried-{line.strip()}'):\n        open(f'tried-{line.strip()}', 'w')\n        os._exit(3)\n    answer(y)\n";
    is_whole(&Case::each_row("", once));
}

#[test]
fn a_program_that_ends_early_is_started_again() {
    let few = "    answer(y)\n    n = globals().get('n', 0) + 1\n    if n == 20: sys.exit()\n";
    is_whole(&Case::each_row("", few));
}

#[test]
fn a_banner_on_standard_output_is_named() {
    let banner = "print('Loading the model ...')\n";
    let case = Case::new("", &format!("{banner}{}    answer(y)\n", super::LOOP));
    case.ends_with(&mut messages!(), "a banner", 2);
}

#[test]
fn a_hanging_program_is_ended_and_started_again() {
    // A child process would keep the pipes open if it were not stopped too.
    let hangs = "    if 0.997 < x[0]:\n        import subprocess; subprocess.run(['sleep', '1000'])\n    answer(y)\n";
    // Long enough for a very busy machine to start Python.
    let case = Case::each_row("timeout = \"3 s\"\nretries = 0", hangs).replace("workers = 2", "workers = 4");
    let (result, _) = case.result();
    let bad = rows_where(|x| x > 0.997);
    assert!(bad > 0);
    messages!().add("a sleep", only_reason(&result.outputs[0], bad));
}

#[test]
fn a_program_that_does_not_flush_gets_a_hint() {
    let buffered =
        "    kept = globals().setdefault('kept', open(1, 'w', buffering=65536))\n    kept.write(f'{number},{y}\\n')\n";
    let case = Case::each_row("timeout = \"300 ms\"\nretries = 0", buffered);
    case.ends_with(&mut messages!(), "buffered", 1);
}

#[test]
fn standard_error_is_passed_on_and_counted() {
    let talks = "    print('row', line.strip(), '\\x1b[2J', file=sys.stderr)\n    answer(y)\n";
    let said = is_whole(&Case::each_row("", talks));
    assert_eq!(said.matches("the program: row").count(), 20, "{said}");
    assert!(said.contains(" 141 more lines "), "{said}");
    assert!(!said.contains('\x1b'));
}

#[test]
fn floods_take_little_memory() {
    let endless = "import sys\nwhile True: sys.stdout.write('x' * 1000000)\n";
    let mut messages = messages!();
    let message = Case::new("retries = 0", endless).ends_with(&mut messages, "one endless line", 1);
    assert!(message.len() < 5000);
    let lines = "import sys\nwhile True: sys.stdout.write('1.5\\n' * 10000)\n";
    Case::new("", lines).ends_with(&mut messages, "lines", 2);
    let errors = "import sys\nwhile True: sys.stderr.write('x' * 1000000)\n";
    Case::new("timeout = \"300 ms\"\nretries = 0", errors).ends_with(&mut messages, "errors", 1);
}

#[test]
fn a_program_that_never_works_is_given_up() {
    let mut messages = messages!();
    for (case, keys, program) in [
        ("a module that is missing", "", "import no_such_module\n"),
        ("an end without a word", "", "import sys\nsys.exit(7)\n"),
        ("a closed output", "retries = 0", "import os, time\nos.close(1)\ntime.sleep(1000)\n"),
    ] {
        Case::new(keys, program).ends_with(&mut messages, case, 1);
    }
}

#[test]
fn check_reports_failing_rows() {
    let all = Case::each_row("", "    answer('error: no root')\n");
    messages!().ended("all", 1, &apportion(&["check", text(&all.path("study.toml"))]));
    let some = Case::each_row("", "    answer('error: no root' if x[0] > 0.5 else y)\n");
    let printed = succeed(&["check", text(&some.path("study.toml"))]);
    assert!(printed.contains("no root"), "{printed}");
}

#[test]
fn check_separates_the_start_time_of_a_program_from_its_runs() {
    let slow = Case::new("", &format!("import time\ntime.sleep(1.2)\n{}    answer(y)\n", super::LOOP));
    let told = succeed(&["check", text(&slow.path("study.toml"))]);
    let cost = told.lines().find(|line| line.starts_with("cost: ")).unwrap();
    // 160 rows at 1.2 s would be minutes.
    let about: f64 = cost.split("about ").nth(1).unwrap().split(" s").next().unwrap().parse().unwrap();
    assert!((1.0..30.0).contains(&about), "{cost}");
}

impl Case {
    pub fn replace(self, from: &str, to: &str) -> Self {
        let text = std::fs::read_to_string(self.path("study.toml")).unwrap();
        assert!(text.contains(from));
        self.write("study.toml", &text.replacen(from, to, 1));
        self
    }
}
