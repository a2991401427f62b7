//! Outputs of any rows of a design, from any source: the current run, a journal, other machines, a file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::model::{Batch, Counts, Model, RowFailure};

/// Outputs of consecutive rows of one replicate. Rows are counted within the replicate, base point by base point (row =
/// point * [`rows_per_point`](crate::design::Design::rows_per_point) + run), so that their numbers stay the same when the
/// design grows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Piece {
    /// The replicate.
    pub replicate: u64,
    /// The first row.
    pub first: u64,
    /// Outputs in SI units, row by row; NaN where missing.
    pub values: Vec<f64>,
    /// Why outputs are missing, as (row from the first one, output, reason), in order, for every value not finite.
    pub failures: Vec<(u32, u32, RowFailure)>,
    /// How many of the rows raised each validity flag of the model.
    pub flags: Vec<u64>,
    /// The model's counters, summed over the rows.
    pub counts: Counts,
}

impl Piece {
    /// Creates a piece that starts at row `first` of `replicate` from settled batches: one for each run of a base
    /// point, whose rows are the base points; or a single one of consecutive rows.
    pub fn from_batches(replicate: u64, first: u64, batches: &[Batch]) -> Self {
        let (points, outputs) = batches.first().map_or((0, 0), |batch| (batch.rows(), batch.outputs()));
        let (runs, mut piece) = (batches.len(), Self { replicate, first, ..Self::default() });
        piece.values.resize(points * runs * outputs, f64::NAN);
        for (run, batch) in batches.iter().enumerate() {
            for output in 0..outputs {
                for (point, value) in batch.column(output).iter().enumerate() {
                    piece.values[(point * runs + run) * outputs + output] = *value;
                }
            }
            for (output, point, why) in batch.failures() {
                piece.failures.push(((point * runs + run) as u32, *output as u32, why.clone()));
            }
            piece.add_counts(batch.flags(), batch.counts());
        }
        piece.failures.sort_unstable();
        for (row, output, _) in &piece.failures {
            piece.values[*row as usize * outputs + *output as usize] = f64::NAN;
        }
        piece
    }

    /// Adds flags and counts of more rows.
    fn add_counts(&mut self, flags: &[u64], counts: &Counts) {
        self.flags.resize(self.flags.len().max(flags.len()), 0);
        self.flags.iter_mut().zip(flags).for_each(|(mine, theirs)| *mine += theirs);
        self.counts.merge(counts);
    }

    /// Returns whether flags were raised or anything counted over its rows: such a piece cannot be divided.
    pub(crate) fn is_counted(&self) -> bool {
        self.flags.iter().any(|raised| *raised > 0) || !self.counts.is_zero()
    }

    /// Returns the number of rows, of `outputs` outputs each.
    pub fn rows(&self, outputs: usize) -> u64 {
        (self.values.len() / outputs.max(1)) as u64
    }

    /// Returns whether its values are those of whole rows, and its failures among them.
    pub(crate) fn is_whole(&self, outputs: usize) -> bool {
        let rows = self.rows(outputs);
        let fits = |(row, output, _): &(u32, u32, _)| u64::from(*row) < rows && (*output as usize) < outputs;
        rows as usize * outputs == self.values.len() && self.failures.iter().all(fits)
    }

    /// Returns the rows that failed in an output, counted from the first one.
    pub(super) fn failed_rows(&self) -> Vec<u32> {
        let mut rows: Vec<u32> = self.failures.iter().map(|(row, ..)| *row).collect();
        rows.dedup();
        rows
    }

    /// Returns all rows except `failed`, which are counted from the first one and rise, without flags and counts.
    pub(super) fn without(&self, failed: impl IntoIterator<Item = u32>, outputs: usize) -> Vec<Self> {
        let failed = failed.into_iter().map(|row| self.first + u64::from(row));
        let mut next = self.first;
        let between = failed.chain([self.first + self.rows(outputs)]);
        let between = between.map(|row| std::mem::replace(&mut next, row + 1)..row).filter(|rows| !rows.is_empty());
        between.map(|rows| self.part(rows, outputs)).collect()
    }

