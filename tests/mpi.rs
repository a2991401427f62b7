//! The program on the ranks of an MPI job. Without `mpirun` there is nothing to test.

#[path = "suite/common.rs"]
#[expect(dead_code, reason = "shared with the other tests of the program")]
mod common;

use std::io::{BufRead, BufReader};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use common::{Folder, stderr, study_path, succeed, text};

/// Answers slowly, and keeps a list of the rows that it got.
const PROGRAM: &str = "import csv, sys, time\n\
    for row in csv.DictReader(sys.stdin):\n\
    \x20   x = [float(row[name]) for name in ('a', 'b')]\n\
    \x20   time.sleep(0.004)\n\
    \x20   with open('asked.txt', 'a') as asked: asked.write(repr(x) + '\\n')\n\
    \x20   print(row['id'], x[0] + 2 * x[1] * x[1], sep=',', flush=True)\n";

const STUDY: &str = "model = \"command\"\noutputs = [\"y\"]\n[command]\nprogram = [\"python3\", \"model.py\"]\n\
    [design]\nbase_samples = 128\n[[factor]]\nname = \"a\"\nmin = 0.0\nmax = 1.0\n\
    [[factor]]\nname = \"b\"\nmin = 0.0\nmax = 1.0\n";

/// `mpirun` with the program on so many ranks; `None` if there is no `mpirun`.
fn ranks(ranks: usize, arguments: &[&str]) -> Option<Command> {
    let there = Command::new("mpirun").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !there.is_ok_and(|status| status.success()) {
        println!("skipped: there is no mpirun");
        return None;
    }
    let mut command = Command::new("mpirun");
    for name in ["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] {
        command.env(name, "1");
    }
    // An mpirun whose ranks do not start, or do not end, ends them after so many seconds.
    command.env("MPIEXEC_TIMEOUT", "240");
    command.env("OMPI_MCA_rmaps_base_oversubscribe", "1").env("OMPI_MCA_hwloc_base_binding_policy", "none");
    command.args(["-n", &ranks.to_string()]).arg(assert_cmd::cargo::cargo_bin!("apportion")).args(arguments);
    Some(command)
}

fn on_ranks(number: usize, arguments: &[&str]) -> Option<Output> {
    ranks(number, arguments).map(|mut command| command.output().unwrap())
}

/// The result in a folder, without the fields about the computer.
fn result(folder: &Path, study: &str) -> serde_json::Value {
    let json = std::fs::read_to_string(folder.join(format!("{study}.json"))).unwrap();
    let mut json: serde_json::Value = serde_json::from_str(&json).unwrap();
    ["threads", "wall_seconds"].iter().for_each(|key| drop(json["provenance"].as_object_mut().unwrap().remove(*key)));
    json
}

#[track_caller]
fn same_on_ranks(study: &Path, more: &[&str]) {
    let name = study.file_stem().unwrap().to_str().unwrap();
    let folder = Folder::new();
    let one = folder.path("one");
    succeed(&[&["run", text(study), "--out", text(&one)], more].concat());
    for number in [1, 2, 3, 5] {
        let out = folder.path(&number.to_string());
        let Some(output) = on_ranks(number, &[&["run", text(study), "--out", text(&out)], more].concat()) else {
            return;
        };
        let messages = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{messages}");
        assert_eq!(messages.contains(&format!("note: {number} ranks with a worker each")), number > 1, "{messages}");
        assert_eq!(messages.matches(" model runs in ").count(), 1, "{messages}");
        assert!(result(&out, name) == result(&one, name), "{number} ranks, {more:?}");
    }
}

#[test]
fn the_result_is_the_same_on_any_number_of_ranks() {
    same_on_ranks(&study_path("ishigami"), &["--base-samples", "50000"]);
    same_on_ranks(
        &study_path("ishigami"),
        &["--base-samples", "1024", "--set", "analysis.intervals=percentile", "--set", "design.sampler=random"],
    );
    same_on_ranks(&study_path("sobol-g-target"), &["--no-journal"]);
    let dynamic = ["--set", "afm.fidelity=dynamic"];
    same_on_ranks(&study_path("lugre-environmental"), &[&dynamic[..], &["--base-samples", "64"]].concat());
    let with_cheaper = ["--set", "fidelity.low=[\"closed-form\"]", "--set", "fidelity.base_samples=4096"];
    same_on_ranks(
        &study_path("lugre-environmental"),
        &[&dynamic[..], &with_cheaper, &["--base-samples", "16"]].concat(),
    );
    let folder = Folder::new();
    folder.with("model.py", PROGRAM);
    same_on_ranks(&folder.with("program.toml", STUDY), &[]);
}

#[test]
fn messages_are_counted_for_those_who_ask() {
    let folder = Folder::new();
    let (study, out) = (study_path("ishigami"), folder.path(""));
    let Some(mut command) = ranks(2, &["run", text(&study), "--out", text(&out)]) else { return };
    let output = command.env("APPORTION_MPI", "count").output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains(" bytes in all between the ranks"), "{}", stderr(&output));
}

