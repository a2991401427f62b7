//! Interrupted runs through the program: journals, resuming, doubling, shards.

mod parts;

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use crate::common::{HOLES, apportion, stderr, study_path, succeed, text};
use crate::messages::messages;

/// Some 1500 runs of a millisecond: long enough to be interrupted, short enough to be run to its end.
const SLOW: [&str; 4] = ["--set", "afm.fidelity=dynamic", "--base-samples", "256"];

/// Saved outputs are recorded in the journal too.
fn slow(out: &Path, more: &[&str]) -> Vec<String> {
    let study = study_path("lugre-environmental");
    std::fs::create_dir_all(out).unwrap();
    let outputs = out.join("outputs.csv");
    let arguments = ["run", text(&study), "--out", text(out), "--save-outputs", text(&outputs)];
    [&arguments[..], &SLOW, more].concat().iter().map(ToString::to_string).collect()
}

fn words(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

fn spawn(arguments: &[String]) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
    command.args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// The result of a study in a folder, without the fields about the computer.
fn result(folder: &Path, study: &str) -> Vec<String> {
    let json = std::fs::read_to_string(folder.join(format!("{study}.json"))).unwrap();
    let telling = |line: &&str| !line.contains("\"threads\"") && !line.contains("\"wall_seconds\"");
    json.lines().filter(telling).map(str::to_owned).collect()
}

/// The same without the command line.
fn numbers(folder: &Path, study: &str) -> serde_json::Value {
    let json = std::fs::read_to_string(folder.join(format!("{study}.json"))).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&json).unwrap();
    ["threads", "wall_seconds"].iter().for_each(|key| drop(json["provenance"].as_object_mut().unwrap().remove(*key)));
    json["study"]["overrides"] = serde_json::Value::Null;
    json
}

/// Recorded runs at the start of a run, from its note.
fn on_record(messages: &str) -> u64 {
    let said = messages.lines().find_map(|line| line.strip_prefix("note: ")?.split(" of ").next()?.parse().ok());
    said.unwrap_or(0)
}

/// Pseudo-random numbers with a fixed seed (Knuth's MMIX generator).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

fn ended(mut child: Child) -> (Option<i32>, String) {
    let mut messages = String::new();
    child.stderr.take().unwrap().read_to_string(&mut messages).unwrap();
    (child.wait().unwrap().code(), messages)
}

#[test]
fn a_run_killed_twenty_times_has_the_same_bits_and_repeats_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    succeed(&words(&slow(&whole, &["--no-journal"])));
    let expected = result(&whole, "lugre-environmental");
    let (mut kills, mut ends, mut recorded, mut state) = (0, 0, 0, 2026);
    while kills < 20 {
        let mut child = spawn(&slow(&killed, &[]));
        std::thread::sleep(Duration::from_millis(random(&mut state) % 200));
        let ran_on = child.try_wait().unwrap().is_none();
        child.kill().unwrap();
        let (_, messages) = ended(child);
        let now = on_record(&messages);
        assert!(now >= recorded || now == 0, "{now} runs on record, {recorded} before: {messages}");
        recorded = now.max(recorded);
        kills += u64::from(ran_on);
        if !ran_on || kills == 20 {
            succeed(&words(&slow(&killed, &[])));
            assert!(result(&killed, "lugre-environmental") == expected, "after {kills} kills");
            std::fs::remove_dir_all(&killed).unwrap();
            (ends, recorded) = (ends + 1, 0);
        }
    }
    assert!(ends >= 1);
}