    /// Returns the rows `rows`, all of them its own, without flags and counts.
    fn part(&self, rows: Range<u64>, outputs: usize) -> Self {
        let (from, end) = ((rows.start - self.first) as usize, (rows.end - self.first) as usize);
        let is_here = |(row, ..): &&(u32, u32, RowFailure)| (from..end).contains(&(*row as usize));
        let failures = self.failures.iter().filter(is_here);
        let failures = failures.map(|(row, output, why)| (row - from as u32, *output, why.clone())).collect();
        let values = self.values[from * outputs..end * outputs].to_vec();
        Self { replicate: self.replicate, first: rows.start, values, failures, ..Self::default() }
    }
}

/// The existing outputs of a design that may still grow, shared between threads. A run with a
/// [store](crate::Runner::store) evaluates only the missing ones.
#[derive(Debug)]
pub struct Store {
    outputs: usize,
    pieces: Mutex<Pieces>,
}

/// Pieces by replicate and first row. They do not overlap.
type Pieces = BTreeMap<(u64, u64), Piece>;

impl Store {
    /// Creates an empty store for the rows of a design through `model`.
    pub fn new(model: &dyn Model) -> Self {
        Self { outputs: model.outputs().len(), pieces: Mutex::default() }
    }

    /// Returns the number of outputs of every row.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    fn held(&self) -> MutexGuard<'_, Pieces> {
        // A thread that panicked has ended the run; what it has inserted does not matter then.
        self.pieces.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the pieces that contain any of the rows `rows` of `replicate`, in order, each with those of its rows.
    fn overlapping<'p>(&self, held: &'p Pieces, replicate: u64, rows: &Range<u64>) -> Vec<(&'p Piece, Range<u64>)> {
        let before = held.range((replicate, 0)..(replicate, rows.end)).rev();
        let common = |(_, piece): (_, &'p Piece)| {
            let end = piece.first + piece.rows(self.outputs);
            (piece, piece.first.max(rows.start)..end.min(rows.end))
        };
        let mut found: Vec<_> = before.map(common).take_while(|(_, common)| !common.is_empty()).collect();
        found.reverse();
        found
    }

    /// Saves the rows of `piece` in the store, replacing existing ones; returns the number of new rows. Rows that were
    /// counted together with a replaced one become missing, unless `piece` has them too.
    pub fn insert(&self, piece: &Piece) -> u64 {
        let rows = piece.first..piece.first + piece.rows(self.outputs);
        let mut held = self.held();
        let replaced = self.overlapping(&held, piece.replicate, &rows);
        let existing: u64 = replaced.iter().map(|(_, common)| common.end - common.start).sum();
        let replaced: Vec<Piece> = replaced.into_iter().map(|(old, _)| old.clone()).collect();
        for old in replaced {
            held.remove(&(old.replicate, old.first));
            let is_replaced = |row: &u32| rows.contains(&(old.first + u64::from(*row)));
            self.keep_without(&mut held, &old, (0..old.rows(self.outputs) as u32).filter(is_replaced));
        }
        if !rows.is_empty() {
            held.insert((piece.replicate, piece.first), piece.clone());
        }
        rows.end - rows.start - existing
    }

    /// Keeps the rows of a removed piece except `failed`, unless counts over it, which cannot be divided, go with these.
    fn keep_without(&self, held: &mut Pieces, piece: &Piece, failed: impl IntoIterator<Item = u32>) {
        if !piece.is_counted() {
            let parts = piece.without(failed, self.outputs).into_iter();
            held.extend(parts.map(|part| ((part.replicate, part.first), part)));
        }
    }

    /// Returns the missing rows among `rows` of `replicate` as ranges in order.
    pub fn missing(&self, replicate: u64, rows: Range<u64>) -> Vec<Range<u64>> {
        let held = self.held();
        let existing = self.overlapping(&held, replicate, &rows).into_iter().map(|(_, common)| common);
        let mut next = rows.start;
        let gaps = existing
            .chain(std::iter::once(rows.end..rows.end))
            .map(|common| std::mem::replace(&mut next, common.end)..common.start);
        gaps.filter(|gap| !gap.is_empty()).collect()
    }

    /// Returns the number of existing rows of `replicate` among `rows`, and how many of them failed in an output.
    pub fn count(&self, replicate: u64, rows: Range<u64>) -> (u64, u64) {
        let held = self.held();
        let counts = self.overlapping(&held, replicate, &rows).into_iter().map(|(piece, common)| {
            let failed =
                piece.failed_rows().into_iter().filter(|row| common.contains(&(piece.first + u64::from(*row))));
            (common.end - common.start, failed.count() as u64)
        });
        counts.fold((0, 0), |(present, failed), (rows, more)| (present + rows, failed + more))
    }

    /// Removes the rows that failed in an output, and those that were counted together with one of them, so that they
    /// are missing; returns how many failed.
    pub fn forget_failures(&self) -> u64 {
        let mut held = self.held();
        let failing: Vec<Piece> =
            held.extract_if(.., |_, piece| !piece.failures.is_empty()).map(|(_, piece)| piece).collect();
        let mut count = 0;
        for piece in failing {
            let failed = piece.failed_rows();
            count += failed.len() as u64;
            self.keep_without(&mut held, &piece, failed);
        }
        count
    }

    /// Returns the rows `rows` of `replicate` as one piece; `None` if one of them is missing. Flags and counts are
    /// those of the pieces that begin among them.
    pub fn piece(&self, replicate: u64, rows: Range<u64>) -> Option<Piece> {
        let held = self.held();
        let mut whole = Piece { replicate, first: rows.start, ..Piece::default() };
        let mut next = rows.start;
        for (piece, common) in self.overlapping(&held, replicate, &rows) {
            if common.start != next {
                return None;
            }
            next = common.end;
            let (begins, before) = (piece.first >= rows.start, (common.start - rows.start) as u32);
            let part = piece.part(common, self.outputs);
            whole.values.extend(part.values);
            whole.failures.extend(part.failures.into_iter().map(|(row, output, why)| (before + row, output, why)));
            if begins {
                whole.add_counts(&piece.flags, &piece.counts);
            }
        }
        (next == rows.end).then_some(whole)
    }

    /// Returns all existing rows as pieces in order.
    pub fn pieces(&self) -> Vec<Piece> {
        self.held().values().cloned().collect()
    }

    /// Sets `batches`, one for each run, to the base points from `point` on, as many as the batches have rows. Returns
    /// false, with undefined batches, if a row is missing.
    pub(super) fn recall(&self, replicate: u64, point: u64, batches: &mut [Batch]) -> bool {
        let (runs, points) = (batches.len(), batches.first().map_or(0, Batch::rows));
        let first = point * runs as u64;
        let Some(piece) = self.piece(replicate, first..first + (points * runs) as u64) else { return false };
        for (run, batch) in batches.iter_mut().enumerate() {
            for output in 0..self.outputs {
                for (point, value) in batch.column_mut(output).iter_mut().enumerate() {
                    *value = piece.values[(point * runs + run) * self.outputs + output];
                }
            }
        }
        for (row, output, why) in piece.failures {
            batches[row as usize % runs].fail(row as usize / runs, output as usize, why);
        }
        // Counts are summed over all runs of a block, so any batch may hold them.
        batches[0].add_counts(&piece.flags, &piece.counts);
        batches.iter_mut().for_each(Batch::settle);
        true
    }
}

#[cfg(test)]
mod tests;
