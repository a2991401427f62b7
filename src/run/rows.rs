//! Rows of a design as a task: those that a store lacks, through the workers into the store.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::journal::{record, write_record};
use super::remote::{Abroad, DesignKey, Errand};
use super::store::{Piece, Store};
use super::task::{Evaluated, Finished, Task};
use super::{FailurePolicy, Job, PieceSink, Place, RunError};
use crate::binary::{Binary, Reader};
use crate::design::BasePoints;
use crate::model::{Batch, RowFailure, Worker};

/// The rows of some replicates that a store lacks.
pub(super) struct MissingRows<'a> {
    job: Job<'a>,
    store: &'a Store,
    /// Takes every piece before the store does.
    sink: Option<PieceSink<'a>>,
    failures: FailurePolicy,
    waiting: Mutex<Waiting>,
}

struct Waiting {
    /// As (replicate, rows), in the order in which they are run.
    ranges: VecDeque<(u64, Range<u64>)>,
    rows: u64,
}

/// How many of some rows are known, and how many of these have failed.
pub(super) struct Known {
    pub total: u64,
    pub rows: u64,
    pub failed: u64,
}

impl<'a> MissingRows<'a> {
    /// Those of `rows` (replicate, and rows counted within it) that `store` lacks; and what it knows.
    pub fn new(
        job: Job<'a>,
        rows: &[(u64, Range<u64>)],
        store: &'a Store,
        sink: Option<PieceSink<'a>>,
        failures: FailurePolicy,
    ) -> (Self, Known) {
        let mut known = Known { total: 0, rows: 0, failed: 0 };
        let mut ranges = VecDeque::new();
        for (replicate, rows) in rows {
            let (present, failed) = store.count(*replicate, rows.clone());
            known.total += rows.end - rows.start;
            known.rows += present;
            known.failed += failed;
            ranges.extend(store.missing(*replicate, rows.clone()).into_iter().map(|range| (*replicate, range)));
        }
        let waiting = Mutex::new(Waiting { ranges, rows: known.total - known.rows });
        (Self { job, store, sink, failures, waiting }, known)
    }
}

impl Task for MissingRows<'_> {
    type Piece = (u64, Range<u64>);
    type Output = Vec<Piece>;
    type Scratch = (RowValues, Batch);

    fn scratch(&self) -> Self::Scratch {
        (RowValues::default(), Batch::new(self.job.model))
    }

    /// `most` rows, or fewer so that all workers have some to the end.
    fn next(&self, most: u64, workers: usize) -> Option<Self::Piece> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let share = (waiting.rows / (2 * workers as u64)).max(1);
        let (replicate, rows) = waiting.ranges.front_mut()?;
        let taken = rows.start..rows.end.min(rows.start + most.min(share));
        rows.start = taken.end;
        let replicate = *replicate;
        if rows.is_empty() {
            waiting.ranges.pop_front();
        }
        waiting.rows -= taken.end - taken.start;
        Some((replicate, taken))
    }

    fn rows(&self, (_, rows): &Self::Piece) -> u64 {
        rows.end - rows.start
    }

    fn evaluate(
        &self,
        worker: &mut dyn Worker,
        (values, batch): &mut Self::Scratch,
        (replicate, rows): &Self::Piece,
        _: &dyn Fn(u64),
    ) -> Evaluated<Vec<Piece>> {
        let inputs: Vec<&[f64]> = values.values(self.job, *replicate, rows.clone()).iter().map(Vec::as_slice).collect();
        batch.reset((rows.end - rows.start) as usize);
        worker.run(&inputs, batch);
        batch.settle();
        let given_up = batch.given_up().cloned();
        let piece = Piece::from_batch(*replicate, rows.start, batch);
        let reason = given_up.as_ref().map(|give_up| &give_up.reason);
        let output = Some(answered(piece, reason, self.store.outputs()));
        Evaluated { output, given_up }
    }

    fn accept(&self, _: &Self::Piece, pieces: Vec<Piece>) -> Result<Finished, RunError> {
        let mut finished = Finished { rows: 0, failed: 0 };
        for piece in &pieces {
            self.sink.map_or(Ok(()), |sink| sink(piece)).map_err(|source| RunError::NotKept { source })?;
            self.store.insert(piece);
            let mut failed: Vec<u32> = piece.failures.iter().map(|(row, ..)| *row).collect();
            failed.dedup();
            finished.rows += piece.rows(self.store.outputs());
            finished.failed += failed.len() as u64;
            if let (FailurePolicy::Fail, Some((row, _, reason))) = (self.failures, piece.failures.first()) {
                let (row, per_point) = (piece.first + u64::from(*row), self.job.design.rows_per_point());
                let row = Place { replicate: piece.replicate, point: row / per_point, run: row % per_point };
                return Err(RunError::RowFailed { row, reason: reason.clone() });
            }
        }
        Ok(finished)
    }

    fn abroad(&self) -> Option<&dyn Abroad<Self::Piece, Vec<Piece>>> {
        Some(self)
    }
}

