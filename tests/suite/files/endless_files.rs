//! Files that never end are refused, and pipes that do end are read.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::common::{Folder, text};
use crate::messages::messages;

const STUDY: &str = "model = \"ishigami\"\n[design]\nbase_samples = 64\n";

#[cfg(target_os = "linux")]
#[test]
fn files_without_an_end_are_refused() {
    let folder = Folder::new();
    let (study, mut messages) = (folder.with("study.toml", STUDY), messages!());
    messages.refused(&["check", "/dev/zero"]);
    messages.refused(&["report", "/dev/zero"]);
    messages.refused(&["given-data", "/dev/zero", "--outputs", "y"]);
    let measured =
        "model = \"ishigami\"\n[[factor]]\nname = \"x1\"\ndistribution = \"empirical\"\nfile = \"/dev/zero\"\n";
    messages.refused(&["check", text(&folder.with("measured.toml", measured))]);
    let outputs = folder.path("outputs.csv");
    messages.refused(&["evaluate", text(&study), "/dev/zero", "-o", text(&outputs)]);
    assert!(!outputs.exists());
    let endless = folder.path("endless.csv");
    std::os::unix::fs::symlink("/dev/zero", &endless).unwrap();
    let manifest = folder.path("endless.csv.manifest.json");
    std::os::unix::fs::symlink("/dev/zero", &manifest).unwrap();
    messages.refused(&["analyze", text(&endless)]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_journal_without_an_end_is_refused() {
    let folder = Folder::new();
    let study = folder.with("study.toml", STUDY);
    let out = folder.path("out");
    std::fs::create_dir(&out).unwrap();
    std::os::unix::fs::symlink("/dev/zero", out.join("study.journal")).unwrap();
    messages!().refused(&["run", text(&study), "--out", text(&out), "--resume"]);
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
