use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::*;
use crate::design::{DesignSettings, Rows, Sampler};
use crate::model::{Batch, Output, RowFailure, RunContext, Worker};
use crate::space::{Distribution, Factor};
use apportion_base::quantity::Unit;

/// Runs all rows of the job and returns the totals of each replicate.
pub(super) fn run(
    job: Job<'_>,
    threads: usize,
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Totals>, RunError> {
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, threads);
    run.grow_to(job.design.points_per_replicate(), on_progress)?;
    Ok(run.totals)
}

/// x0 + 2 x1, failing where x0 > 0.75 if `fails`.
struct Sum {
    outputs: [Output; 1],
    fails: bool,
}

impl Sum {
    fn new(fails: bool) -> Self {
        Self { outputs: [Output::new("y", Unit::dimensionless(), "")], fails }
    }
}

impl Model for Sum {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(SumWorker { fails: self.fails })
    }
}

struct SumWorker {
    fails: bool,
}

impl Worker for SumWorker {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for (row, (x0, x1)) in inputs[0].iter().zip(inputs[1]).enumerate() {
            let value = x0 + 2.0 * x1;
            batch.set(row, 0, if self.fails && *x0 > 0.75 { f64::NAN } else { value });
        }
    }
}

fn space() -> Space {
    let unit_interval = || Distribution::uniform(0.0, 1.0).unwrap();
    let factor = |name| Factor::new(name, Unit::dimensionless(), unit_interval()).unwrap();
    Space::new(vec![factor("x0"), factor("x1")])
}

fn design(sampler: Sampler, base_samples: u64, replicates: u64) -> Design {
    let settings = DesignSettings { sampler, base_samples, replicates, seed: 1 };
    Design::new(settings, 2, Rows::plain(vec![vec![0], vec![1]])).unwrap()
}

/// Returns totals as text: equal for equal bits, of NaN too.
fn text(totals: &[Totals]) -> String {
    format!("{totals:?}")
}

fn totals(design: &Design, model: &Sum, threads: usize) -> Vec<Totals> {
    run(Job { design, space: &space(), model }, threads, &|_| ()).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for sampler in Sampler::ALL {
        // Neither a power of two nor a multiple of the block.
        let design = design(sampler, 3 * 5000, 3);
        let one = totals(&design, &Sum::new(true), 1);
        for threads in [2, 3, 64] {
            assert_eq!(text(&totals(&design, &Sum::new(true), threads)), text(&one), "{sampler:?}, {threads} threads");
        }
    }
}

#[test]
fn a_run_that_grows_ends_in_the_bits_of_a_run_that_began_long_and_runs_no_row_twice() {
    for sampler in [Sampler::Sobol, Sampler::Random] {
        let design = design(sampler, 2 << 15, 2);
        let model = Sum::new(true);
        let space = space();
        let context = RunContext::default();
        let mut growing = GrowingRun::new(Job { design: &design, space: &space, model: &model }, &context, 2);
        let rows = AtomicU64::new(0);
        let count = |progress: Progress| {
            rows.fetch_max(progress.done, Ordering::Relaxed);
        };
        let mut points = BLOCK;
        while points <= design.points_per_replicate() {
            growing.grow_to(points, &count).unwrap();
            assert_eq!(growing.totals().iter().map(|t| t.runs).sum::<u64>(), 4 * 2 * points);
            if points >= 1024 {
                let shorter = design.with_points(points).unwrap();
                assert_eq!(
                    text(growing.totals()),
                    text(&totals(&shorter, &model, 1)),
                    "{sampler:?} at {points} points"
                );
            }
            points *= 2;
        }
        assert_eq!(rows.into_inner(), design.rows());
    }
}

#[test]
fn a_run_can_be_given_up_at_the_first_failure() {
    let design = design(Sampler::Sobol, 1 << 16, 2);
    let model = Sum::new(true);
    let space = space();
    let job = Job { design: &design, space: &space, model: &model };
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, 2);
    run.failures = FailurePolicy::Fail;
    let failed = run.grow_to(1 << 15, &|_| ()).unwrap_err();
    let RunError::RowFailed { row, reason } = failed else { panic!("{failed}") };
    assert_eq!(reason, RowFailure::not_finite());
    let mut u = [0.0; 2];
    design.point(row.row(&design), &mut u);
    assert!(u[0] > 0.75, "{row:?} is {u:?}");
}

#[test]
fn every_row_is_run_once_and_counted_by_progress() {
    let design = design(Sampler::Sobol, 2 * 1000, 2);
    let last = Mutex::new((0, 0));
    let on_progress = |progress: Progress| {
        let mut last = last.lock().unwrap();
        last.0 = last.0.max(progress.done);
        last.1 = progress.total;
    };
    let got = run(Job { design: &design, space: &space(), model: &Sum::new(false) }, 2, &on_progress).unwrap();
    assert_eq!(got.iter().map(|t| t.runs).sum::<u64>(), 4 * 2000);
    assert_eq!(got.iter().map(|t| t.outputs[0].moments.sum().count()).sum::<u64>(), 2000);
    assert_eq!(last.into_inner().unwrap(), (8000, 8000));
}

