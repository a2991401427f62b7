//! The rows of a design that are missing in a store: their values, and where their outputs go.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::executor::{RowRange, RowSource};
use super::store::{Piece, Store};
use super::{FailurePolicy, Job, OutputSink, Place, Progress, RunError};
use crate::design::{BasePoints, Design};
use crate::model::Batch;
use crate::space::Space;

/// The rows of some replicates that are missing in a store.
pub(crate) struct MissingRows<'a> {
    pub job: Job<'a>,
    pub store: &'a Store,
    /// Receives every piece before the store does.
    sink: Option<&'a dyn OutputSink>,
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
        sink: Option<&'a dyn OutputSink>,
        failures: FailurePolicy,
    ) -> (Self, Progress) {
        let mut known = Progress::default();
        let mut ranges = VecDeque::new();
        for (replicate, rows) in rows {
            let (present, failed) = store.count(*replicate, rows.clone());
            known.total += rows.end - rows.start;
            known.done += present;
            known.failed += failed;
            let missing = store.missing(*replicate, rows.clone()).into_iter();
            ranges.extend(missing.map(|rows| RowRange { replicate: *replicate, rows }));
        }
        known.recalled = known.done;
        let waiting = Mutex::new(Waiting { ranges, rows: known.total - known.done });
        (Self { job, store, sink, failures, waiting }, known)
    }

    /// Saves pieces in the sink and the store; returns the number of their rows, and how many of them failed.
    pub fn keep(&self, pieces: &[Piece]) -> Result<(u64, u64), RunError> {
        let (mut rows, mut failed) = (0, 0);
        for piece in pieces {
            self.sink.map_or(Ok(()), |sink| sink.append(piece)).map_err(|source| RunError::NotKept { source })?;
            self.store.insert(piece);
            rows += piece.rows(self.store.outputs());
            failed += piece.failed_rows().len() as u64;
            if let (FailurePolicy::Fail, Some((row, _, reason))) = (self.failures, piece.failures.first()) {
                let (row, per_point) = (piece.first + u64::from(*row), self.job.design.rows_per_point());
                let row = Place { replicate: piece.replicate, point: row / per_point, run: row % per_point };
                return Err(RunError::RowFailed { row, reason: reason.clone() });
            }
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
        self.keep(&answered(range, batch))
    }

    fn remote(&self) -> Option<&MissingRows<'_>> {
        Some(self)
    }
}

/// Returns the evaluated rows of a settled batch as pieces: one, unless the model has given up on some of them.
pub(crate) fn answered(range: &RowRange, batch: &Batch) -> Vec<Piece> {
    let piece = Piece::from_batches(range.replicate, range.rows.start, std::slice::from_ref(batch));
    let Some(reason) = batch.given_up().map(|give_up| &give_up.reason) else { return vec![piece] };
    let mut open: Vec<u32> = piece.failures.iter().filter(|(.., why)| why == reason).map(|(row, ..)| *row).collect();
    open.dedup();
    let mut pieces = piece.without(open, batch.outputs());
    if let Some(first) = pieces.first_mut() {
        (first.flags, first.counts) = (piece.flags, piece.counts);
    }
    pieces
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
    /// Returns the values of rows `rows` of `replicate`, counted within the replicate as in [`Piece`](super::Piece): a
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
            let column = |run| &self.columns.values[design.column(run, factor)];
            let columns: Vec<&Vec<f64>> = design.runs().iter().map(column).collect();
            input.extend(rows.clone().map(|row| {
                let (point, run) = (row / per_point - points.start, row % per_point);
                columns[run as usize][point as usize]
            }));
        }
        &self.inputs
    }
}

#[cfg(test)]
mod tests;
