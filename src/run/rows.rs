//! Sources of rows to evaluate; the rows of a design that are missing in a store, their values, and where their
//! outputs go.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

use serde::{Deserialize, Serialize};

use super::journal::Journal;
use super::store::{RowBlock, Store};
use super::{FailurePolicy, Job, Progress, RowPosition, RunError, record};
use crate::design::{BasePoints, Design};
use crate::model::{Batch, Model, RunContext, Worker};
use crate::space::Space;
use apportion_base::clock::Instant;

/// Consecutive rows of one replicate, or of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct RowRange {
    pub replicate: u64,
    pub rows: Range<u64>,
}

impl RowRange {
    pub fn count(&self) -> u64 {
        self.rows.end - self.rows.start
    }
}

/// A source of rows to be run. A source leaves out rows whose outputs it already has.
pub(crate) trait RowSource: Sync {
    /// Returns at most `max_rows` rows for one of `workers` workers; `None` if there are none left.
    fn next(&self, max_rows: u64, workers: usize) -> Option<RowRange>;

    /// Returns a column of SI values for each factor over the rows.
    fn inputs<'s>(&'s self, values: &'s mut RowValues, range: &RowRange) -> Vec<&'s [f64]>;

    /// Accepts the outputs of the rows (those finished before the worker gave up, if it did); returns the number of
    /// rows accepted, and how many of them failed.
    fn accept(&self, range: &RowRange, batch: &Batch) -> Result<(u64, u64), RunError>;

    /// Returns the rows as those of a design, which remote workers can evaluate; `None` for a table.
    fn remote(&self) -> Option<&MissingRows<'_>> {
        None
    }
}

/// The rows of some replicates that are missing in a store.
pub(crate) struct MissingRows<'a> {
    pub job: Job<'a>,
    pub store: &'a Store,
    journal: Option<&'a OnceLock<Journal>>,
    failures: FailurePolicy,
    waiting: Mutex<Waiting>,
}

struct Waiting {
    /// In the order of evaluation.
    ranges: VecDeque<RowRange>,
    rows: u64,
}

impl<'a> MissingRows<'a> {
    /// Collects those of `rows` (replicate, and rows counted within it) that are missing in `store`, and the progress
    /// that the existing ones make.
    pub fn new(
        job: Job<'a>,
        rows: &[(u64, Range<u64>)],
        store: &'a Store,
        journal: Option<&'a OnceLock<Journal>>,
        failures: FailurePolicy,
    ) -> (Self, Progress) {
        let mut existing = Progress::default();
        let mut ranges = VecDeque::new();
        for (replicate, rows) in rows {
            let (present, failed) = store.count(*replicate, rows.clone());
            existing.total += rows.end - rows.start;
            existing.done += present;
            existing.failed += failed;
            let missing = store.missing(*replicate, rows.clone()).into_iter();
            ranges.extend(missing.map(|rows| RowRange { replicate: *replicate, rows }));
        }
        existing.recalled = existing.done;
        let waiting = Mutex::new(Waiting { ranges, rows: existing.total - existing.done });
        (Self { job, store, journal, failures, waiting }, existing)
    }

    /// Saves blocks of rows in the journal and the store; returns the number of their rows, and how many of them failed.
    pub fn keep(&self, blocks: Vec<RowBlock>) -> Result<(u64, u64), RunError> {
        let (mut rows, mut failed) = (0, 0);
        for block in blocks {
            self.journal.map_or(Ok(()), |journal| record(journal, &block))?;
            rows += block.rows(self.store.outputs());
            failed += block.failed_rows().len() as u64;
            if let (FailurePolicy::Fail, Some((row, _, reason))) = (self.failures, block.failures.first()) {
                let (row, per_point) = (block.first + u64::from(*row), self.job.design.rows_per_point());
                let row = RowPosition { replicate: block.replicate, point: row / per_point, run: row % per_point };
                let reason = reason.clone();
                self.store.insert(block);
                return Err(RunError::RowFailed { row, reason });
            }
            self.store.insert(block);
        }
        Ok((rows, failed))
    }
}

impl RowSource for MissingRows<'_> {
    /// Returns fewer rows than the maximum near the end, so that all workers stay busy.
    fn next(&self, max_rows: u64, workers: usize) -> Option<RowRange> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let share = (waiting.rows / (2 * workers as u64)).max(1);
        let RowRange { replicate, rows } = waiting.ranges.front_mut()?;
        let taken = rows.start..rows.end.min(rows.start + max_rows.min(share));
        rows.start = taken.end;
        let (replicate, is_empty) = (*replicate, rows.is_empty());
        if is_empty {
            waiting.ranges.pop_front();
        }
        waiting.rows -= taken.end - taken.start;
        Some(RowRange { replicate, rows: taken })
    }

    fn inputs<'s>(&'s self, values: &'s mut RowValues, RowRange { replicate, rows }: &RowRange) -> Vec<&'s [f64]> {
        values.values(self.job.space, self.job.design, *replicate, rows.clone()).iter().map(Vec::as_slice).collect()
    }

    fn accept(&self, range: &RowRange, batch: &Batch) -> Result<(u64, u64), RunError> {
        self.keep(answered(range, batch))
    }

    fn remote(&self) -> Option<&MissingRows<'_>> {
        Some(self)
    }
}