#[test]
#[cfg(unix)]
fn a_signal_stops_a_run_cleanly_and_resume_continues_it() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    succeed(&words(&slow(&whole, &[])));
    for name in ["-INT", "-TERM"] {
        let stopped = stopped.join(name);
        let child = spawn(&slow(&stopped, &[]));
        let journal = stopped.join("lugre-environmental.journal");
        wait_for_bytes(&journal, 6000);
        signal(&child, name);
        let (code, messages) = ended(child);
        assert_eq!(code, Some(1), "{messages}");
        assert!(messages.contains("error: ") && messages.contains(" of 1536 runs"), "{messages}");
        assert!(messages.contains("lugre-environmental.journal") && messages.contains("--resume"), "{messages}");
        let resumed = apportion(&words(&slow(&stopped, &["--resume"])));
        assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
        assert!(on_record(&stderr(&resumed)) > 100, "{}", stderr(&resumed));
        assert!(result(&stopped, "lugre-environmental") == result(&whole, "lugre-environmental"));
    }
}

/// Waits until the file at `path` has at least `bytes`.
fn wait_for_bytes(path: &Path, bytes: u64) {
    for _ in 0..6000 {
        if std::fs::metadata(path).is_ok_and(|file| file.len() >= bytes) {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("{} does not grow to {bytes} bytes", path.display());
}

/// A quick run, which keeps a journal only with --journal.
fn ishigami(out: &Path, more: &[&str]) -> Output {
    let study = study_path("ishigami");
    apportion(&[&["run", text(&study), "--out", text(out), "--journal"], more].concat())
}

#[track_caller]
fn ishigami_runs(out: &Path, more: &[&str]) -> u64 {
    let output = ishigami(out, more);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    on_record(&stderr(&output))
}

#[test]
fn a_truncated_or_damaged_journal_is_used_up_to_the_damage() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, cut) = (folder.path().join("whole"), folder.path().join("cut"));
    ishigami_runs(&whole, &["--base-samples", "4096"]);
    let (expected, journal) = (numbers(&whole, "ishigami"), cut.join("ishigami.journal"));
    let bytes = std::fs::read(whole.join("ishigami.journal")).unwrap();
    std::fs::create_dir(&cut).unwrap();
    let mut state = 7;
    for _ in 0..6 {
        let length = bytes.len() as u64 / 4 + random(&mut state) % (bytes.len() as u64 * 3 / 4);
        let mut torn = bytes[..length as usize].to_vec();
        if random(&mut state).is_multiple_of(2) {
            torn[length as usize - 500] ^= 1;
        }
        std::fs::write(&journal, torn).unwrap();
        let output = ishigami(&cut, &["--base-samples", "4096", "--resume"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!((0..20480).contains(&on_record(&stderr(&output))), "{}", stderr(&output));
        assert!(numbers(&cut, "ishigami") == expected);
        // The missing records were written again.
        assert_eq!(ishigami_runs(&cut, &["--base-samples", "4096", "--resume"]), 20480);
    }
}

#[test]
fn a_journal_of_another_study_is_refused_with_the_reason_or_moved_aside() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let small = ["--base-samples", "1024"];
    let mut messages = messages!();
    messages.ended("no journal", 2, &ishigami(out, &["--resume"]));
    ishigami_runs(out, &small);
    let other = |more: &[&str]| ishigami(out, &[&small[..], more].concat());
    for more in [
        &["--resume", "--seed", "9"][..],
        &["--resume", "--set", "factor.x2.max=3"],
        &["--resume", "--set", "function.a=6"],
        &["--retry-failed", "--set", "analysis.second_order=true"],
    ] {
        messages.ended(&more.join(" "), 2, &other(more));
    }
    // Changes that affect no output do not make another study.
    let same = ["--resume", "--set", "analysis.threshold=0.1", "--set", "title=\"Other words\""];
    assert_eq!(ishigami_runs(out, &[&small[..], &same].concat()), 5120);
    // Without --resume the journal is renamed.
    let output = other(&["--seed", "9"]);
    messages.ended("--seed 9", 0, &output);
    assert!(on_record(&stderr(&output)) == 0 && out.join("ishigami.journal.old").is_file());
    std::fs::write(out.join("ishigami.journal"), "x1,x2\n").unwrap();
    messages.ended("no journal but a table", 2, &other(&["--resume"]));
    let before = std::fs::read(out.join("ishigami.journal.old")).unwrap();
    assert_eq!(other(&[]).status.code(), Some(0));
    // Renamed journals are kept.
    assert_eq!(std::fs::read(out.join("ishigami.journal.old2")).unwrap(), b"x1,x2\n");
    assert_eq!(std::fs::read(out.join("ishigami.journal.old")).unwrap(), before);
}

#[test]
fn a_study_may_be_called_by_any_path_and_moved_but_a_changed_program_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let (here, there) = (folder.path().join("here"), folder.path().join("there"));
    let out = folder.path().join("out");
    std::fs::create_dir_all(here.join("sub")).unwrap();
    let study = "model = \"command\"\ncommand = [\"python3\", \"sum.py\"]\noutputs = [\"y\"]\n\
                 design.base_samples = 64\n\
                 [[factor]]\nname = \"a\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 2\n";
    std::fs::write(here.join("sum.toml"), study).unwrap();
    std::fs::write(
        here.join("sum.py"),
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    print(x['id'], float(x['a']) + float(x['b']), sep=',', flush=True)\n",
    )
    .unwrap();
    let run = |path: &Path, more: &[&str]| {
        let output = apportion(&[&["run", text(path), "--out", text(&out)], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stderr(&output)
    };
    assert_eq!(on_record(&run(&here.join("sum.toml"), &[])), 0);
    assert_eq!(on_record(&run(&here.join("sub/../sum.toml"), &[])), 256);
    std::fs::rename(&here, &there).unwrap();
    assert_eq!(on_record(&run(&there.join("sum.toml"), &[])), 256);
    let part = ["--shard", "1/1"];
    run(&there.join("sum.toml"), &part);
    std::fs::write(
        there.join("sum.py"),
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    print(x['id'], float(x['a']) - float(x['b']), sep=',', flush=True)\n",
    )
    .unwrap();
    run(&there.join("sum.toml"), &["--shard", "1/2"]);
    let merge = || apportion(&["merge", text(&there.join("sum.toml")), "--out", text(&out)]);
    let mut messages = messages!();
    messages.ended("parts of two programs", 2, &merge());
    std::fs::remove_file(out.join("sum-shard-1-of-2.journal")).unwrap();
    assert_eq!(merge().status.code(), Some(0));
    // The merged runs are still of the earlier program.
    let again = apportion(&["run", text(&there.join("sum.toml")), "--out", text(&out)]);
    messages.ended("a changed program", 2, &again);
    assert_eq!(on_record(&run(&there.join("sum.toml"), &["--restart"])), 0);
}

#[test]
fn failures_that_come_back_leave_the_result_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("holes.toml");
    std::fs::write(&study, format!("{HOLES}[design]\nbase_samples = 512\n[analysis]\nsurrogate = \"off\"\n")).unwrap();
    let with = |more: &[&str]| {
        let output = apportion(&[&["run", text(&study), "--out", text(folder.path())], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (numbers(folder.path(), "holes"), stderr(&output))
    };
    let (first, _) = with(&["--journal"]);
    let failed = first["outputs"][0]["runs_failed"].as_u64().unwrap();
    assert!(failed > 10);
    let (again, messages) = with(&["--retry-failed"]);
    assert!(messages.contains(&format!("the {failed} runs ")), "{messages}");
    assert_eq!(on_record(&messages.replace("note: the", "")), 2560 - failed, "{messages}");
    assert!(again == first);
}

#[test]
fn retried_failures_are_counted_once() {
    let folder = tempfile::tempdir().unwrap();
    let study = "name = \"still\"\nmodel = \"afm\"\noutputs = [\"critical_force\"]\n[afm]\nfriction = \"lugre\"\n[design]\n\
                 base_samples = 64\n[analysis]\nmax_failed = 0.9\n[[factor]]\nname = \"velocity\"\ndistribution = \"discrete\"\n\
                 values = [0, 100, 200]\nunit = \"nm/s\"\n[[factor]]\nname = \"length\"\nmin = 50\nmax = 700\nunit = \"um\"\n";
    let file = folder.path().join("still.toml");
    std::fs::write(&file, study).unwrap();
    let with = |more: &[&str]| {
        let command = ["run", text(&file), "--out", text(folder.path()), "--journal"];
        let output = apportion(&[&command[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        numbers(folder.path(), "still")
    };
    let first = with(&[]);
    let most = first["provenance"]["model_runs"].as_u64().unwrap();
    let raised = |json: &serde_json::Value| -> Vec<u64> {
        json["validity"].as_array().unwrap().iter().filter_map(|flag| flag["runs"].as_u64()).collect()
    };
    assert!(raised(&first).iter().any(|runs| *runs > 0) && raised(&first).iter().all(|runs| *runs <= most));
    for more in [&["--retry-failed"][..], &["--retry-failed"], &[]] {
        assert!(with(more) == first, "{more:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_ends_a_run_without_loss() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, full) = (folder.path().join("whole"), folder.path().join("full"));
    succeed(&words(&slow(&whole, &["--no-journal"])));
    std::fs::create_dir(&full).unwrap();
    // No file may exceed 8 KiB; beyond it the program gets an error, as on a full disk.
    let program = assert_cmd::cargo::cargo_bin!("apportion");
    let mut limited = Command::new("bash");
    limited.args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$@\"", "bash", text(program)]).args(slow(&full, &[]));
    let output = limited.output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let resumed = apportion(&words(&slow(&full, &["--resume"])));
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert!(on_record(&stderr(&resumed)) > 100, "{}", stderr(&resumed));
    assert!(result(&full, "lugre-environmental") == result(&whole, "lugre-environmental"));
}

#[test]
fn two_runs_do_not_write_one_journal() {
    let folder = tempfile::tempdir().unwrap();
    // Long enough to be still running when the second one starts, on any machine.
    let longer = |argument: String| if argument == SLOW[3] { "262144".to_owned() } else { argument };
    let long: Vec<String> = slow(folder.path(), &[]).into_iter().map(longer).collect();
    let mut first = spawn(&long);
    wait_for_bytes(&folder.path().join("lugre-environmental.journal"), 3000);
    let second = apportion(&words(&long));
    messages!().ended("the second run", 1, &second);
    first.kill().unwrap();
    first.wait().unwrap();
}

#[test]
fn a_quick_run_keeps_no_journal_and_grows_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (grown, long) = (folder.path().join("grown"), folder.path().join("long"));
    let study = study_path("ishigami");
    let run = |out: &Path, more: &[&str]| apportion(&[&["run", text(&study), "--out", text(out)], more].concat());
    assert_eq!(run(&grown, &["--base-samples", "512"]).status.code(), Some(0));
    assert!(!grown.join("ishigami.journal").exists());
    assert_eq!(run(&grown, &["--base-samples", "512", "--resume"]).status.code(), Some(2));
    assert_eq!(run(&grown, &["--base-samples", "1024"]).status.code(), Some(0));
    assert_eq!(run(&long, &["--base-samples", "1024"]).status.code(), Some(0));
    assert!(numbers(&grown, "ishigami") == numbers(&long, "ishigami"));
}

#[test]
fn a_journal_of_another_format_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("ishigami.journal");
    std::fs::write(&journal, b"apportion journal\x02\0\0\0\x02\0\0\0\x43\xbf\xa6\xa3{}").unwrap();
    messages!().ended("format 2", 2, &ishigami(folder.path(), &["--base-samples", "64", "--resume"]));
    assert_eq!(ishigami_runs(folder.path(), &["--base-samples", "64"]), 0);
    assert!(folder.path().join("ishigami.journal.old").is_file());
}
