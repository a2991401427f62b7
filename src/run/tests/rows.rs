use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use super::*;
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{Batch, FunctionModel, Model, Output, RowFailure, RunContext, Worker};
use crate::run::journal::read_journal_file;
use crate::run::tests::run;
use crate::run::{BLOCK, GrowingRun, Progress, Shard, Totals};
use crate::space::{Distribution, Factor, Space};
use apportion_base::quantity::Unit;

fn space() -> Space {
    let unit_interval = || Distribution::uniform(0.0, 1.0).unwrap();
    let factor = |name| Factor::new(name, Unit::dimensionless(), unit_interval()).unwrap();
    Space::new(vec![factor("x0"), factor("x1")])
}

fn design(base_samples: u64, replicates: u64) -> Design {
    let settings = DesignSettings { base_samples, replicates, seed: 1, ..DesignSettings::default() };
    Design::new(settings, 2, Rows::plain(vec![vec![0], vec![1]])).unwrap()
}

/// x0 + 2 x1, failing where x0 > 0.75; counts its rows.
fn counted(rows: &AtomicU64) -> impl Model + '_ {
    let output = Output::new("y", Unit::dimensionless(), "");
    FunctionModel::new(vec![output], move |x: &[f64], y: &mut [f64]| {
        rows.fetch_add(1, Ordering::Relaxed);
        y[0] = x[0] + 2.0 * x[1];
        if x[0] > 0.75 { Err(RowFailure::new("too large")) } else { Ok(()) }
    })
}

fn with_store(design: &Design, model: &dyn Model, store: &Store, points: u64) -> Result<Vec<Totals>, RunError> {
    let space = space();
    let context = RunContext::default();
    let mut run = GrowingRun::new(Job { design, space: &space, model }, &context, 2);
    run.store = Some(store);
    run.grow_to(points, &|_| ())?;
    Ok(run.totals().to_vec())
}

#[test]
fn totals_from_a_store_are_those_of_a_plain_run() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    for (base_samples, replicates) in [(2, 1), (600, 2), (4 * BLOCK, 2), (4 * BLOCK + 3, 1)] {
        let design = design(base_samples, replicates);
        let plain = format!("{:?}", run(Job { design: &design, space: &space(), model: &model }, 1, &|_| ()).unwrap());
        rows.store(0, Ordering::Relaxed);
        let store = Store::new(&model);
        assert!(format!("{:?}", with_store(&design, &model, &store, u64::MAX).unwrap()) == plain, "{base_samples}");
        assert_eq!(rows.load(Ordering::Relaxed), design.rows());
        // Nothing is evaluated twice.
        assert!(format!("{:?}", with_store(&design, &model, &store, u64::MAX).unwrap()) == plain);
        assert_eq!(rows.load(Ordering::Relaxed), design.rows());
    }
}

#[test]
fn a_longer_run_keeps_the_rows_of_the_shorter_one() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let (short, long) = (design(2 * BLOCK, 2), design(4 * BLOCK, 2));
    let plain = format!("{:?}", run(Job { design: &long, space: &space(), model: &model }, 1, &|_| ()).unwrap());
    rows.store(0, Ordering::Relaxed);
    let store = Store::new(&model);
    with_store(&short, &model, &store, u64::MAX).unwrap();
    assert!(format!("{:?}", with_store(&long, &model, &store, u64::MAX).unwrap()) == plain);
    assert_eq!(rows.load(Ordering::Relaxed), long.rows());
}

#[test]
fn shards_make_up_the_whole_run() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(700, 2);
    let plain = format!("{:?}", run(Job { design: &design, space: &space(), model: &model }, 1, &|_| ()).unwrap());
    let all = Store::new(&model);
    for number in [3, 1, 2] {
        let shard: Shard = format!("{number}/3").parse().unwrap();
        let part = Store::new(&model);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.journal");
        let journal = Journal::create(&path, &serde_json::json!({})).unwrap().into();
        let space = space();
        let job = Job { design: &design, space: &space, model: &model };
        let context = RunContext::default();
        let mut run = GrowingRun::new(job, &context, 2);
        run.journal = Some(&journal);
        run.run_missing(&shard.rows(&design), &part, &|_| ()).unwrap();
        for block in read_journal_file(&path).unwrap().blocks {
            all.insert(block);
        }
    }
    rows.store(0, Ordering::Relaxed);
    assert!(format!("{:?}", with_store(&design, &model, &all, u64::MAX).unwrap()) == plain);
    assert_eq!(rows.load(Ordering::Relaxed), 0);
}

