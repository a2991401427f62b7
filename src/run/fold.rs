//! Evaluation of blocks of base points, and the merging of their totals in a tree of fixed shape.
//!
//! The blocks of a replicate are split at the largest power of two below their number, and so are the parts, down to
//! single blocks. The shape depends only on the number of blocks, so the totals have the same bits on any number of
//! threads; from one power of two to the next, a longer run has the shorter one as its left half.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::failures::RowPosition;
use super::scratch::{BlockPlace, Scratch};
use super::totals::sampled_points;
use super::tracker::Tracker;
use super::{BLOCK, FailurePolicy, GrowingRun, RowBlock, RunError, Totals, record};
use crate::design::BasePoints;
use crate::estimate::PartShape;

/// Turns the base points of a run into totals.
pub(super) struct Fold<'f, 'a> {
    /// The run; its store, if there is one, has the outputs of all rows.
    pub run: &'f GrowingRun<'a>,
    pub tracker: &'f Tracker<'f>,
    /// What no thread is using.
    pub idle: Mutex<Vec<Scratch<'a>>>,
}

/// A replicate, with the range of its base points that are folded.
struct ReplicateRange {
    replicate: u64,
    base: BasePoints,
    points: Range<u64>,
}

impl<'a> Fold<'_, 'a> {
    /// Returns the totals of the base points `points` of each replicate, in order; `None` if the run ended before them.
    pub fn run(&self, points: Range<u64>) -> Option<Vec<Totals>> {
        let blocks = points.start / BLOCK..points.end.div_ceil(BLOCK);
        let design = self.run.job.design;
        (0..design.settings().replicates)
            .into_par_iter()
            .map(|replicate| {
                let range = ReplicateRange { replicate, base: design.replicate(replicate), points: points.clone() };
                self.fold(&range, blocks.clone())
            })
            .collect()
    }

    fn fold(&self, range: &ReplicateRange, blocks: Range<u64>) -> Option<Totals> {
        let count = blocks.end - blocks.start;
        if count == 1 {
            return self.block(range, blocks.start);
        }
        let middle = blocks.start + (1 << (count - 1).ilog2());
        let (left, right) =
            rayon::join(|| self.fold(range, blocks.start..middle), || self.fold(range, middle..blocks.end));
        let mut totals = left?;
        totals.merge(right?);
        Some(totals)
    }

    fn block(&self, range: &ReplicateRange, number: u64) -> Option<Totals> {
        if !self.tracker.goes_on() {
            return None;
        }
        let _guard = self.tracker.end_if_panicking();
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut scratch = idle.unwrap_or_else(|| Scratch::new(self.run.job));
        let all = &range.points;
        let points = (number * BLOCK).max(all.start)..((number + 1) * BLOCK).min(all.end);
        let outcome = self.totals(&mut scratch, range, points);
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
        match outcome {
            Ok(totals) => {
                self.tracker.add(totals.runs, totals.failed_runs);
                Some(totals)
            }
            Err(error) => {
                self.tracker.end(error);
                None
            }
        }
    }

    fn totals(
        &self,
        scratch: &mut Scratch<'a>,
        range: &ReplicateRange,
        points: Range<u64>,
    ) -> Result<Totals, RunError> {
        let count = (points.end - points.start) as usize;
        let sampled = sampled_points(self.run.job.model.outputs().len(), self.run.job.design.settings().replicates);
        let place = BlockPlace {
            first: RowPosition { replicate: range.replicate, point: points.start, run: 0 },
            parts: PartShape::of_block(points.start / BLOCK, BLOCK, self.run.job.model.outputs().len()),
            sampled: sampled.saturating_sub(points.start) as usize,
            keeps_outputs: self.run.keeps_outputs,
        };
        if !self.run.store.is_some_and(|store| scratch.recall(store, place, count)) {
            scratch.run_rows(self.run.job, (&range.base, points.start, count), self.run.context)?;
            if let Some(journal) = self.run.journal.filter(|journal| journal.get().is_some()) {
                let first = points.start * self.run.job.design.rows_per_point();
                let block = RowBlock::from_batches(range.replicate, first, &scratch.batches);
                record(journal, &block)?;
            }
        }
        let totals = scratch.totals(self.run.job, place);
        match totals.first_failure().filter(|_| self.run.failures == FailurePolicy::Fail) {
            Some((row, reason)) => Err(RunError::RowFailed { row, reason }),
            None => Ok(totals),
        }
    }
}

#[cfg(test)]
mod tests {
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
                let block =
                    |number: u64| fold(job, number * BLOCK..end.min((number + 1) * BLOCK)).swap_remove(replicate);
                let expected = counted((0..end.div_ceil(BLOCK)).map(block).collect());
                assert!(format!("{totals:?}") == format!("{expected:?}"), "{end} points");
            }
        }
        // A run of a power of two of blocks is the left half of one that is twice as long.
        let (mut grown, rest, all) = (fold(job, 0..1024), fold(job, 1024..2048), fold(job, 0..2048));
        grown.iter_mut().zip(&rest).for_each(|(totals, rest)| totals.merge(rest.clone()));
        assert!(format!("{grown:?}") == format!("{all:?}"));
    }
}
