//! A program that changes after its journal was written: no result mixes two models.

use std::path::PathBuf;
use std::process::Output;

use apportion::result::{StudyResult, read_result};

use crate::common::{Folder, apportion, stderr, text};
use crate::messages::messages;

const STUDY: &str = "model = \"command\"\ncommand = [\"python3\", \"model.py\"]\noutputs = [\"y\"]\n\
                     design.base_samples = 64\n\
                     [[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 2\n";

/// Runs of the study: 64 base points of A, B and two swaps.
const RUNS: u64 = 256;

fn program(formula: &str) -> String {
    format!(
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    a, b = float(x['a']), float(x['b'])\n    \
         print(x['id'], {formula}, sep=',', flush=True)\n"
    )
}

struct Case {
    folder: Folder,
}

impl Case {
    fn new(formula: &str) -> Self {
        let case = Self { folder: Folder::new() };
        case.folder.with("study.toml", STUDY);
        case.model(formula);
        case
    }

    fn model(&self, formula: &str) {
        self.folder.with("model.py", program(formula));
    }

    fn out(&self) -> PathBuf {
        self.folder.path("out")
    }

    fn run(&self, more: &[&str]) -> Output {
        let (study, out) = (self.folder.path("study.toml"), self.out());
        apportion(&[&["run", text(&study), "--out", text(&out)], more].concat())
    }

    #[track_caller]
    fn result(&self, more: &[&str]) -> (StudyResult, String) {
        let output = self.run(more);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (read_result(&self.out().join("study.json")).unwrap(), stderr(&output))
    }
}

#[test]
fn a_journal_of_another_program_is_refused_until_it_is_restarted() {
    let case = Case::new("a + b");
    let (first, _) = case.result(&[]);
    assert_eq!(first.provenance.model_files, ["model.py"]);
    case.model("a + b + 10");
    let mut messages = messages!();
    for more in [&[][..], &["--resume"], &["--retry-failed"], &["--base-samples", "128"]] {
        messages.ended(&more.join(" "), 2, &case.run(more));
    }
    // Undone.
    case.model("a + b");
    let (_, said) = case.result(&["--resume"]);
    assert!(said.contains(&format!("{RUNS} of {RUNS} runs ")), "{said}");
    case.model("a - b");
    let (restarted, _) = case.result(&["--restart"]);
    assert_eq!(restarted.outputs, Case::new("a - b").result(&[]).0.outputs);
}

/// Shards of different programs are not merged.
#[test]
fn parts_of_two_programs_are_not_merged() {
    let case = Case::new("a + b");
    assert_eq!(case.run(&["--shard", "1/2"]).status.code(), Some(0));
    case.model("a - b");
    assert_eq!(case.run(&["--shard", "2/2"]).status.code(), Some(0));
    let (study, out) = (case.folder.path("study.toml"), case.out());
    messages!().refused(&["merge", text(&study), "--out", text(&out)]);
}

#[test]
fn a_module_that_is_imported_is_known_if_it_is_listed() {
    let mut messages = messages!();
    let helper = |number: u64| format!("def f(a, b): return a + b + {number}\n");
    for is_listed in [true, false] {
        let case = Case::new("helper.f(a, b)");
        let listed = if is_listed { "command.depends_on = [\"helper.py\"]\n" } else { "" };
        let command = format!("command.program = [\"python3\", \"model.py\"]\n{listed}");
        case.folder.with("study.toml", STUDY.replace("command = [\"python3\", \"model.py\"]\n", &command));
        case.folder.with("model.py", format!("import helper\n{}", program("helper.f(a, b)")));
        case.folder.with("helper.py", helper(0));
        case.result(&[]);
        case.folder.with("helper.py", helper(1_000_000));
        if is_listed {
            messages.ended("a listed module", 2, &case.run(&["--resume", "--base-samples", "128"]));
        } else {
            case.result(&["--resume", "--base-samples", "128"]);
        }
    }
    let case = Case::new("a + b");
    let nowhere = "command.program = [\"python3\", \"model.py\"]\ncommand.depends_on = [\"nowhere.dat\"]\n";
    case.folder.with("study.toml", STUDY.replace("command = [\"python3\", \"model.py\"]\n", nowhere));
    messages.ended("no such file", 2, &case.run(&[]));
}
