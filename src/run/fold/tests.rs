use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::*;
use crate::binary::Reader;
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{FunctionModel, Model, Output, RowFailure, RunContext};
use crate::quantity::Unit;
use crate::run::journal::{Checkpoint, read_journal_file};
use crate::run::{GrowingRun, Job, RunError, run};
use crate::space::{Distribution, Factor, Space};

fn space() -> Space {
    let unit_interval = || Distribution::uniform(0.0, 1.0).unwrap();
    let factor = |name| Factor::new(name, Unit::dimensionless(), unit_interval()).unwrap();
    Space::new(vec![factor("x0"), factor("x1")])
}

/// A design with all that moments may hold.
fn design(base_samples: u64, replicates: u64) -> Design {
    let settings = DesignSettings { base_samples, replicates, seed: 1, ..DesignSettings::default() };
    let rows = Rows { swaps: vec![vec![0], vec![1]], ba: true, second_order: true, ..Rows::default() };
    Design::new(settings, 2, rows).unwrap()
}

/// sin(9 x0) + x1 / 3, failing where x0 > 0.9; counts its rows.
fn counted(rows: &AtomicU64) -> impl Model + '_ {
    counted_by(|| {
        rows.fetch_add(1, Ordering::Relaxed);
    })
}

/// The model of [`counted`], which calls `on_row` before every row.
fn counted_by<'a>(on_row: impl Fn() + Send + Sync + 'a) -> impl Model + 'a {
    let output = Output::new("y", Unit::dimensionless(), "");
    FunctionModel::new(vec![output], move |x: &[f64], y: &mut [f64]| {
        on_row();
        y[0] = libm::sin(9.0 * x[0]) + x[1] / 3.0;
        if x[0] > 0.9 { Err(RowFailure::new("too large")) } else { Ok(()) }
    })
}

/// The totals of a run from `sums` to `points` base points of every replicate, and the sums that it leaves.
fn run_on(design: &Design, model: &dyn Model, sums: Sums, stages: &[u64]) -> (Vec<Totals>, Sums) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.journal");
    let checkpoint = Checkpoint::create(&path, &serde_json::json!({}), &sums).unwrap();
    let (space, context) = (space(), RunContext::default());
    let job = Job { design, space: &space, model };
    let mut run = GrowingRun::new(job, &context, 3).unwrap().with_checkpoint(&checkpoint, sums);
    stages.iter().for_each(|points| run.grow_to(*points, &|_| ()).unwrap());
    run.write_checkpoint().unwrap();
    (run.totals().to_vec(), read_journal_file(&path).unwrap().sums.unwrap())
}

#[test]
fn open_branches_are_all_that_a_longer_run_needs() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    for replicates in [1, 3] {
        for (short, long) in [(1, 2), (3, 4), (5, 16), (7, 7), (12, 13), (2, 9)] {
            let (short, long) = (short * BLOCK, long * BLOCK + 17);
            let (first, second) = (design(short * replicates, replicates), design(long * replicates, replicates));
            let plain = run(Job { design: &second, space: &space(), model: &model }, 2, &|_| ()).unwrap();
            let (_, sums) = run_on(&first, &model, Sums::new(replicates), &[short]);
            assert_eq!((sums.points(), sums.rows()), (short, first.rows()));
            assert!(sums.is_coherent(replicates) && sums.totals().all(|totals| totals.fits(&second, &model)));
            rows.store(0, Ordering::Relaxed);
            let (totals, sums) = run_on(&second, &model, sums, &[long]);
            assert!(totals == plain, "{short} to {long} in {replicates}");
            assert_eq!(rows.load(Ordering::Relaxed), second.rows() - first.rows(), "no row is run twice");
            // Points beyond the last whole block are no part of the sums, and are run again.
            assert_eq!(sums.points(), long - 17);
        }
    }
}

#[test]
fn a_run_that_grows_goes_on_in_the_same_stages() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    // Whole blocks; parts of one; some whole blocks and a part.
    for points in [256, 512, 64, 300, 768] {
        let design = design(8 * points, 1);
        let stages: Vec<u64> = [1, 2, 4, 8].map(|stage| stage * points).to_vec();
        let (plain, _) = run_on(&design, &model, Sums::new(1), &stages);
        for known in 1..4 {
            let (_, sums) = run_on(&design, &model, Sums::new(1), &stages[..known]);
            assert!(sums.is_stage_of(points, true) && sums.is_coherent(1), "{points}");
            let left: Vec<u64> =
                stages.iter().copied().filter(|stage| *stage >= sums.first_stage(points, true)).collect();
            let (totals, _) = run_on(&design, &model, sums, &left);
            assert!(totals == plain, "{points} from stage {known}");
        }
    }
}

#[test]
fn sums_of_one_kind_of_run_are_not_those_of_another() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(2400, 1);
    let (_, grown) = run_on(&design, &model, Sums::new(1), &[300, 600, 1200]);
    let (_, plain) = run_on(&design, &model, Sums::new(1), &[1200]);
    assert!(grown.is_stage_of(300, true));
    for points in [100, 600, 256] {
        assert!(!grown.is_stage_of(points, true), "{points}");
    }
    assert!(!grown.is_stage_of(300, false));
    assert!(plain.is_stage_of(1200, false) && plain.is_stage_of(1200, true) && plain.is_stage_of(256, true));
    assert!(!plain.is_stage_of(300, true));
}

#[test]
fn a_run_that_is_interrupted_leaves_what_it_has() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let design = design(64 * BLOCK, 2);
    let plain = run(Job { design: &design, space: &space(), model: &model }, 1, &|_| ()).unwrap();
    for after in [1, 5, 20] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.journal");
        let checkpoint = Checkpoint::create(&path, &serde_json::json!({}), &Sums::new(2)).unwrap();
        let (stop, begun) = (AtomicBool::new(false), AtomicU64::new(0));
        let (space, context) = (space(), RunContext::new(Some(&stop), |_| ()));
        // The model itself ends the run: progress may reach a thread of this test when all rows are done.
        let enough = after * BLOCK * design.rows_per_point();
        let ending = counted_by(|| {
            if begun.fetch_add(1, Ordering::Relaxed) == enough {
                stop.store(true, Ordering::Relaxed);
            }
        });
        let job = Job { design: &design, space: &space, model: &ending };
        let mut run = GrowingRun::new(job, &context, 4).unwrap().with_checkpoint(&checkpoint, Sums::new(2));
        let error = run.grow_to(u64::MAX, &|_| ()).unwrap_err();
        assert!(matches!(error, RunError::Interrupted { .. }), "{error}");
        run.write_checkpoint().unwrap();
        drop(run);
        let sums = read_journal_file(&path).unwrap().sums.unwrap();
        assert!(sums.is_coherent(2) && sums.rows() < design.rows());
        let (totals, _) = run_on(&design, &model, sums, &[32 * BLOCK]);
        assert!(totals == plain, "after {after}");
    }
}

#[test]
fn damaged_bytes_are_no_sums() {
    let rows = AtomicU64::new(0);
    let model = counted(&rows);
    let (_, sums) = run_on(&design(5 * BLOCK, 1), &model, Sums::new(1), &[5 * BLOCK]);
    let mut bytes = Vec::new();
    sums.write(&mut bytes);
    let read = |bytes: &[u8]| Sums::read(&mut Reader { bytes });
    assert_eq!(read(&bytes), Some(sums));
    for length in (0..bytes.len()).step_by(97) {
        assert_eq!(read(&bytes[..length]), None);
    }
}