#[test]
fn failed_rows_are_counted_located_and_left_out() {
    let design = design(Sampler::Sobol, 1024, 1);
    let got = totals(&design, &Sum::new(true), 0).remove(0);
    let (mut failed, mut incomplete, mut first) = (0, 0, None);
    for base in 0..1024 {
        let mut any = false;
        for row in base * 4..base * 4 + 4 {
            let mut u = [0.0; 2];
            design.point(row, &mut u);
            if u[0] > 0.75 {
                failed += 1;
                any = true;
                first.get_or_insert(row);
            }
        }
        incomplete += u64::from(any);
    }
    let output = &got.outputs[0];
    let (reason, tally) = output.failures.iter().next().unwrap();
    assert_eq!(reason, RowFailure::not_finite());
    assert_eq!((output.runs_failed, got.failed_runs), (failed, failed));
    // x0 comes from A or from B, so a base point with any failure is one where A or B failed.
    let moments = output.moments.sum();
    assert_eq!((moments.count(), moments.fewest()), (1024 - incomplete, 1024 - incomplete));
    assert_eq!((tally.count, Some(tally.first.row(&design))), (failed, first));
}

/// A model of one function of the SI values of a row and of how many rows its worker has run before.
struct Of(fn(&[f64], u64) -> f64, [Output; 1]);

impl Of {
    fn new(f: fn(&[f64], u64) -> f64) -> Self {
        Self(f, [Output { name: "y".into(), unit: Unit::dimensionless(), description: "".into() }])
    }
}

impl Model for Of {
    fn outputs(&self) -> &[Output] {
        &self.1
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(OfWorker { model: self, rows: 0 })
    }
}

struct OfWorker<'a> {
    model: &'a Of,
    rows: u64,
}

impl Worker for OfWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for row in 0..batch.rows() {
            let x: Vec<f64> = inputs.iter().map(|column| column[row]).collect();
            batch.set(row, 0, (self.model.0)(&x, self.rows));
            self.rows += 1;
        }
    }
}

fn with_rows(rows: Rows, model: &Of) -> totals::OutputTotals {
    let settings = DesignSettings { base_samples: 1024, replicates: 1, ..DesignSettings::default() };
    let design = Design::new(settings, 2, rows).unwrap();
    run(Job { design: &design, space: &space(), model }, 1, &|_| ()).unwrap().remove(0).outputs.remove(0)
}

fn with_ba(swaps: Vec<Vec<usize>>) -> Rows {
    Rows { swaps, ba: true, second_order: true, ..Rows::default() }
}

#[test]
fn every_estimator_finds_the_indices_of_an_interaction() {
    use crate::estimate::{FirstOrder, Total, second_order};
    // x0 + x0 x1 on the unit square, f0 = 3/4: V_0 = (3/2)^2/12, V_1 = 1/48, V_01 = 1/144.
    let output = with_rows(with_ba(vec![vec![0], vec![1], vec![0, 1]]), &Of::new(|x, _| x[0] + x[0] * x[1]));
    let (v0, v1, v01) = (0.1875, 1.0 / 48.0, 1.0 / 144.0);
    let v = v0 + v1 + v01;
    let exact = [(v0, v0 + v01), (v1, v1 + v01), (v, v)].map(|(first, total)| (first / v, total / v));
    for (swap, (first, all)) in exact.into_iter().enumerate() {
        // 1024 points of a smooth function: an error of some 5e-3, and 2e-2 for Owen's formula of the total index.
        for estimator in FirstOrder::ALL {
            assert!((estimator.estimate(&output.moments.sum(), swap) - first).abs() < 0.05, "{estimator:?} of {swap}");
        }
        for estimator in Total::ALL {
            assert!((estimator.estimate(&output.moments.sum(), swap) - all).abs() < 0.1, "{estimator:?} of {swap}");
        }
    }
    assert!((second_order(&output.moments.sum(), 0, 1) - v01 / v).abs() < 0.02);
}

