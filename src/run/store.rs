//! Outputs of any rows of a design, from any source: the current run, a journal, other machines, a file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::BLOCK;
use crate::design::Design;
use crate::model::{Batch, Counts, Model, RowFailure};

/// Outputs of consecutive rows of one replicate. Rows are counted within the replicate, base point by base point (row =
/// point * [`Design::rows_per_point`] + run), so that their numbers stay the same when the design grows.
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
            if run == 0 {
                (piece.flags, piece.counts) = (batch.flags().to_vec(), batch.counts().clone());
            } else {
                piece.flags.iter_mut().zip(batch.flags()).for_each(|(mine, theirs)| *mine += theirs);
                piece.counts.merge(batch.counts());
            }
        }
        piece.failures.sort_unstable();
        for (row, output, _) in &piece.failures {
            piece.values[*row as usize * outputs + *output as usize] = f64::NAN;
        }
        piece
    }

    /// Returns whether flags were raised or anything counted over its rows: such a piece cannot be divided.
    pub(crate) fn is_counted(&self) -> bool {
        self.flags.iter().any(|raised| *raised > 0) || !self.counts.is_zero()
    }

    /// Returns the number of rows, of `outputs` outputs each.
    pub fn rows(&self, outputs: usize) -> u64 {
        (self.values.len() / outputs.max(1)) as u64
    }
}

/// The existing outputs of a design that may still grow, shared between threads. A run with a
/// [store](crate::Runner::store) evaluates only the missing ones.
#[derive(Debug)]
pub struct Store {
    outputs: usize,
    rows_per_point: u64,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    /// By replicate and block of base points.
    chunks: BTreeMap<(u64, u64), Chunk>,
    /// Counts over consecutive rows, by replicate and first row. They do not overlap, and all their rows exist: a count
    /// cannot be divided, so it is removed with the first of its rows that is removed.
    counted: BTreeMap<(u64, u64), Counted>,
}

/// Flags and counts of the rows of one piece.
#[derive(Debug)]
struct Counted {
    /// One past the last row.
    end: u64,
    flags: Vec<u64>,
    counts: Counts,
}

/// Outputs of the rows of one block.
#[derive(Debug)]
struct Chunk {
    values: Vec<f64>,
    present: Vec<bool>,
    failures: BTreeMap<(u32, u32), RowFailure>,
}

impl Store {
    /// Creates an empty store for the rows of `design` through `model`.
    pub fn new(design: &Design, model: &dyn Model) -> Self {
        let (outputs, rows_per_point) = (model.outputs().len(), design.rows_per_point());
        Self { outputs, rows_per_point, held: Mutex::default() }
    }

    /// Returns the number of outputs of every row.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        // A thread that panicked has ended the run; half-changed chunks do not matter then.
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn chunk_rows(&self) -> u64 {
        BLOCK * self.rows_per_point
    }

    /// Saves the rows of `piece` in the store, replacing existing ones; returns the number of new rows. Rows that were
    /// counted together with a replaced one become missing, unless `piece` has them too.
    pub fn insert(&self, piece: &Piece) -> u64 {
        let rows = piece.rows(self.outputs);
        let mut new = 0;
        let mut held = self.held();
        let all = piece.first..piece.first + rows;
        for counted in held.take_counted(piece.replicate, all.clone()) {
            for beside in [counted.start..all.start, all.end..counted.end] {
                self.remove(&mut held, piece.replicate, beside);
            }
        }
        if piece.is_counted() && rows > 0 {
            let (flags, counts) = (piece.flags.clone(), piece.counts.clone());
            held.counted.insert((piece.replicate, all.start), Counted { end: all.end, flags, counts });
        }
        for (block, range) in self.by_block(all) {
            let length = self.chunk_rows() as usize;
            let chunk =
                held.chunks.entry((piece.replicate, block)).or_insert_with(|| Chunk::empty(length, self.outputs));
            let at = (range.start - block * self.chunk_rows()) as usize;
            let (from, count) = ((range.start - piece.first) as usize, (range.end - range.start) as usize);
            new += chunk.present[at..at + count].iter().filter(|present| !**present).count() as u64;
            chunk.present[at..at + count].fill(true);
            let values = &piece.values[from * self.outputs..][..count * self.outputs];
            chunk.values[at * self.outputs..][..values.len()].copy_from_slice(values);
            chunk.forget_failures(at..at + count);
            let here = |row: u32| (from..from + count).contains(&(row as usize));
            for (row, output, why) in piece.failures.iter().filter(|(row, ..)| here(*row)) {
                chunk.failures.insert(((*row as usize - from + at) as u32, *output), why.clone());
            }
        }
        new
    }