impl Abroad<(u64, Range<u64>), Vec<Piece>> for MissingRows<'_> {
    fn errand(&self) -> Errand {
        Errand {
            is_of_blocks: false,
            design: DesignKey::new(self.job.design),
            from: 0,
            end: 0,
            keeps_outputs: true,
            fails: self.failures == FailurePolicy::Fail,
        }
    }

    fn write_piece(&self, (replicate, rows): &(u64, Range<u64>), out: &mut Vec<u8>) {
        [*replicate, rows.start, rows.end].iter().for_each(|number| number.write(out));
    }

    fn read_piece(&self, from: &mut Reader<'_>) -> Option<(u64, Range<u64>)> {
        let (replicate, rows) = (u64::read(from)?, u64::read(from)?..u64::read(from)?);
        let design = self.job.design;
        let is_one = replicate < design.settings().replicates && rows.start < rows.end;
        (is_one && rows.end <= design.points_per_replicate() * design.rows_per_point()).then_some((replicate, rows))
    }

    /// Pieces travel as they go on record.
    fn write_output(&self, pieces: &Vec<Piece>, out: &mut Vec<u8>) {
        pieces.iter().for_each(|piece| write_record(out, piece));
    }

    fn read_output(&self, (replicate, rows): &(u64, Range<u64>), from: &mut Reader<'_>) -> Option<Vec<Piece>> {
        let mut pieces = Vec::new();
        while !from.bytes.is_empty() {
            let piece = record(from)?;
            let end = piece.first.checked_add(piece.rows(self.store.outputs()))?;
            if piece.replicate != *replicate || piece.first < rows.start || end > rows.end {
                return None;
            }
            pieces.push(piece);
        }
        Some(pieces)
    }
}

/// The rows of a piece that were answered: all, unless the model has given up for `reason`.
fn answered(piece: Piece, reason: Option<&RowFailure>, outputs: usize) -> Vec<Piece> {
    let Some(reason) = reason else { return vec![piece] };
    let open: Vec<u32> = piece.failures.iter().filter(|(.., why)| why == reason).map(|(row, ..)| *row).collect();
    let mut pieces: Vec<Piece> = Vec::new();
    let mut counted = Some((piece.flags, piece.counts));
    for row in (0..piece.values.len() / outputs.max(1)).filter(|row| !open.contains(&(*row as u32))) {
        let at = piece.first + row as u64;
        if pieces.last().is_none_or(|last| last.first + last.rows(outputs) != at) {
            let (flags, counts) = counted.take().unwrap_or_default();
            let (replicate, first) = (piece.replicate, at);
            pieces.push(Piece { replicate, first, flags, counts, ..Piece::default() });
        }
        let Some(last) = pieces.last_mut() else { continue };
        let here = last.rows(outputs) as u32;
        last.values.extend_from_slice(&piece.values[row * outputs..][..outputs]);
        let of_row = piece.failures.iter().filter(|(failed, ..)| *failed == row as u32);
        last.failures.extend(of_row.map(|(_, output, why)| (here, *output, why.clone())));
    }
    pieces
}

/// Makes the values of any rows of a design.
#[derive(Debug, Default)]
pub struct RowValues {
    /// The replicate whose points these are.
    points: Option<(u64, BasePoints)>,
    /// Columns of A, B and C over the base points.
    unit: Vec<Vec<f64>>,
    values: Vec<Vec<f64>>,
    /// One column of each factor over the rows.
    inputs: Vec<Vec<f64>>,
}

impl RowValues {
    /// The values of rows `rows` of `replicate`, counted within the replicate as in [`Piece`](super::Piece): a column of
    /// SI values for each factor.
    pub fn values(&mut self, job: Job<'_>, replicate: u64, rows: Range<u64>) -> &[Vec<f64>] {
        let (design, factors) = (job.design, job.design.factors());
        let per_point = design.rows_per_point();
        let points = rows.start / per_point..rows.end.div_ceil(per_point);
        self.unit.resize(design.columns(), Vec::new());
        self.values.resize(design.columns(), Vec::new());
        self.inputs.resize(factors, Vec::new());
        let length = (points.end - points.start) as usize;
        self.unit.iter_mut().for_each(|column| column.resize(length, 0.0));
        if self.points.as_ref().is_none_or(|(of, _)| *of != replicate) {
            self.points = Some((replicate, design.replicate(replicate)));
        }
        if let Some((_, base)) = &self.points {
            base.fill(points.start, &mut self.unit);
        }
        for (k, (unit, values)) in self.unit.iter().zip(&mut self.values).enumerate() {
            values.resize(length, 0.0);
            job.space.factors()[design.factor_of(k)].fill_si(unit, values);
        }
        for (factor, input) in self.inputs.iter_mut().enumerate() {
            input.clear();
            let column = |run| &self.values[design.column(run, factor)];
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