#[test]
fn a_dummy_factor_is_the_noise_of_the_model() {
    let rows = || Rows::plain(vec![vec![0], vec![1], vec![]]);
    let total =
        |model: &Of| crate::estimate::Indices::from_moments(&with_rows(rows(), model).moments.sum()).unwrap().total[2];
    assert_eq!(total(&Of::new(|x, _| x[0] + x[1])), 0.0);
    // Noise of +-0.1 from row to row and a variance of 1/6: 0.01/(1/6 + 0.01) of the all.
    let noisy = total(&Of::new(|x, row| {
        let hash = (row.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x[0] + x[1] + if hash >> 63 == 0 { 0.1 } else { -0.1 }
    }));
    // 1024 pairs of signs, of which half differ give or take 16: 3 %, five of which are allowed.
    assert!((noisy / (0.01 / (1.0 / 6.0 + 0.01)) - 1.0).abs() < 0.15, "{noisy}");
}

#[test]
fn a_failure_costs_the_indices_of_its_own_rows_only() {
    // Fails where x0 is of A and x1 of B or the other way round, as in AB, for a third of the points of A.
    let model = Of::new(|x, _| if x[0] < 0.3 && x[1] > 0.8 { f64::NAN } else { x[0] + 2.0 * x[1] });
    let output = with_rows(Rows::plain(vec![vec![0], vec![1], vec![0, 1]]), &model);
    let moments = output.moments.sum();
    let counts = [0, 1, 2].map(|swap| moments.swap(swap).base.n);
    // A and B: 1 - 2 (0.3 0.2) + (0.06)^2 of the points; AB_2 is B and loses no others.
    assert_eq!(counts[2], moments.count());
    assert!(counts[0] < counts[2] && counts[1] < counts[2] && moments.fewest() == counts[0].min(counts[1]));
    assert!((moments.count() as f64 / 1024.0 - 0.94 * 0.94).abs() < 0.01);
    // Every value of A and B counts for the output's distribution.
    assert!(output.values.count() > 2 * moments.count());
    let failed = output.sample.iter().filter(|y| y.is_nan()).count() as u64;
    assert_eq!((output.sample.len(), output.values.count()), (2048, 2048 - failed));
}

#[test]
fn the_sample_is_the_first_base_points_of_each_replicate_in_order() {
    let settings = DesignSettings { base_samples: 64 * 700, replicates: 64, seed: 5, ..DesignSettings::default() };
    let design = Design::new(settings, 2, Rows::plain(vec![vec![0]])).unwrap();
    let totals = totals(&design, &Sum::new(false), 2);
    let (last, kept) = (&totals[63].outputs[0], (SAMPLE / 64) as usize);
    assert_eq!((kept, last.sample.len()), (512, 1024));
    for (point, pair) in last.sample.chunks_exact(2).enumerate() {
        for (kind, y) in pair.iter().enumerate() {
            let mut u = [0.0; 2];
            design.point((63 * 700 + point as u64) * 3 + kind as u64, &mut u);
            assert_eq!(*y, u[0] + 2.0 * u[1]);
        }
    }
    let mut both = totals[0].clone();
    both.merge(totals[1].clone());
    let all = &both.outputs[0];
    assert_eq!(all.sample, [&totals[0].outputs[0].sample[..], &totals[1].outputs[0].sample].concat());
    assert_eq!(all.values.count(), 2 * 2 * 700);
}

#[test]
fn outputs_are_kept_in_order_when_asked_for_and_refused_when_too_many() {
    let (model, space) = (Sum::new(true), space());
    let kept = |threads| {
        let design = design(Sampler::Random, 1000, 2);
        let job = Job { design: &design, space: &space, model: &model };
        let context = RunContext::default();
        let mut run = GrowingRun::new(job, &context, threads);
        run.keeps_outputs = true;
        run.grow_to(300, &|_| ()).unwrap();
        run.grow_to(500, &|_| ()).unwrap();
        run.totals().iter().map(|totals| totals.outputs[0].clone()).collect::<Vec<_>>()
    };
    let one = kept(1);
    assert!(format!("{:?}", kept(3)) == format!("{one:?}"));
    for output in &one {
        let rows =
            |run: usize| output.point_outputs.blocks(500).flat_map(|runs| runs[run].to_vec()).collect::<Vec<f64>>();
        let interleaved: Vec<u64> =
            rows(0).iter().zip(&rows(1)).flat_map(|(a, b)| [a.to_bits(), b.to_bits()]).collect();
        assert_eq!(interleaved.len(), 1000);
        assert_eq!(interleaved, output.sample.iter().map(|y| y.to_bits()).collect::<Vec<_>>());
    }
    assert_eq!(totals(&design(Sampler::Random, 1000, 2), &model, 1)[0].outputs[0].point_outputs.points(), 0);

    // 4 runs of 8 bytes per base point: 2^28 of them take 8 GiB.
    let long = design(Sampler::Random, 1 << 29, 1);
    let job = Job { design: &long, space: &space, model: &model };
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, 1);
    assert!(run.room_for(1 << 29).is_ok());
    run.keeps_outputs = true;
    assert!(run.room_for(1 << 28).is_ok());
    let refused = run.grow_to(1 << 29, &|_| ()).unwrap_err();
    assert!(matches!(refused, RunError::TooManyOutputs { bytes: 17_179_869_184, .. }), "{refused}");
    assert!(run.totals().is_empty());
}
