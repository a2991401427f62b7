use std::sync::Mutex;

use super::*;
use crate::design::{DesignSettings, Sampler};
use crate::model::{Batch, Output, RowFailure, Worker};
use crate::quantity::Unit;
use crate::space::{Distribution, Factor};

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

    fn worker(&self) -> Box<dyn Worker + '_> {
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
    Design::new(settings, 2, vec![vec![0], vec![1]]).unwrap()
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
        for threads in [2, 3, 7] {
            assert_eq!(totals(&design, &Sum::new(true), threads), one, "{sampler:?}, {threads} threads");
        }
    }
}

#[test]
fn every_row_is_run_once_and_progress_tells_so() {
    let design = design(Sampler::Sobol, 2 * 1000, 2);
    let last = Mutex::new((0, 0));
    let on_progress = |progress: Progress| {
        let mut last = last.lock().unwrap();
        last.0 = last.0.max(progress.done);
        last.1 = progress.total;
    };
    let got = run(Job { design: &design, space: &space(), model: &Sum::new(false) }, 2, &on_progress).unwrap();
    assert_eq!(got.iter().map(|t| t.runs).sum::<u64>(), 4 * 2000);
    assert_eq!(got.iter().map(|t| t.outputs[0].moments.count()).sum::<u64>(), 2000);
    assert_eq!(last.into_inner().unwrap(), (8000, 8000));
}

#[test]
fn failed_rows_are_counted_located_and_left_out_with_their_base_point() {
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
    let tally = output.failures[&RowFailure::not_finite()];
    assert_eq!((output.runs_failed, got.failed_runs), (failed, failed));
    assert_eq!(output.moments.count(), 1024 - incomplete);
    assert_eq!((tally.count, Some(tally.first_row)), (failed, first));
}
