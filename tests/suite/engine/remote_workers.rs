//! Remote workers, here threads behind channels: the same bits, and a clean end.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use apportion::result::StudyResult;
use apportion::study::Study;
use apportion::{RemoteWorkers, Requests, RunContext, RunError, WorkerStudy};

use crate::common::study_path;
#[cfg(not(feature = "mpi"))]
use crate::common::{stderr, text};

type Line = (Mutex<Sender<Vec<u8>>>, Mutex<Receiver<Vec<u8>>>);

struct Elsewhere {
    lines: Vec<Line>,
    stop: AtomicBool,
}

impl RemoteWorkers for Elsewhere {
    fn count(&self) -> usize {
        self.lines.len()
    }

    fn send(&self, worker: usize, request: Vec<u8>) -> io::Result<()> {
        let line = self.lines[worker].0.lock().unwrap_or_else(PoisonError::into_inner);
        line.send(request).map_err(|_| io::ErrorKind::BrokenPipe.into())
    }

    fn receive(&self, worker: usize, patience: Duration) -> io::Result<Option<Vec<u8>>> {
        match self.lines[worker].1.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(patience) {
            Ok(answer) => Ok(Some(answer)),
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// The requests to one worker, and the number that it answers before it is lost.
struct Queue(Receiver<Vec<u8>>, Sender<Vec<u8>>, usize);

impl Requests for Queue {
    fn next(&mut self) -> Option<Vec<u8>> {
        self.2 = self.2.checked_sub(1)?;
        self.0.recv().ok()
    }

    fn reply(&mut self, reply: Vec<u8>) {
        let _ = self.1.send(reply);
    }
}

/// The result of `run` with this number of remote workers, each of which answers this number of requests.
fn with_workers<R>(study: &Study, workers: usize, answers: usize, run: impl FnOnce(&Elsewhere) -> R) -> R {
    let far = WorkerStudy::new(study.clone(), &study.data_digests()).unwrap();
    let stop = AtomicBool::new(false);
    let context = RunContext::new(Some(&stop), |_| ());
    std::thread::scope(|scope| {
        let mut lines = Vec::new();
        for _ in 0..workers {
            let ((requests, queue), (sender, heard)) = (channel(), channel());
            lines.push((Mutex::new(requests), Mutex::new(heard)));
            let (far, context) = (&far, &context);
            scope.spawn(move || far.serve(context, &mut Queue(queue, sender, answers)));
        }
        run(&Elsewhere { lines, stop: AtomicBool::new(false) })
    })
}

fn load(name: &str, overrides: &[&str]) -> Study {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    apportion_files::load_study(&study_path(name), &overrides).unwrap()
}

fn json(result: &StudyResult) -> serde_json::Value {
    let mut json = serde_json::to_value(result).unwrap();
    ["threads", "wall_seconds"].iter().for_each(|key| drop(json["provenance"].as_object_mut().unwrap().remove(*key)));
    json
}

#[test]
fn remote_workers_change_no_bit() {
    let (dynamic, plain) = ("afm.fidelity=dynamic", "analysis.surrogate=off");
    for (name, overrides) in [
        ("ishigami", &[plain, "design.base_samples=70000"][..]),
        ("ishigami", &["design.base_samples=3000", "design.replicates=3"]),
        ("ishigami", &["design.base_samples=2048", "analysis.intervals=percentile", "design.sampler=random"]),
        ("sobol-g-target", &[]),
        ("flood", &[plain, "design.base_samples=4096"]),
        ("lugre-environmental", &[dynamic, plain, "design.base_samples=32"]),
    ] {
        let study = load(name, overrides);
        let alone = json(&study.run().unwrap());
        for workers in [1, 3] {
            let together = with_workers(&study, workers, usize::MAX, |far| {
                study.runner().threads(1).remote_workers(far).run().unwrap()
            });
            assert!(json(&together) == alone, "{name} {overrides:?}, {workers} workers elsewhere");
        }
    }
}

#[test]
fn recorded_runs_are_not_repeated_by_workers_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("rows.journal");
    let study = load("ishigami", &["design.base_samples=65536"]);
    let expected = json(&study.run().unwrap());
    let stop = AtomicBool::new(false);
    let enough = |progress: apportion::run::Progress| stop.store(progress.done > 100_000, Ordering::Relaxed);
    let stopped = with_workers(&study, 2, usize::MAX, |far| {
        let runner = study.runner().threads(1).remote_workers(far).on_progress(enough);
        runner.stop(&stop).journal(&journal).run()
    });
    assert!(matches!(stopped, Err(RunError::Interrupted { .. })), "{stopped:?}");
    let recorded = study.runner().journal(&journal).recorded_runs().unwrap();
    assert!(recorded > 100_000, "{recorded} recorded runs");
    let resumed = with_workers(&study, 3, usize::MAX, |far| {
        study.runner().threads(1).remote_workers(far).journal(&journal).run().unwrap()
    });
    assert!(json(&resumed) == expected);
}

#[test]
fn a_lost_worker_ends_the_run() {
    let study = load("ishigami", &["design.base_samples=65536"]);
    let lost = with_workers(&study, 2, 3, |far| study.runner().threads(1).remote_workers(far).run());
    assert!(matches!(lost, Err(RunError::LostWorker { .. })), "{lost:?}");
}

/// As those of a node whose copy of the program or of measured values is an old one.
#[test]
fn workers_with_other_files_are_refused() {
    let study = "model = \"command\"\noutputs = [\"y\"]\n[command]\nprogram = [\"sh\", \"model.sh\"]\n\
                 [factors]\na = { distribution = \"empirical\", file = \"a.csv\" }\n";
    let load = |program: &str, values: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("model.sh"), program).unwrap();
        std::fs::write(folder.path().join("a.csv"), values).unwrap();
        let study = apportion_files::parse_study(study, &folder.path().join("s.toml"), &[]).unwrap();
        (folder, study)
    };
    let (_run, study) = load("cat", "1\n2\n4\n");
    let digests = study.data_digests();
    for (program, values, differing) in
        [("cat", "1\n2\n4\n", None), ("tac", "1\n2\n4\n", Some("model.sh")), ("cat", "1\n2\n5\n", Some("a.csv"))]
    {
        let (_rank, study) = load(program, values);
        match (WorkerStudy::new(study, &digests), differing) {
            (Ok(_), None) => (),
            (Err(RunError::OtherFiles { files }), Some(expected)) => assert_eq!(files, expected),
            (made, _) => panic!("{differing:?}: {:?}", made.err()),
        }
    }
}

