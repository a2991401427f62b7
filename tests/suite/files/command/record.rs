//! Recorded answers of programs are not requested again.

use std::collections::BTreeSet;

use apportion::result::StudyResult;
use apportion::run::journal::read_journal;

use super::processes::{is_alive, processes, signal, spawn, within};
use super::{Case, FORMULA, by_formula, rows_where};
use crate::common::{numbers, stderr, text};

/// Writes every row that the program gets to the file `asked`.
const NOTES: &str = "    with open('asked', 'a') as log: log.write(line)\n";

/// The rows requested since the last call.
fn asked(case: &Case) -> Vec<String> {
    let rows = std::fs::read_to_string(case.path("asked")).unwrap_or_default();
    let _ = std::fs::remove_file(case.path("asked"));
    rows.lines().map(str::to_owned).collect()
}

/// A result without the fields about the computer.
fn without_times(mut result: StudyResult) -> StudyResult {
    (result.provenance.threads, result.provenance.wall_seconds) = (0, 0.0);
    result
}

#[test]
fn only_rows_that_failed_are_asked_again_and_the_result_is_that_of_a_run_without_failures() {
    let licence =
        "    has_one = x[0] <= 0.9 or os.path.exists('licence')\n    answer(y if has_one else 'error: no licence')\n";
    let new = || Case::each_row("", &format!("{NOTES}{licence}"));
    let (case, sound) = (new(), new());
    let bad = rows_where(|x| x > 0.9);
    let (first, _) = case.result();
    // One of them is repeated at the end, to detect a random program.
    assert_eq!((first.outputs[0].runs_failed, asked(&case).len()), (bad, 161));
    case.write("licence", "");
    let retried = case.run_with(&["--retry-failed"]);
    assert_eq!(retried.status.code(), Some(0), "{}", stderr(&retried));
    assert!(stderr(&retried).contains(&format!("the {bad} runs ")), "{}", stderr(&retried));
    let again = asked(&case);
    assert_eq!(again.len() as u64, bad);
    assert!(again.iter().all(|row| row.split(',').next().unwrap().parse::<f64>().unwrap() > 0.9), "{again:?}");
    sound.write("licence", "");
    let (expected, _) = sound.result();
    assert_eq!(without_times(case.result_file()), without_times(expected));
}

#[cfg(target_os = "linux")]
#[test]
fn a_killed_engine_repeats_no_recorded_row_and_leaves_no_process() {
    // With 4 ms a row, blocks that take 0.2 s have at most 50 rows.
    const IN_FLIGHT: usize = 2 * 50;
    const ROWS: usize = 512 * 5;
    let slow = format!("{NOTES}    open(f'pid-{{os.getpid()}}', 'w')\n    time.sleep(0.004)\n    answer(y)\n");
    let case = Case::each_row("", &slow).replace("base_samples = 32", "base_samples = 512");
    let journal = case.path("out/study.journal");
    let on_record = || -> usize {
        let contents = read_journal(&journal, &std::fs::read(&journal).unwrap()).unwrap();
        contents.blocks.iter().map(|block| block.rows(1) as usize).sum()
    };
    let (study, out) = (case.path("study.toml"), case.path("out"));
    let arguments = ["run", text(&study), "--out", text(&out)];
    let (mut before, mut seen) = (0, BTreeSet::new());
    for moment in [300, 700] {
        let resume: &[&str] = if before == 0 { &[] } else { &["--resume"] };
        let mut run = spawn(&[&arguments[..], resume].concat());
        let noted = || std::fs::read_to_string(case.path("asked")).unwrap_or_default().lines().count();
        within(60, "rows are asked", || noted() >= moment);
        signal("-KILL", &run);
        run.wait().unwrap();
        within(60, "all have ended", || !processes(&case).iter().any(is_alive));
        let (now, rows) = (on_record(), asked(&case));
        assert!(now > before && now - before <= rows.len(), "{before} {now} {}", rows.len());
        assert!(rows.len() - (now - before) <= IN_FLIGHT, "{before} {now} {}", rows.len());
        seen.extend(rows);
        before = now;
    }
    let resumed = case.run_with(&["--resume"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert!(stderr(&resumed).contains(&format!("{before} of {ROWS} runs ")), "{}", stderr(&resumed));
    let rows = asked(&case);
    // Each unrecorded row once; and at the end some of all rows again, to detect a random program.
    let (evaluated, again) = rows.split_at(ROWS - before);
    assert_eq!(again.len(), (evaluated.len() / 100).clamp(1, 16));
    assert_eq!(evaluated.iter().collect::<BTreeSet<_>>().len(), evaluated.len());
    seen.extend(rows);
    assert_eq!(seen.len(), ROWS);
    within(60, "all have ended", || !processes(&case).iter().any(is_alive));
    assert_eq!(numbers(&case.result_file().outputs[0]), numbers(&by_formula(&case, FORMULA).outputs[0]));
}

/// Runs a program that answers in 10 ms and, once some rows are on record, `changes` the case; the run must fail.
#[cfg(unix)]
fn changed_during_a_run(changes: impl Fn(&Case)) -> Case {
    let case = Case::each_row("", &format!("{NOTES}    time.sleep(0.01)\n    answer(y)\n"));
    let case = case.replace("base_samples = 32", "base_samples = 256");
    let mut run = spawn(&["run", text(&case.path("study.toml")), "--out", text(&case.path("out"))]);
    within(60, "rows are asked", || std::fs::read_to_string(case.path("asked")).is_ok_and(|rows| rows.len() > 8000));
    changes(&case);
    assert_eq!(run.wait().unwrap().code(), Some(1));
    assert!(!case.path("out/study.json").exists());
    case
}

#[cfg(unix)]
#[test]
fn a_program_that_changes_during_a_run_is_noticed_and_its_rows_are_not_recorded() {
    let case = changed_during_a_run(|case| {
        let program = std::fs::read_to_string(case.path("model.py")).unwrap();
        case.write("model.py", &program.replace("2*x[1]", "3*x[1]"));
    });
    assert_eq!(case.run_with(&["--resume"]).status.code(), Some(2));
    // Once the change is undone, the recorded runs are those of this program.
    let program = std::fs::read_to_string(case.path("model.py")).unwrap();
    case.write("model.py", &program.replace("3*x[1]", "2*x[1]"));
    let resumed = case.run_with(&["--resume"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert_eq!(numbers(&case.result_file().outputs[0]), numbers(&by_formula(&case, FORMULA).outputs[0]));
}

#[cfg(unix)]
#[test]
fn a_journal_that_is_removed_or_cut_off_during_a_run_is_noticed() {
    let journal = |case: &Case| case.path("out/study.journal");
    changed_during_a_run(|case| std::fs::remove_file(journal(case)).unwrap());
    changed_during_a_run(|case| {
        std::fs::File::options().write(true).open(journal(case)).unwrap().set_len(900).unwrap()
    });
}