/// Returns the evaluated rows of a settled batch as blocks: one, unless the model has given up on some of them.
pub(crate) fn answered(range: &RowRange, batch: &Batch) -> Vec<RowBlock> {
    let block = RowBlock::from_batches(range.replicate, range.rows.start, std::slice::from_ref(batch));
    let Some(reason) = batch.given_up().map(|give_up| &give_up.reason) else { return vec![block] };
    let mut unfinished: Vec<u32> =
        block.failures.iter().filter(|(.., why)| why == reason).map(|(row, ..)| *row).collect();
    unfinished.dedup();
    let mut blocks = block.without(unfinished, batch.outputs());
    if let Some(first) = blocks.first_mut() {
        (first.flags, first.counts) = (block.flags, block.counts);
    }
    blocks
}

/// The columns of some base points.
#[derive(Debug, Default)]
pub(super) struct BaseColumns {
    /// In the unit cube.
    unit: Vec<Vec<f64>>,
    /// The same in SI units.
    pub values: Vec<Vec<f64>>,
}

impl BaseColumns {
    /// Computes `count` points from `first` on of `base`, a replicate of `design`.
    pub fn fill(&mut self, space: &Space, design: &Design, base: &BasePoints, first: u64, count: usize) {
        for columns in [&mut self.unit, &mut self.values] {
            columns.resize(design.columns(), Vec::new());
            columns.iter_mut().for_each(|column| column.resize(count, 0.0));
        }
        base.fill(first, &mut self.unit);
        for (k, (unit, values)) in self.unit.iter().zip(&mut self.values).enumerate() {
            space.factors()[design.factor_of(k)].fill_si(unit, values);
        }
    }
}

/// Computes the values of any rows of a design.
#[derive(Debug, Default)]
pub struct RowValues {
    /// The replicate to which the points belong.
    points: Option<(u64, BasePoints)>,
    columns: BaseColumns,
    /// One column of each factor over the rows.
    inputs: Vec<Vec<f64>>,
}

impl RowValues {
    /// Returns the values of rows `rows` of `replicate`, counted within the replicate as in [`RowBlock`](super::RowBlock): a
    /// column of SI values for each factor of `space`.
    pub fn values(&mut self, space: &Space, design: &Design, replicate: u64, rows: Range<u64>) -> &[Vec<f64>] {
        let per_point = design.rows_per_point();
        let points = rows.start / per_point..rows.end.div_ceil(per_point);
        self.inputs.resize(design.factors(), Vec::new());
        if self.points.as_ref().is_none_or(|(of, _)| *of != replicate) {
            self.points = Some((replicate, design.replicate(replicate)));
        }
        if let Some((_, base)) = &self.points {
            self.columns.fill(space, design, base, points.start, (points.end - points.start) as usize);
        }
        for (factor, input) in self.inputs.iter_mut().enumerate() {
            input.clear();
            let columns: Vec<&Vec<f64>> =
                design.runs().iter().map(|run| &self.columns.values[design.column(run, factor)]).collect();
            for row in rows.clone() {
                let (point, run) = (row / per_point - points.start, row % per_point);
                input.push(columns[run as usize][point as usize]);
            }
        }
        &self.inputs
    }
}

/// A worker of a model, and the outputs of the rows that it evaluated last.
pub(crate) struct RowWorker<'a> {
    worker: Box<dyn Worker + 'a>,
    pub batch: Batch,
    /// Of one design.
    pub values: RowValues,
}

impl<'a> RowWorker<'a> {
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>) -> Self {
        Self { worker: model.worker(context), batch: Batch::new(model), values: RowValues::default() }
    }

    /// Evaluates rows of `design`; returns the seconds that they took.
    pub fn run(&mut self, space: &Space, design: &Design, range: &RowRange) -> f64 {
        let columns = self.values.values(space, design, range.replicate, range.rows.clone());
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        self.batch.reset(range.count() as usize);
        let start = Instant::now();
        self.worker.run(&inputs, &mut self.batch);
        let seconds = start.elapsed().as_secs_f64();
        self.batch.settle();
        seconds
    }
}

#[cfg(test)]
#[path = "tests/rows.rs"]
mod tests;
