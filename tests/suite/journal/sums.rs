//! Journals of quick models, which hold the sums of the runs.

use std::path::Path;
use std::process::Output;
use std::time::Duration;

#[cfg(unix)]
use super::signal;
use super::{ended, ishigami, numbers, on_record, random, refused, result, spawn, words};
use crate::common::{apportion, stderr, study_path, succeed, text};

/// A run of a million quick rows, whose sums are on record.
fn quick(out: &Path, more: &[&str]) -> Vec<String> {
    let study = study_path("coulomb-general");
    let arguments = ["run", text(&study), "--out", text(out), "--base-samples", "131072"];
    [&arguments[..], more].concat().iter().map(ToString::to_string).collect()
}

/// Without surrogates, which need the outputs of all runs: the journal holds sums.
fn sums(out: &Path, more: &[&str]) -> Output {
    ishigami(out, &[&["--set", "analysis.surrogate=\"off\""], more].concat())
}

#[track_caller]
fn sums_runs(out: &Path, more: &[&str]) -> u64 {
    let output = sums(out, more);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    on_record(&stderr(&output))
}

#[test]
fn the_journal_of_a_quick_run_does_not_grow_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("ishigami.journal");
    let size = |base_samples: &str| {
        assert_eq!(ishigami(folder.path(), &["--base-samples", base_samples]).status.code(), Some(0));
        std::fs::metadata(&journal).unwrap().len()
    };
    // Beyond the values that are kept for charts.
    let sizes = ["65536", "131072", "524288"].map(size);
    assert!(sizes[2] < 2_000_000 && sizes[2] <= sizes[0] + sizes[0] / 4, "{sizes:?}");
}

#[test]
fn a_quick_run_killed_at_any_moment_ends_in_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    succeed(&words(&quick(&whole, &["--no-journal"])));
    let (journal, mut state, mut recorded) = (killed.join("coulomb-general.journal"), 7, 0);
    for round in 0..3 {
        for _ in 0..4 {
            let mut child = spawn(&quick(&killed, &[]));
            std::thread::sleep(Duration::from_millis(random(&mut state) % 500));
            child.kill().unwrap();
            let (_, messages) = ended(child);
            assert!(!messages.contains("moved"), "a journal of no use after a kill: {messages}");
            recorded += on_record(&messages);
            if journal.exists() {
                // Before the first sums there is a header alone.
                let contents = apportion::run::journal::read_journal_file(&journal).unwrap();
                assert!(contents.sums.is_some() || contents.pieces.is_empty());
            }
        }
        succeed(&words(&quick(&killed, &[])));
        assert!(result(&killed, "coulomb-general") == result(&whole, "coulomb-general"), "round {round}");
        // Whatever a kill may have left behind is gone or overwritten.
        assert!(!killed.join("coulomb-general.journal.new").exists());
        std::fs::remove_dir_all(&killed).unwrap();
    }
    eprintln!("{recorded} runs were on record after kills");
}