#[test]
fn a_run_that_is_stopped_keeps_what_it_has() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(4 * BLOCK, 1);
    let (store, stop) = (Store::new(&model), AtomicBool::new(false));
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let on_progress = |progress: Progress| {
        stop.fetch_or(progress.done > 1000, Ordering::Relaxed);
    };
    let context = RunContext::new(Some(&stop), |_| ());
    let mut stopped = GrowingRun::new(job, &context, 2);
    stopped.store = Some(&store);
    let slow = |progress| {
        on_progress(progress);
        std::thread::sleep(Duration::from_millis(5));
    };
    let error = stopped.grow_to(u64::MAX, &slow).unwrap_err();
    let RunError::Interrupted { done, total } = error else { panic!("{error}") };
    assert!(done > 1000 && done <= design.rows() && total == Some(design.rows()), "{done} of {total:?}");
    let evaluated = rows.load(Ordering::Relaxed);
    let plain = run(job, 1, &|_| ()).unwrap();
    rows.store(evaluated, Ordering::Relaxed);
    assert!(format!("{:?}", with_store(&design, &model, &store, u64::MAX).unwrap()) == format!("{plain:?}"));
    assert_eq!(rows.load(Ordering::Relaxed), design.rows());
}

#[test]
fn a_run_without_a_store_stops_too() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(64 * BLOCK, 1);
    let stop = AtomicBool::new(false);
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let context = RunContext::new(Some(&stop), |_| ());
    let mut run = GrowingRun::new(job, &context, 2);
    let error = run.grow_to(u64::MAX, &|_| stop.store(true, Ordering::Relaxed)).unwrap_err();
    assert!(matches!(error, RunError::Interrupted { .. }), "{error}");
    assert!(rows.load(Ordering::Relaxed) < design.rows());
}

/// Answers 500 rows, and then gives up.
struct Tired([Output; 1], AtomicU64);

impl Model for Tired {
    fn outputs(&self) -> &[Output] {
        &self.0
    }

    fn concurrency(&self) -> Option<usize> {
        Some(3)
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(TiredWorker(&self.1))
    }
}

struct TiredWorker<'a>(&'a AtomicU64);

impl Worker for TiredWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for (row, x) in inputs[0].iter().enumerate() {
            if self.0.fetch_add(1, Ordering::Relaxed) >= 500 {
                return batch.give_up(RowFailure::new("no more"));
            }
            batch.set(row, 0, *x);
        }
    }
}

#[test]
fn a_model_that_gives_up_ends_the_run_without_losing_answers() {
    let model = Tired([Output::new("y", Unit::dimensionless(), "")], AtomicU64::new(0));
    let design = design(4 * BLOCK, 1);
    let store = Store::new(&model);
    let error = with_store(&design, &model, &store, u64::MAX).unwrap_err();
    assert!(matches!(error, RunError::GaveUp(_)), "{error}");
    let (present, failed) = store.count(0, 0..design.rows());
    assert_eq!((present, failed), (500, 0));
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let error = run(job, 2, &|_| ()).unwrap_err();
    assert!(matches!(error, RunError::GaveUp { .. }), "{error}");
}

#[test]
fn outputs_that_cannot_be_kept_end_the_run() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(4 * BLOCK, 1);
    let store = Store::new(&model);
    let file = tempfile::NamedTempFile::new().unwrap();
    let journal = Journal::read_only(file.path()).into();
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, 2);
    run.store = Some(&store);
    run.journal = Some(&journal);
    let error = run.grow_to(u64::MAX, &|_| ()).unwrap_err();
    assert!(matches!(error, RunError::NotKept { .. }), "{error}");
    assert_eq!(store.count(0, 0..design.rows()).0, 0);
}

#[test]
fn a_failed_row_stops_a_run_that_stops_at_failures() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(4 * BLOCK, 1);
    let store = Store::new(&model);
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, 1);
    (run.store, run.failures) = (Some(&store), FailurePolicy::Fail);
    let error = run.grow_to(u64::MAX, &|_| ()).unwrap_err();
    let RunError::RowFailed { row, reason } = error else { panic!("{error}") };
    assert_eq!(reason.to_string(), "too large");
    let mut u = [0.0; 2];
    design.point(row.row(&design), &mut u);
    assert!(u[0] > 0.75);
}
