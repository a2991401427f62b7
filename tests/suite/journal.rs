//! Interrupted is not lost: journals, resuming, doubling, shards, through the program.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use crate::common::{apportion, stderr, study_path, succeed, text};

/// Some 1500 runs of a millisecond: long enough to be interrupted, short enough to be run to its end.
const SLOW: [&str; 4] = ["--set", "afm.fidelity=dynamic", "--base-samples", "256"];

/// Outputs that are saved are put on record too.
fn slow(out: &Path, more: &[&str]) -> Vec<String> {
    let study = study_path("lugre-environmental");
    std::fs::create_dir_all(out).unwrap();
    let outputs = out.join("outputs.csv");
    let arguments = ["run", text(&study), "--out", text(out), "--save-outputs", text(&outputs)];
    [&arguments[..], &SLOW, more].concat().iter().map(ToString::to_string).collect()
}

/// A run of 393,216 quick rows, whose sums are on record.
fn quick(out: &Path, more: &[&str]) -> Vec<String> {
    let study = study_path("coulomb-general");
    let arguments = ["run", text(&study), "--out", text(out), "--base-samples", "32768"];
    [&arguments[..], more].concat().iter().map(ToString::to_string).collect()
}

fn words(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

fn spawn(arguments: &[String]) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
    command.args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// The result of a study in a folder, but for what tells about the computer.
fn result(folder: &Path, study: &str) -> Vec<String> {
    let json = std::fs::read_to_string(folder.join(format!("{study}.json"))).unwrap();
    let telling = |line: &&str| !line.contains("\"threads\"") && !line.contains("\"wall_seconds\"");
    json.lines().filter(telling).map(str::to_owned).collect()
}

/// The same without what was asked on the command line.
fn numbers(folder: &Path, study: &str) -> serde_json::Value {
    let json = std::fs::read_to_string(folder.join(format!("{study}.json"))).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&json).unwrap();
    ["threads", "wall_seconds"].iter().for_each(|key| drop(json["provenance"].as_object_mut().unwrap().remove(*key)));
    json["study"]["overrides"] = serde_json::Value::Null;
    json
}

/// Runs on record when a run began, by what it said.
fn on_record(messages: &str) -> u64 {
    let said = messages.lines().find_map(|line| line.strip_prefix("note: ")?.split(" of ").next()?.parse().ok());
    said.unwrap_or(0)
}

/// Numbers that look random and are the same every time (Knuth's MMIX generator).
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
fn a_run_killed_at_fifty_moments_ends_in_the_same_bits_and_repeats_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    succeed(&words(&slow(&whole, &["--no-journal"])));
    let expected = result(&whole, "lugre-environmental");
    let (mut kills, mut ends, mut recorded, mut state) = (0, 0, 0, 2026);
    while kills < 50 {
        let mut child = spawn(&slow(&killed, &[]));
        std::thread::sleep(Duration::from_millis(random(&mut state) % 200));
        let ran_on = child.try_wait().unwrap().is_none();
        child.kill().unwrap();
        let (_, messages) = ended(child);
        let now = on_record(&messages);
        assert!(now >= recorded || now == 0, "{now} runs on record, {recorded} before: {messages}");
        recorded = now.max(recorded);
        kills += u64::from(ran_on);
        if !ran_on || kills == 50 {
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
fn a_signal_ends_a_run_in_order_and_resume_goes_on() {
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
        assert!(messages.contains("error: interrupted after ") && messages.contains(" of 1536 runs"), "{messages}");
        assert!(messages.contains("lugre-environmental.journal: the same command with --resume goes on"), "{messages}");
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

fn ishigami(out: &Path, more: &[&str]) -> Output {
    let study = study_path("ishigami");
    apportion(&[&["run", text(&study), "--out", text(out)], more].concat())
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

#[track_caller]
fn ishigami_runs(out: &Path, more: &[&str]) -> u64 {
    let output = ishigami(out, more);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    on_record(&stderr(&output))
}

#[track_caller]
fn refused(output: &Output, code: i32, expected: &str) {
    assert_eq!(output.status.code(), Some(code), "{}", stderr(output));
    assert!(stderr(output).contains(expected), "no {expected:?} in {}", stderr(output));
}

#[test]
fn a_journal_that_was_cut_short_or_damaged_is_used_as_far_as_it_goes() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, cut) = (folder.path().join("whole"), folder.path().join("cut"));
    let saved = folder.path().join("outputs.csv");
    ishigami_runs(&whole, &["--base-samples", "4096", "--save-outputs", text(&saved)]);
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
        assert!(stderr(&output).contains("bytes were cut off behind its last whole record"), "{}", stderr(&output));
        assert!((0..20480).contains(&on_record(&stderr(&output))), "{}", stderr(&output));
        assert!(numbers(&cut, "ishigami") == expected);
        // What was cut off has been made good.
        assert_eq!(ishigami_runs(&cut, &["--base-samples", "4096", "--resume"]), 20480);
    }
}

#[test]
fn a_journal_of_another_study_is_refused_with_the_reason_or_moved_aside() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let small = ["--base-samples", "1024"];
    refused(&ishigami(out, &["--resume"]), 2, "there is no journal here: nothing is on record to go on with");
    ishigami_runs(out, &small);
    let other = |more: &[&str]| ishigami(out, &[&small[..], more].concat());
    refused(&other(&["--resume", "--seed", "9"]), 2, "of another study (ishigami): design.seed was 0 and is now 9");
    let changed = other(&["--resume", "--set", "factor.x2.max=3"]);
    refused(&changed, 2, "factors.x2.distribution.max was 3.14");
    refused(&other(&["--resume", "--set", "function.a=6"]), 2, "settings.a was 7 and is now 6");
    refused(&other(&["--retry-failed", "--set", "analysis.second_order=true"]), 2, "design.rows_per_point was 5");
    // What changes no output is no other study.
    let same = ["--resume", "--set", "analysis.threshold=0.1", "--set", "title=\"Other words\""];
    assert_eq!(ishigami_runs(out, &[&small[..], &same].concat()), 5120);
    // Without --resume the journal makes way.
    let output = other(&["--seed", "9"]);
    assert_eq!((output.status.code(), on_record(&stderr(&output))), (Some(0), 0));
    assert!(stderr(&output).contains(": the journal was moved to ") && out.join("ishigami.journal.old").is_file());
    std::fs::write(out.join("ishigami.journal"), "x1,x2\n").unwrap();
    refused(&other(&["--resume"]), 2, "this is no journal of a run: it does not begin as one");
    let before = std::fs::read(out.join("ishigami.journal.old")).unwrap();
    assert_eq!(other(&[]).status.code(), Some(0));
    // Nothing that was moved aside is lost.
    assert_eq!(std::fs::read(out.join("ishigami.journal.old2")).unwrap(), b"x1,x2\n");
    assert_eq!(std::fs::read(out.join("ishigami.journal.old")).unwrap(), before);
}