/// Waits until runs are on record.
#[cfg(unix)]
fn wait_for_sums(journal: &Path) {
    for _ in 0..6000 {
        let contents = apportion::run::journal::read_journal_file(journal);
        if contents.is_ok_and(|contents| contents.sums.is_some_and(|sums| sums.rows() > 0)) {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("{} gets no sums", journal.display());
}

#[test]
#[cfg(unix)]
fn a_quick_run_that_is_interrupted_goes_on_and_grows() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    let long = ["--base-samples", "2097152"];
    let arguments = |out: &Path, more: &[&str]| {
        let study = study_path("coulomb-general");
        let all = [&["run", text(&study), "--out", text(out)], more].concat();
        all.iter().map(ToString::to_string).collect::<Vec<String>>()
    };
    succeed(&words(&arguments(&whole, &long)));
    let child = spawn(&arguments(&stopped, &long));
    let journal = stopped.join("coulomb-general.journal");
    wait_for_sums(&journal);
    // It stands still for as long as another run takes to start.
    signal(&child, "-STOP");
    let second = apportion(&words(&arguments(&stopped, &long)));
    signal(&child, "-INT");
    signal(&child, "-CONT");
    let (code, messages) = ended(child);
    if code == Some(0) {
        eprintln!("the run was over before it was interrupted");
        return;
    }
    refused(&second, 1, "coulomb-general.journal: another run is writing this journal");
    assert!(messages.contains("error: interrupted after "), "{messages}");
    assert!(messages.contains("the same command with --resume goes on"), "{messages}");
    let resumed = apportion(&words(&arguments(&stopped, &[&long[..], &["--resume"]].concat())));
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert!(on_record(&stderr(&resumed)) > 0, "{}", stderr(&resumed));
    assert!(numbers(&stopped, "coulomb-general") == numbers(&whole, "coulomb-general"));
}

#[test]
fn a_damaged_journal_of_sums_is_never_used() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, damaged) = (folder.path().join("whole"), folder.path().join("damaged"));
    let size = ["--base-samples", "4096"];
    sums_runs(&whole, &size);
    let bytes = std::fs::read(whole.join("ishigami.journal")).unwrap();
    std::fs::create_dir(&damaged).unwrap();
    let journal = damaged.join("ishigami.journal");
    for place in [bytes.len() / 2, bytes.len() - 1] {
        let mut torn = bytes.clone();
        torn[place] ^= 1;
        for torn in [&torn[..], &bytes[..place]] {
            std::fs::write(&journal, torn).unwrap();
            refused(&sums(&damaged, &[&size[..], &["--resume"]].concat()), 2, "its sums are damaged");
            let anew = sums(&damaged, &size);
            assert!(stderr(&anew).contains("its sums are damaged: the journal was moved to "), "{}", stderr(&anew));
            assert!(numbers(&damaged, "ishigami") == numbers(&whole, "ishigami"));
        }
    }
}

#[test]
fn a_finished_study_goes_on_with_every_run_it_has() {
    let folder = tempfile::tempdir().unwrap();
    let (long, grown) = (folder.path().join("long"), folder.path().join("grown"));
    refused(&sums(&grown, &["--double"]), 2, "--double: there is no result to double");
    assert_eq!(sums_runs(&grown, &["--base-samples", "1024"]), 0);
    assert_eq!(sums_runs(&grown, &["--double"]), 1024 * 5);
    assert_eq!(sums_runs(&grown, &["--double"]), 2048 * 5);
    assert_eq!(sums_runs(&grown, &["--base-samples", "8192"]), 4096 * 5);
    assert_eq!(sums_runs(&long, &["--base-samples", "8192"]), 0);
    assert!(numbers(&grown, "ishigami") == numbers(&long, "ishigami"));
    // Sums cannot be divided: a shorter run leaves them as they are. With --restart nothing is on record.
    let fewer = sums(&grown, &["--base-samples", "1024"]);
    assert!(stderr(&fewer).contains("the sums of 8192 base samples, which cannot be divided"), "{}", stderr(&fewer));
    refused(
        &sums(&grown, &["--base-samples", "1024", "--resume"]),
        2,
        "ask for as many or more, or leave out --resume",
    );
    assert_eq!(sums_runs(&grown, &["--base-samples", "8192"]), 8192 * 5);
    assert_eq!(sums_runs(&grown, &["--base-samples", "1024", "--no-journal"]), 0);
    assert_eq!(sums_runs(&grown, &["--base-samples", "1024", "--restart"]), 0);
    assert_eq!(sums_runs(&grown, &["--base-samples", "1024"]), 1024 * 5);
    // Outputs are not in the sums, but sums are made of outputs.
    let saved = folder.path().join("outputs.csv");
    let save = ["--base-samples", "1024", "--save-outputs", text(&saved)];
    refused(
        &sums(&grown, &[&save[..], &["--resume"]].concat()),
        2,
        "holds the sums of the runs, and their outputs are needed",
    );
    let anew = sums(&grown, &save);
    assert!(stderr(&anew).contains("their outputs are needed: the journal was moved to "), "{}", stderr(&anew));
    assert_eq!(sums_runs(&grown, &["--double"]), 1024 * 5);
}
