//! Programs as models, through the binary and by themselves: their answers, and their possible errors.

mod examples;
mod faults;
mod misbehaving;
mod model;
mod other_commands;
mod per_run;
mod processes;
mod record;
mod refusals;

use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Duration;

use apportion::result::{OutputResult, StudyResult, read_result};
use tempfile::TempDir;

use crate::common::{program, stderr, text};
use crate::messages::Messages;

/// A study of a program in a separate folder.
pub struct Case {
    folder: TempDir,
}

/// Three factors, two replicates of 16 points: 2 x 16 x 5 = 160 rows.
const FACTORS: &str = r#"
[design]
base_samples = 32
replicates = 2
[analysis]
max_failed = 1
[[factor]]
name = "x1"
min = 0
max = 1
[[factor]]
name = "x2"
min = 0
max = 1
[[factor]]
name = "x3"
min = 0
max = 1
"#;

/// The beginning of a worker with its own function.
const LOOP: &str = "import os, sys, time\ndef answer(y): print(number, y, sep=',', flush=True)\n\
                    sys.stdin.readline()\nfor line in sys.stdin:\n    number, line = line.split(',', 1)\n    \
                    x = [float(cell) for cell in line.split(',')]\n    y = x[0] + 2*x[1] + x[0]*x[2]\n";

impl Case {
    /// A study with the keys `command` of `[command]` and the program `model.py`.
    pub fn new(command: &str, program: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        // The lines of outputs are above the table.
        let (outputs, keys): (Vec<&str>, Vec<&str>) = command.lines().partition(|line| line.starts_with("outputs."));
        let outputs = if outputs.is_empty() { "outputs = [\"y\"]".to_owned() } else { outputs.join("\n") };
        let study = format!(
            "model = \"command\"\n{outputs}\n[command]\nprogram = [\"python3\", \"model.py\"]\nworkers = 2\n{}\n{FACTORS}",
            keys.join("\n")
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        std::fs::write(folder.path().join("model.py"), program).unwrap();
        Self { folder }
    }

    /// One whose program runs `what`, indented, for every row: its values are in `x` and, without its number, in `line`, and
    /// `answer(y)` is the answer.
    pub fn each_row(command: &str, what: &str) -> Self {
        Self::new(command, &format!("{LOOP}{what}"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: &str) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// A run of the study, which ends within some minutes, however busy the machine is.
    pub fn run(&self) -> Output {
        self.run_with(&[])
    }

    pub fn run_with(&self, more: &[&str]) -> Output {
        let (study, out) = (self.path("study.toml"), self.path("out"));
        let arguments = ["run", text(&study), "--charts", "none", "--out", text(&out)];
        program().args(arguments).args(more).timeout(Duration::from_secs(240)).output().unwrap()
    }

    /// The result of a successful run, and its standard error.
    #[track_caller]
    pub fn result(&self) -> (StudyResult, String) {
        let output = self.run();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (self.result_file(), stderr(&output))
    }

    pub fn result_file(&self) -> StudyResult {
        read_result(&self.path("out/study.json")).unwrap()
    }

    /// The last message of a run that ends with that exit code: what the program writes before it is not always the same.
    #[track_caller]
    pub fn ends_with(&self, messages: &mut Messages, case: &str, code: i32) -> String {
        let output = self.run();
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{message}");
        messages.add(case, &message[message.find("error: ").unwrap()..]);
        message
    }
}

/// The one reason for which so many runs have failed, which are all that have.
#[track_caller]
pub fn only_reason(output: &OutputResult, runs: u64) -> &str {
    let [failure] = &output.failures[..] else { panic!("{:?}", output.failures) };
    assert_eq!((failure.runs, output.runs_failed), (runs, runs), "{}", failure.reason);
    &failure.reason
}

/// The result of the same study by a formula.
pub fn by_formula(case: &Case, formula: &str) -> StudyResult {
    let text = std::fs::read_to_string(case.path("study.toml")).unwrap();
    let (start, end) = (text.find("[command]").unwrap(), text.find("[design]").unwrap());
    let text = format!("{}{}", &text[..start], &text[end..]);
    let text = text.replace("model = \"command\"", "model = \"expression\"");
    let text = text.replace("outputs = [\"y\"]", &format!("outputs.y = \"{formula}\""));
    let study = apportion_files::parse_study(&text, Path::new("formula.toml"), &[]).unwrap();
    study.run().unwrap()
}

/// The formula of [`LOOP`], in the same order of operations.
pub const FORMULA: &str = "x1 + 2*x2 + x1*x3";

/// Rows of the study at which a condition on the first factor holds.
pub fn rows_where(condition: impl Fn(f64) -> bool) -> u64 {
    let case = Case::new("", "");
    let study = apportion_files::load_study(&case.path("study.toml"), &[]).unwrap();
    let design = study.design();
    let (mut count, points) = (0, design.points_per_replicate() as usize);
    for replicate in 0..design.settings().replicates {
        let mut unit = vec![vec![0.0; points]; design.columns()];
        design.replicate(replicate).fill(0, &mut unit);
        for run in design.runs() {
            let matrix = if run.columns.contains(&0) { run.from } else { run.base };
            count += unit[design.first_column(matrix)].iter().filter(|u| condition(**u)).count() as u64;
        }
    }
    count
}