#[test]
fn a_merge_that_is_refused_leaves_the_runs_on_record_alone() {
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
    for _ in 0..2 {
        refused(
            &merge(&["--set", "factor.x2.max=3"]),
            2,
            "ishigami-shard-1-of-2.journal: the journal is of another study",
        );
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
    // A journal that was cut short is that of a run that was interrupted.
    let saved = folder.path().join("outputs.csv");
    ishigami_runs(&out, &[&size[..], &["--save-outputs", text(&saved)]].concat());
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
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    print(float(x['a']) + float(x['b']), flush=True)\n",
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
        "import csv, sys\nfor x in csv.DictReader(sys.stdin):\n    print(float(x['a']) - float(x['b']), flush=True)\n",
    )
    .unwrap();
    run(&there.join("sum.toml"), &["--shard", "1/2"]);
    let merge = || apportion(&["merge", text(&there.join("sum.toml")), "--out", text(&out)]);
    refused(&merge(), 2, "sum-shard-1-of-2.journal: evaluated with another sum.py than ");
    std::fs::remove_file(out.join("sum-shard-1-of-2.journal")).unwrap();
    assert_eq!(merge().status.code(), Some(0));
    // What was merged is still of the program before.
    let anew = run(&there.join("sum.toml"), &[]);
    assert_eq!(on_record(&anew), 0, "{anew}");
    assert!(anew.contains("sum.py changed since the journal was written: the journal was moved to "), "{anew}");
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

#[test]
fn failures_that_come_back_leave_the_result_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("holes.toml");
    std::fs::write(
        &study,
        "model = \"ishigami-holes\"\n[design]\nbase_samples = 512\n[analysis]\nsurrogate = \"off\"\n",
    )
    .unwrap();
    let saved = folder.path().join("outputs.csv");
    let with = |more: &[&str]| {
        let output = apportion(&[&["run", text(&study), "--out", text(folder.path())], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (numbers(folder.path(), "holes"), stderr(&output))
    };
    let (first, _) = with(&["--save-outputs", text(&saved)]);
    let failed = first["outputs"][0]["runs_failed"].as_u64().unwrap();
    assert!(failed > 10);
    let (again, messages) = with(&["--retry-failed"]);
    assert!(messages.contains(&format!("the {failed} runs that failed are evaluated again")), "{messages}");
    assert_eq!(on_record(&messages.replace("note: the", "")), 2560 - failed, "{messages}");
    assert!(again == first);
    // Sums say nothing of single runs.
    let bits = |json: &serde_json::Value| json["outputs"].clone();
    with(&["--base-samples", "1024", "--restart"]);
    let (again, messages) = with(&["--base-samples", "1024", "--retry-failed"]);
    assert!(messages.contains("the journal holds sums: all runs are evaluated anew"), "{messages}");
    assert_eq!(on_record(&messages), 0);
    assert!(bits(&again) == bits(&with(&["--base-samples", "1024", "--no-journal"]).0));
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
    refused(&merge(&[]), 1, "1705 of 5120 runs are missing: there is no journal of shard 2/3");
    ishigami_runs(&parts, &[&small[..], &["--shard", "2/3"]].concat());
    // A shard that is there is not evaluated again.
    assert!(ishigami_runs(&parts, &[&small[..], &["--shard", "2/3", "--resume"]].concat()) > 0);
    let merged = merge(&[]);
    assert_eq!(merged.status.code(), Some(0), "{}", stderr(&merged));
    assert!(numbers(&parts, "ishigami") == numbers(&whole, "ishigami"));
    // Merging again changes nothing; the merged journal is one to go on with.
    assert_eq!(merge(&[]).status.code(), Some(0));
    assert_eq!(ishigami_runs(&parts, &["--double"]), 5120);

    let other = apportion(&[&["merge", text(&study), "--out", text(&parts), "--seed", "2"], &small[..]].concat());
    refused(&other, 2, "design.seed was 0 and is now 2");
    assert!(!parts.join("ishigami.journal.old").exists(), "nothing is touched before all is known to fit");
    let empty = folder.path().join("empty");
    refused(&apportion(&["merge", text(&study), "--out", text(&empty)]), 2, "no ishigami-shard-I-of-N.journal is here");
    refused(&ishigami(&parts, &["--shard", "4/3"]), 2, "expected a part as in 3/8");
    let growing = ["--shard", "1/2", "--set", "design.max_runs=100000"];
    refused(&ishigami(&parts, &growing), 2, "has no size that could be shared out beforehand");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_ends_a_run_without_loss() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, full) = (folder.path().join("whole"), folder.path().join("full"));
    succeed(&words(&slow(&whole, &["--no-journal"])));
    std::fs::create_dir(&full).unwrap();
    // No file may become longer than 8 KiB, and the program is told so by an error, as on a full disk.
    let program = assert_cmd::cargo::cargo_bin!("apportion");
    let mut limited = Command::new("bash");
    limited.args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$@\"", "bash", text(program)]).args(slow(&full, &[]));
    let output = limited.output().unwrap();
    refused(&output, 1, "cannot keep the outputs of finished runs: File too large");
    assert!(stderr(&output).contains("the same command with --resume goes on with them"), "{}", stderr(&output));
    let resumed = apportion(&words(&slow(&full, &["--resume"])));
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert!(on_record(&stderr(&resumed)) > 100, "{}", stderr(&resumed));
    assert!(result(&full, "lugre-environmental") == result(&whole, "lugre-environmental"));
}

