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
#[path = "tests/fold.rs"]
mod tests;
