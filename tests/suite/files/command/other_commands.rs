//! Programs in the commands other than `run`: a program that does not work stops them, and slow ones run in several
//! processes at once.

use std::collections::BTreeSet;
use std::io::Read;
use std::process::Output;
use std::time::{Duration, Instant};

use super::Case;
use super::processes::{is_alive, processes, signal, spawn, within};
use crate::common::{files, program, stderr, text};
use crate::messages::messages;

impl Case {
    /// `command STUDY more...`, in which names that begin with @ are files in the folder.
    fn arguments(&self, command: &str, more: &[&str]) -> Vec<String> {
        let path = |name: &str| text(&self.path(name)).to_owned();
        let more = more.iter().map(|word| word.strip_prefix('@').map_or_else(|| (*word).to_owned(), path));
        [command.to_owned(), path("study.toml")].into_iter().chain(more).collect()
    }

    fn other(&self, command: &str, more: &[&str]) -> Output {
        let arguments = self.arguments(command, more);
        program().args(arguments).timeout(Duration::from_secs(60)).output().unwrap()
    }

    fn remove_pids(&self) {
        processes(self).iter().for_each(|pid| std::fs::remove_file(self.path(&format!("pid-{pid}"))).unwrap());
    }

    /// As many points as that, and what the formula gives there.
    fn points(&self, count: u32) -> Vec<f64> {
        let x = |k: u32| [f64::from(k) / f64::from(count), f64::from(k % 7), f64::from(k % 11)];
        let lines = (0..count).map(x).map(|[a, b, c]| format!("{a},{b},{c}\n"));
        self.write("points.csv", &format!("x1,x2,x3\n{}", lines.collect::<String>()));
        (0..count).map(x).map(|[a, b, c]| a + 2.0 * b + a * c).collect()
    }
}

const COMMANDS: [(&str, &[&str]); 4] = [
    ("evaluate", &["@points.csv", "-o", "@outputs.csv"]),
    ("screen", &["--out", "@out"]),
    ("sweep", &["--out", "@out"]),
    ("check", &[]),
];

#[test]
fn a_missing_program_ends_every_command_with_the_reason() {
    let case = Case::new("", "").replace("\"python3\", \"model.py\"", "\"no-such-program\"");
    case.points(20);
    let mut messages = messages!();
    for (command, more) in COMMANDS {
        messages.ended(command, 1, &case.other(command, more));
    }
    assert!(
        files(&case.path("")).iter().all(|name| ["study.toml", "model.py", "points.csv", "out"].contains(&&**name))
    );
    assert!(files(&case.path("out")).is_empty());
}

#[test]
fn a_program_that_never_answers_ends_every_command_too() {
    let case = Case::new("retries = 0", "import sys\nsys.exit('no licence')\n");
    case.points(20);
    for (command, more) in &COMMANDS[..3] {
        let output = case.other(command, more);
        assert_eq!(output.status.code(), Some(1), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains("no licence"), "{command}: {}", stderr(&output));
    }
}

/// Writes a file for each process, and takes longer over some rows than over others.
const UNEVEN: &str = "    open(f'pid-{os.getpid()}', 'w')\n    time.sleep(0.004 if x[1] > 3 else 0)\n    answer(y)\n";

#[test]
fn points_are_evaluated_in_several_processes_and_keep_their_order() {
    let case = Case::each_row("", UNEVEN).replace("workers = 2", "workers = 3");
    let expected = case.points(500);
    let output = case.other("evaluate", &["@points.csv", "-o", "@outputs.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let outputs = std::fs::read_to_string(case.path("outputs.csv")).unwrap();
    let mut lines = outputs.lines();
    assert_eq!(lines.next(), Some("y"));
    let found: Vec<f64> = lines.map(|line| line.parse().unwrap()).collect();
    assert_eq!(found, expected);
    assert_eq!(processes(&case).len(), 3);
}

#[test]
fn screening_asks_several_processes_and_says_the_same() {
    let case = Case::each_row("", UNEVEN).replace("workers = 2", "workers = 3");
    let csv = |case: &Case| std::fs::read_to_string(case.path("out/study-screen.csv")).unwrap();
    let output = case.other("screen", &["--out", "@out"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(processes(&case).len(), 3);
    let alone = Case::each_row("", UNEVEN).replace("workers = 2", "workers = 1");
    assert_eq!(alone.other("screen", &["--out", "@out"]).status.code(), Some(0));
    assert_eq!(processes(&alone).len(), 1);
    assert_eq!(csv(&case), csv(&alone));
}

#[cfg(unix)]
#[test]
fn interrupted_commands_leave_neither_files_nor_processes() {
    let hangs = "    n = globals().get('n', 0) + 1\n    open(f'pid-{os.getpid()}', 'w')\n    if n > 3: time.sleep(1000)\n    answer(y)\n";
    let case = Case::each_row("", hangs);
    case.points(100);
    for (command, more) in &COMMANDS[..3] {
        is_interrupted(&case, command, more);
        case.remove_pids();
    }
}

/// A command that hangs in two workers ends on a signal.
#[cfg(unix)]
fn is_interrupted(case: &Case, command: &str, more: &[&str]) {
    let arguments = case.arguments(command, more);
    let mut run = spawn(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    within(60, "two workers hang", || processes(case).len() >= 2);
    std::thread::sleep(Duration::from_millis(300));
    signal("-INT", &run);
    let start = Instant::now();
    let status = run.wait().unwrap();
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
    let mut message = String::new();
    run.stderr.take().unwrap().read_to_string(&mut message).unwrap();
    assert_eq!(status.code(), Some(1), "{message}");
    within(60, "all have ended", || !processes(case).iter().any(is_alive));
    let left = files(&case.path(""))
        .into_iter()
        .filter(|name| !name.starts_with("pid-") && !["out", "outputs.csv.journal"].contains(&&**name));
    assert_eq!(left.collect::<Vec<_>>(), ["model.py", "points.csv", "study.toml"]);
    let in_folder = if case.path("out").exists() { files(&case.path("out")) } else { BTreeSet::new() };
    assert!(in_folder.iter().all(|name| ["study-screen.journal", "study-sweep.journal"].contains(&&**name)));
}