#[test]
fn two_runs_do_not_write_one_journal() {
    let folder = tempfile::tempdir().unwrap();
    // Long enough to be at work still when the second one begins, on any machine.
    let longer = |argument: String| if argument == SLOW[3] { "262144".to_owned() } else { argument };
    let long: Vec<String> = slow(folder.path(), &[]).into_iter().map(longer).collect();
    let mut first = spawn(&long);
    wait_for_bytes(&folder.path().join("lugre-environmental.journal"), 3000);
    let second = apportion(&words(&long));
    refused(&second, 1, "lugre-environmental.journal: another run is writing this journal");
    first.kill().unwrap();
    first.wait().unwrap();
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
            std::thread::sleep(Duration::from_millis(random(&mut state) % 5000));
            child.kill().unwrap();
            let (_, messages) = ended(child);
            assert!(!messages.contains("moved"), "a journal of no use after a kill: {messages}");
            recorded += on_record(&messages);
            if journal.exists() {
                assert!(apportion::run::journal::read_journal_file(&journal).unwrap().sums.is_some());
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

#[test]
#[cfg(unix)]
fn a_quick_run_that_is_interrupted_goes_on_and_grows() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    let long = ["--base-samples", "524288"];
    let arguments = |out: &Path, more: &[&str]| {
        let study = study_path("coulomb-general");
        let all = [&["run", text(&study), "--out", text(out)], more].concat();
        all.iter().map(ToString::to_string).collect::<Vec<String>>()
    };
    succeed(&words(&arguments(&whole, &long)));
    let child = spawn(&arguments(&stopped, &long));
    let journal = stopped.join("coulomb-general.journal");
    wait_for_bytes(&journal, 100);
    std::thread::sleep(Duration::from_millis(500));
    let second = apportion(&words(&arguments(&stopped, &long)));
    signal(&child, "-INT");
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

/// The commands of `docs/clusters.md` for GNU parallel, with whatever stands for it here.
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