/// The exit code of a run with these variables, and its standard error.
#[cfg(not(feature = "mpi"))]
fn started_with(variables: &[(&str, &str)]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("apportion"));
    command.args(["run", text(&study_path("ishigami")), "--out", text(folder.path()), "--base-samples", "64"]);
    let output = command.envs(variables.iter().copied()).output().unwrap();
    let has_result = folder.path().join("ishigami.json").exists();
    assert_eq!(has_result, output.status.success());
    (output.status.code(), stderr(&output))
}

/// Every rank of a program without MPI would write the same files.
#[cfg(not(feature = "mpi"))]
#[test]
fn a_program_without_mpi_refuses_to_run_on_ranks() {
    let launchers = [
        ("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"),
        ("PMI_SIZE", "PMI_RANK"),
        ("MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK"),
        ("SLURM_NTASKS", "PMIX_RANK"),
        ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID"),
    ];
    let mut messages = crate::messages::messages!();
    for (size, rank) in launchers {
        let (code, said) = started_with(&[(size, "3"), (rank, "0")]);
        assert_eq!(code, Some(2), "{said}");
        messages.add(size, &said);
        // The first rank prints the messages of all.
        assert_eq!(started_with(&[(size, "3"), (rank, "2")]), (Some(2), String::new()));
        assert_eq!(started_with(&[(size, "1"), (rank, "0")]).0, Some(0));
        assert_eq!(started_with(&[(size, "3"), (rank, "0"), ("APPORTION_MPI", "off")]).0, Some(0));
    }
    assert_eq!(started_with(&[("SLURM_NTASKS", "3")]).0, Some(0));
}