    /// Removes the rows `rows` of `replicate`; an empty range, however it came about, removes none.
    fn remove(&self, held: &mut Held, replicate: u64, rows: Range<u64>) {
        for (block, range) in self.by_block(rows) {
            let Some(chunk) = held.chunks.get_mut(&(replicate, block)) else { continue };
            let start = block * self.chunk_rows();
            let here = (range.start - start) as usize..(range.end - start) as usize;
            chunk.present[here.clone()].fill(false);
            chunk.forget_failures(here);
        }
    }

    /// Splits the rows `rows` of `replicate` at the ends of blocks.
    fn by_block(&self, rows: Range<u64>) -> impl Iterator<Item = (u64, Range<u64>)> + use<> {
        let length = self.chunk_rows();
        let blocks = if rows.is_empty() { 0..0 } else { rows.start / length..rows.end.div_ceil(length) };
        blocks.map(move |block| (block, rows.start.max(block * length)..rows.end.min((block + 1) * length)))
    }

    /// Returns the missing rows among `rows` of `replicate` as ranges in order, each within one block.
    pub fn missing(&self, replicate: u64, rows: Range<u64>) -> Vec<Range<u64>> {
        let held = self.held();
        let mut missing: Vec<Range<u64>> = Vec::new();
        for (block, range) in self.by_block(rows) {
            let Some(chunk) = held.chunks.get(&(replicate, block)) else {
                missing.push(range);
                continue;
            };
            let start = block * self.chunk_rows();
            let absent = |row: &u64| !chunk.present[(row - start) as usize];
            let mut row = range.start;
            while let Some(first) = (row..range.end).find(absent) {
                let end = (first..range.end).find(|row| !absent(row)).unwrap_or(range.end);
                missing.push(first..end);
                row = end;
            }
        }
        missing
    }

    /// Returns the number of existing rows of `replicate` among `rows`, and how many of them failed in an output.
    pub fn count(&self, replicate: u64, rows: Range<u64>) -> (u64, u64) {
        let held = self.held();
        let (mut present, mut failed) = (0, 0);
        for (block, range) in self.by_block(rows) {
            let Some(chunk) = held.chunks.get(&(replicate, block)) else { continue };
            let start = block * self.chunk_rows();
            let here = (range.start - start) as usize..(range.end - start) as usize;
            present += chunk.present[here.clone()].iter().filter(|present| **present).count() as u64;
            failed += chunk.failed_rows(here);
        }
        (present, failed)
    }

    /// Returns the number of existing rows of all replicates.
    pub fn rows(&self) -> u64 {
        let present = |chunk: &Chunk| chunk.present.iter().filter(|present| **present).count() as u64;
        self.held().chunks.values().map(present).sum()
    }

    /// Removes the rows that failed in an output, and those that were counted together with one of them, so that they
    /// are missing; returns how many failed.
    pub fn forget_failures(&self) -> u64 {
        let mut held = self.held();
        let mut failed: Vec<(u64, u64)> = Vec::new();
        for ((replicate, block), chunk) in &held.chunks {
            let row = |row: &u32| (*replicate, block * self.chunk_rows() + u64::from(*row));
            failed.extend(chunk.failures.keys().map(|(at, _)| row(at)));
        }
        failed.dedup();
        for (replicate, row) in &failed {
            for rows in held.take_counted(*replicate, *row..row + 1) {
                self.remove(&mut held, *replicate, rows);
            }
            self.remove(&mut held, *replicate, *row..row + 1);
        }
        failed.len() as u64
    }

    /// Returns the rows `rows` of `replicate` as one piece; `None` if one of them is missing. Flags and counts are
    /// those of the pieces that begin among them.
    pub fn piece(&self, replicate: u64, rows: Range<u64>) -> Option<Piece> {
        let held = self.held();
        let mut piece = Piece { replicate, first: rows.start, ..Piece::default() };
        for (block, range) in self.by_block(rows.clone()) {
            let chunk = held.chunks.get(&(replicate, block))?;
            let start = block * self.chunk_rows();
            let here = (range.start - start) as usize..(range.end - start) as usize;
            if chunk.present[here.clone()].contains(&false) {
                return None;
            }
            piece.values.extend_from_slice(&chunk.values[here.start * self.outputs..here.end * self.outputs]);
            for ((row, output), why) in chunk.failures_among(here.clone()) {
                piece.failures.push(((start + u64::from(row) - rows.start) as u32, output, why.clone()));
            }
        }
        for Counted { flags, counts, .. } in held.counted_from(replicate, rows) {
            if piece.flags.is_empty() {
                (piece.flags, piece.counts) = (flags.clone(), counts.clone());
            } else {
                piece.flags.iter_mut().zip(flags).for_each(|(mine, theirs)| *mine += theirs);
                piece.counts.merge(counts);
            }
        }
        Some(piece)
    }

