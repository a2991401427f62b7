//! Shards of a run, and their merged result.

use std::path::PathBuf;
use std::process::Command;

use super::{ishigami, ishigami_runs, numbers};
use crate::common::{apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

#[test]
fn a_refused_merge_does_not_change_recorded_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let small = ["--base-samples", "256"];
    ishigami_runs(out, &small);
    for part in ["1/2", "2/2"] {
        assert_eq!(ishigami(out, &["--base-samples", "256", "--shard", part]).status.code(), Some(0));
    }
    let journal = std::fs::read(out.join("ishigami.journal")).unwrap();
    let study = study_path("ishigami");
    let merge = |more: &[&str]| {
        apportion(&[&["merge", text(&study), "--out", text(out), "--base-samples", "256"], more].concat())
    };
    let mut messages = messages!();
    for case in ["once", "again"] {
        messages.ended(case, 2, &merge(&["--set", "factor.x2.max=3"]));
    }
    assert_eq!(std::fs::read(out.join("ishigami.journal")).unwrap(), journal);
    assert!(!out.join("ishigami.journal.old").exists());
    assert_eq!(merge(&[]).status.code(), Some(0));
}

#[test]
fn parts_add_to_what_an_interrupted_run_and_other_parts_have_done() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("out"), folder.path().join("whole"));
    let size = ["--base-samples", "4096"];
    ishigami_runs(&whole, &size);
    // A truncated journal is that of an interrupted run.
    ishigami_runs(&out, &size);
    let journal = out.join("ishigami.journal");
    let bytes = std::fs::read(&journal).unwrap();
    std::fs::write(&journal, &bytes[..bytes.len() / 3]).unwrap();
    for part in ["1/3", "2/3", "3/3", "2/5"] {
        assert_eq!(ishigami(&out, &[&size[..], &["--shard", part]].concat()).status.code(), Some(0));
    }
    let study = study_path("ishigami");
    let merged = apportion(&[&["merge", text(&study), "--out", text(&out)], &size[..]].concat());
    assert_eq!(merged.status.code(), Some(0), "{}", stderr(&merged));
    assert!(numbers(&out, "ishigami") == numbers(&whole, "ishigami"));
}

#[test]
fn shards_of_any_machine_merge_to_the_bits_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let small = ["--base-samples", "1024"];
    ishigami_runs(&whole, &small);
    let study = study_path("ishigami");
    let merge =
        |more: &[&str]| apportion(&[&["merge", text(&study), "--out", text(&parts)], &small[..], more].concat());
    for shard in ["3/3", "1/3"] {
        ishigami_runs(&parts, &[&small[..], &["--shard", shard]].concat());
    }
    let mut messages = messages!();
    messages.ended("a part is missing", 1, &merge(&[]));
    ishigami_runs(&parts, &[&small[..], &["--shard", "2/3"]].concat());
    // An existing shard is not evaluated again.
    assert!(ishigami_runs(&parts, &[&small[..], &["--shard", "2/3", "--resume"]].concat()) > 0);
    let merged = merge(&[]);
    assert_eq!(merged.status.code(), Some(0), "{}", stderr(&merged));
    assert!(numbers(&parts, "ishigami") == numbers(&whole, "ishigami"));
    // Merging again changes nothing; the merged journal can be resumed.
    assert_eq!(merge(&[]).status.code(), Some(0));
    assert_eq!(ishigami_runs(&parts, &["--base-samples", "1024"]), 5120);

    let other = apportion(&[&["merge", text(&study), "--out", text(&parts), "--seed", "2"], &small[..]].concat());
    messages.ended("another seed", 2, &other);
    assert!(!parts.join("ishigami.journal.old").exists(), "nothing is touched before all is known to fit");
    let empty = folder.path().join("empty");
    messages.refused(&["merge", text(&study), "--out", text(&empty)]);
    for more in [&["--shard", "4/3"][..], &["--shard", "1/2", "--set", "design.max_runs=100000"]] {
        messages.ended(&more.join(" "), 2, &ishigami(&parts, more));
    }
}

/// The commands of `docs/guide/clusters.md` for GNU parallel, with its replacement on this machine.
#[test]
#[cfg(unix)]
fn a_job_array_on_one_machine() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    ishigami_runs(&whole, &["--base-samples", "1024"]);
    let has =
        |program: &str| Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    let run = "run \"$STUDY\" --base-samples 1024 --threads 1 --out \"$OUT\" --shard";
    let line = if has("parallel") {
        format!("parallel --will-cite --jobs 2 '\"$APPORTION\" {run} {{}}/4' ::: 1 2 3 4")
    } else {
        eprintln!("GNU parallel is not here: xargs stands for it");
        format!("printf '%s\\n' 1 2 3 4 | xargs -P 2 -I {{}} sh -c '\"$APPORTION\" {run} {{}}/4'")
    };
    let mut shell = Command::new("bash");
    shell.args(["-c", &line]).env("APPORTION", assert_cmd::cargo::cargo_bin!("apportion"));
    let output = shell.env("STUDY", study_path("ishigami")).env("OUT", &parts).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    succeed(&["merge", text(&study_path("ishigami")), "--base-samples", "1024", "--out", text(&parts)]);
    assert!(numbers(&parts, "ishigami") == numbers(&whole, "ishigami"));
    let journals: Vec<PathBuf> = (1..=4).map(|i| parts.join(format!("ishigami-shard-{i}-of-4.journal"))).collect();
    assert!(journals.iter().all(|journal| journal.is_file()));
}
