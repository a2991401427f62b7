use std::time::Duration;

use super::*;
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{FunctionModel, Model, Output, RowFailure, RunContext};
use crate::run::{Job, Progress};
use crate::space::{Distribution, Factor, Space};
use apportion_base::clock::Instant;
use apportion_base::quantity::Unit;

/// sin(9 x0) + x1 / 3, failing where x0 > 0.9.
fn model() -> impl Model {
    FunctionModel::new(vec![Output::new("y", Unit::dimensionless(), "")], |x: &[f64], y: &mut [f64]| {
        y[0] = libm::sin(9.0 * x[0]) + x[1] / 3.0;
        if x[0] > 0.9 { Err(RowFailure::new("too large")) } else { Ok(()) }
    })
}

/// The totals of the base points `points` of each replicate.
fn fold(job: Job<'_>, points: Range<u64>) -> Vec<Totals> {
    let context = RunContext::default();
    let before = Progress { done: 0, recalled: 0, total: 0, failed: 0, elapsed: Duration::ZERO };
    let tracker = Tracker::new(&context, before, Instant::now(), &|_| ());
    let run = GrowingRun::new(job, &context, 0);
    Fold { run: &run, tracker: &tracker, idle: Mutex::default() }.run(points).unwrap()
}

/// The tree of the first version in another form: neighbours of equal size are merged as blocks
/// come in, and what is left from the right.
fn counted(mut blocks: Vec<Totals>) -> Totals {
    let mut open: Vec<(usize, Totals)> = Vec::new();
    for block in blocks.drain(..) {
        let (mut size, mut totals) = (1, block);
        while let Some((_, mut left)) = open.pop_if(|(other, _)| *other == size) {
            left.merge(totals);
            (size, totals) = (2 * size, left);
        }
        open.push((size, totals));
    }
    let merged = open.into_iter().map(|(_, totals)| totals).rev().reduce(|right, mut left| {
        left.merge(right);
        left
    });
    merged.unwrap()
}

#[test]
fn the_tree_is_that_of_a_binary_counter() {
    let unit_interval = || Distribution::uniform(0.0, 1.0).unwrap();
    let factor = |name| Factor::new(name, Unit::dimensionless(), unit_interval()).unwrap();
    let (space, model) = (Space::new(vec![factor("x0"), factor("x1")]), model());
    let rows = Rows { swaps: vec![vec![0], vec![1]], ba: true, second_order: true, ..Rows::default() };
    let settings = DesignSettings { base_samples: 2 << 14, replicates: 2, seed: 1, ..DesignSettings::default() };
    let design = Design::new(settings, 2, rows).unwrap();
    let job = Job { design: &design, space: &space, model: &model };
    for end in [1, 255, 256, 257, 512, 3 * 256, 3 * 256 + 17, 7 * 256, 12 * 256 + 1, 13 * 256] {
        let all = fold(job, 0..end);
        for (replicate, totals) in all.iter().enumerate() {
            let block = |number: u64| fold(job, number * BLOCK..end.min((number + 1) * BLOCK)).swap_remove(replicate);
            let expected = counted((0..end.div_ceil(BLOCK)).map(block).collect());
            assert!(format!("{totals:?}") == format!("{expected:?}"), "{end} points");
        }
    }
    // A run of a power of two of blocks is the left half of one that is twice as long.
    let (mut grown, rest, all) = (fold(job, 0..1024), fold(job, 1024..2048), fold(job, 0..2048));
    grown.iter_mut().zip(&rest).for_each(|(totals, rest)| totals.merge(rest.clone()));
    assert!(format!("{grown:?}") == format!("{all:?}"));
}