    /// Returns all existing rows as pieces in order, each within one block.
    pub fn pieces(&self) -> Vec<Piece> {
        let length = self.chunk_rows();
        let blocks: Vec<(u64, u64)> = self.held().chunks.keys().copied().collect();
        let present = |(replicate, block): (u64, u64)| {
            let rows = block * length..(block + 1) * length;
            let mut first = rows.start;
            let mut found = Vec::new();
            for missing in self.missing(replicate, rows.clone()) {
                found.extend((first < missing.start).then_some((replicate, first..missing.start)));
                first = missing.end;
            }
            found.extend((first < rows.end).then_some((replicate, first..rows.end)));
            found
        };
        blocks.into_iter().flat_map(present).filter_map(|(replicate, rows)| self.piece(replicate, rows)).collect()
    }

    /// Sets `batches`, one for each run, to the base points from `point` on, as many as the batches have rows, all in
    /// one block. Returns false, with undefined batches, if a row is missing.
    pub(super) fn recall(&self, replicate: u64, point: u64, batches: &mut [Batch]) -> bool {
        let held = self.held();
        let Some(chunk) = held.chunks.get(&(replicate, point / BLOCK)) else { return false };
        let runs = batches.len();
        let points = batches.first().map_or(0, Batch::rows);
        let first = (point % BLOCK) as usize * runs;
        let here = first..first + points * runs;
        if chunk.present[here.clone()].contains(&false) {
            return false;
        }
        let rows = &chunk.values[here.start * self.outputs..here.end * self.outputs];
        for (run, batch) in batches.iter_mut().enumerate() {
            for output in 0..self.outputs {
                let column = batch.column_mut(output);
                for (point, value) in column.iter_mut().enumerate() {
                    *value = rows[(point * runs + run) * self.outputs + output];
                }
            }
        }
        for ((row, output), why) in chunk.failures_among(here) {
            let row = row as usize - first;
            batches[row % runs].fail(row / runs, output as usize, why.clone());
        }
        // Counts are summed over all runs of a block, so any batch may hold them.
        let rows = point * self.rows_per_point;
        for Counted { flags, counts, .. } in held.counted_from(replicate, rows..rows + (points * runs) as u64) {
            batches[0].add_counts(flags, counts);
        }
        batches.iter_mut().for_each(Batch::settle);
        true
    }
}

impl Chunk {
    fn empty(rows: usize, outputs: usize) -> Self {
        let (values, present) = (vec![f64::NAN; rows * outputs], vec![false; rows]);
        Self { values, present, failures: BTreeMap::new() }
    }

    fn forget_failures(&mut self, rows: Range<usize>) {
        if !self.failures.is_empty() {
            self.failures.retain(|(row, _), _| !rows.contains(&(*row as usize)));
        }
    }

    fn failures_among(&self, rows: Range<usize>) -> impl Iterator<Item = ((u32, u32), &RowFailure)> {
        self.failures.range((rows.start as u32, 0)..(rows.end as u32, 0)).map(|(place, why)| (*place, why))
    }

    fn failed_rows(&self, rows: Range<usize>) -> u64 {
        let mut last = None;
        self.failures_among(rows).filter(|((row, _), _)| last.replace(*row) != Some(*row)).count() as u64
    }
}

impl Held {
    /// Iterates over the counts that start among the rows `rows` of `replicate`.
    fn counted_from(&self, replicate: u64, rows: Range<u64>) -> impl Iterator<Item = &Counted> {
        self.counted.range((replicate, rows.start)..(replicate, rows.end)).map(|(_, counted)| counted)
    }

    /// Removes the counts that cover any of the rows `rows` of `replicate`; returns their ranges.
    fn take_counted(&mut self, replicate: u64, rows: Range<u64>) -> Vec<Range<u64>> {
        let before = self.counted.range((replicate, 0)..(replicate, rows.end)).rev();
        let found = before.map(|((_, first), counted)| *first..counted.end);
        let found: Vec<Range<u64>> = found.take_while(|counted| counted.end > rows.start).collect();
        for counted in &found {
            self.counted.remove(&(replicate, counted.start));
        }
        found
    }
}

#[cfg(test)]
mod tests;
