//! Files that never end are refused, and pipes that do end are read.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::common::{Folder, apportion, stderr, text};

const STUDY: &str = "model = \"ishigami\"\n[design]\nbase_samples = 64\n";

/// Fails with exit code 2, with the message that the file has no end.
#[track_caller]
fn is_refused(arguments: &[&str], expected: &str) {
    let output = apportion(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(expected), "{arguments:?}: {message}");
}

#[cfg(target_os = "linux")]
#[test]
fn files_without_an_end_are_refused() {
    const NO_END: &str = "it is not a regular file and exceeds 256 MiB or has no end";
    let folder = Folder::new();
    let study = folder.with("study.toml", STUDY);
    is_refused(&["check", "/dev/zero"], &format!("/dev/zero: cannot read the study file: {NO_END}"));
    is_refused(&["report", "/dev/zero"], NO_END);
    is_refused(&["given-data", "/dev/zero", "--outputs", "y"], NO_END);
    let measured =
        "model = \"ishigami\"\n[[factor]]\nname = \"x1\"\ndistribution = \"empirical\"\nfile = \"/dev/zero\"\n";
    is_refused(&["check", text(&folder.with("measured.toml", measured))], NO_END);
    let outputs = folder.path("outputs.csv");
    is_refused(&["evaluate", text(&study), "/dev/zero", "-o", text(&outputs)], "a line of more than 16 MiB");
    assert!(!outputs.exists());
    let endless = folder.path("endless.csv");
    std::os::unix::fs::symlink("/dev/zero", &endless).unwrap();
    let manifest = folder.path("endless.csv.manifest.json");
    std::os::unix::fs::symlink("/dev/zero", &manifest).unwrap();
    is_refused(&["analyze", text(&endless)], NO_END);
    is_refused(&["analyze", text(&endless), "--layout", "salib", "--names", "a,b"], "a line of more than 16 MiB");
}

#[cfg(target_os = "linux")]
#[test]
fn a_journal_without_an_end_is_refused() {
    let folder = Folder::new();
    let study = folder.with("study.toml", STUDY);
    let out = folder.path("out");
    std::fs::create_dir(&out).unwrap();
    std::os::unix::fs::symlink("/dev/zero", out.join("study.journal")).unwrap();
    let output = apportion(&["run", text(&study), "--out", text(&out), "--resume"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("a pipe, a device or a folder has the name of the journal"),
        "{}",
        stderr(&output)
    );
}

#[cfg(unix)]
#[test]
fn a_study_may_come_through_a_pipe() {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
    let mut check = command.args(["check", "/dev/stdin"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    check.stdin.take().unwrap().write_all(STUDY.as_bytes()).unwrap();
    let output = check.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8(output.stdout).unwrap().contains("320"));
}