#[test]
fn wrong_input_ends_all_ranks_with_its_exit_code() {
    for arguments in [&["run", "there-is-no.toml"][..], &["run", "--no-such-option"], &["nothing"]] {
        let Some(output) = on_ranks(3, arguments) else { return };
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert_eq!(stderr(&output).matches("error: ").count(), 1, "{}", stderr(&output));
    }
    let Some(output) = on_ranks(3, &["models"]) else { return };
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let once = succeed(&["models"]);
    // The terminal that mpirun gives to its ranks ends lines with two characters.
    assert_eq!(String::from_utf8(output.stdout).unwrap().replace('\r', ""), once);
}

#[test]
fn a_path_that_is_not_text_is_refused() {
    let folder = Folder::new();
    let path = folder.path("").join(std::ffi::OsStr::from_bytes(b"study-\xff.toml"));
    std::fs::copy(study_path("ishigami"), &path).unwrap();
    let Some(mut command) = ranks(2, &["run", "--base-samples", "64", "--out", text(&folder.path("out"))]) else {
        return;
    };
    let output = command.arg(&path).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
}

/// Ranks of a job: the children of its `mpirun`.
fn processes(job: u32) -> Vec<String> {
    let found = Command::new("pgrep").args(["-P", &job.to_string()]).output().unwrap();
    String::from_utf8(found.stdout).unwrap().split_whitespace().map(str::to_owned).collect()
}

/// Recorded runs are not evaluated again, for any killed rank; runs in progress are.
#[test]
fn a_job_with_killed_ranks_resumes_with_any_number_of_ranks() {
    const KILLS: usize = 20;
    let folder = Folder::new();
    folder.with("model.py", PROGRAM);
    let study = folder.with("program.toml", STUDY.replace("128", "2048"));
    let (whole, killed) = (folder.path("whole"), folder.path("killed"));
    let arguments = ["run", text(&study), "--out", text(&killed)];
    let (mut state, mut recorded, mut kills) = (2026_u64, 0, 0);
    while kills < KILLS {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let random = state >> 33;
        let number = [2, 3, 4][random as usize % 3];
        let Some(mut command) = ranks(number, &arguments) else { return };
        let mut job = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        // A rank that is killed while the job starts may leave mpirun waiting forever (Open MPI 4.1).
        let mut messages = BufReader::new(job.stderr.take().unwrap()).lines().map_while(Result::ok);
        assert!(messages.any(|line| line.contains("ranks with a worker each")), "{number} ranks");
        std::thread::sleep(Duration::from_millis(random % 700));
        let ranks = processes(job.id());
        let victim = ranks.get((random / 3) as usize % ranks.len().max(1));
        let is_killed = victim.is_some_and(|rank| Command::new("kill").args(["-9", rank]).status().unwrap().success());
        kills += usize::from(is_killed);
        messages.for_each(drop);
        let _ = job.wait().unwrap();
        let now = std::fs::metadata(killed.join("program.journal")).map_or(0, |file| file.len());
        assert!(now >= recorded, "{now} bytes on record, {recorded} before");
        recorded = now;
    }
    let last = on_ranks(3, &arguments).unwrap();
    assert_eq!(last.status.code(), Some(0), "{}", stderr(&last));
    assert!(stderr(&last).contains(" runs are already saved in "), "{}", stderr(&last));
    let asked = std::fs::read_to_string(folder.path("asked.txt")).unwrap().lines().count();
    // Each rank has at most two pieces of at most a fifth of a second: that much is lost, of 4 ms a row.
    assert!(asked <= 8192 + KILLS * 4 * 2 * 50, "{asked} rows");
    succeed(&["run", text(&study), "--out", text(&whole), "--threads", "2"]);
    assert!(result(&whole, "program") == result(&killed, "program"));
}

/// The scripts of `docs/guide/clusters.md`, with `mpirun` instead of `srun`.
#[test]
fn the_scripts_of_the_page_run() {
    const SRUN: &str = "#!/bin/sh\nshift\nexec mpirun -n 3 \"$@\"\n";
    let page = std::fs::read_to_string(
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("docs/guide/clusters.md"),
    )
    .unwrap();
    let lines: Vec<&str> =
        page.lines().filter(|line| line.starts_with("srun --mpi") || line.starts_with("mpirun ")).collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    let folder = Folder::new();
    let srun = folder.with("srun", SRUN);
    succeed(&["run", text(&study_path("ishigami")), "--out", text(&folder.path("results/study"))]);
    let expected = result(&folder.path("results/study"), "ishigami")["outputs"].clone();
    let program = Path::new(assert_cmd::cargo::cargo_bin!("apportion")).parent().unwrap().to_owned();
    let path = format!("{}:{}:{}", text(folder.path("").as_path()), text(&program), std::env::var("PATH").unwrap());
    Command::new("chmod").args(["+x", text(&srun)]).status().unwrap();
    std::fs::copy(study_path("ishigami"), folder.path("study.toml")).unwrap();
    for line in lines {
        let Some(environment) = ranks(1, &[]) else { return };
        let mut command = Command::new("sh");
        command.envs(environment.get_envs().filter_map(|(name, value)| Some((name, value?))));
        let ran = command.args(["-c", line]).env("PATH", &path).current_dir(folder.path("")).output().unwrap();
        assert_eq!(ran.status.code(), Some(0), "{line}: {}", stderr(&ran));
        assert!(stderr(&ran).contains("ranks with a worker each"), "{line}: {}", stderr(&ran));
        assert!(result(&folder.path("results/study"), "study")["outputs"] == expected, "{line}");
    }
}
