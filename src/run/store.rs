//! Outputs of any rows of a design, from any source: the current run, a journal, other machines, a file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::model::{Batch, Counts, Model, RowFailure};

/// Outputs of consecutive rows of one replicate. Rows are counted within the replicate, base point by base point (row =
/// point * [`rows_per_point`](crate::design::Design::rows_per_point) + run), so that their numbers stay the same when the
/// design grows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowBlock {
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

impl RowBlock {
    /// Creates a block that starts at row `first` of `replicate` from settled batches: one for each run of a base
    /// point, whose rows are the base points; or a single one of consecutive rows.
    pub fn from_batches(replicate: u64, first: u64, batches: &[Batch]) -> Self {
        let (points, outputs) = batches.first().map_or((0, 0), |batch| (batch.rows(), batch.outputs()));
        let (runs, mut block) = (batches.len(), Self { replicate, first, ..Self::default() });
        block.values.resize(points * runs * outputs, f64::NAN);
        for (run, batch) in batches.iter().enumerate() {
            batch.write_rows(&mut block.values[run * outputs..], runs * outputs);
            for (output, point, why) in batch.failures() {
                block.failures.push(((point * runs + run) as u32, *output as u32, why.clone()));
            }
            block.add_counts(batch.flags(), batch.counts());
        }
        block.failures.sort_unstable();
        for (row, output, _) in &block.failures {
            block.values[*row as usize * outputs + *output as usize] = f64::NAN;
        }
        block
    }

    /// Adds flags and counts of more rows.
    fn add_counts(&mut self, flags: &[u64], counts: &Counts) {
        self.flags.resize(self.flags.len().max(flags.len()), 0);
        for (mine, theirs) in self.flags.iter_mut().zip(flags) {
            *mine += theirs;
        }
        self.counts.merge(counts);
    }

    /// Returns whether flags were raised or anything counted over its rows: such a block cannot be divided.
    pub(crate) fn is_counted(&self) -> bool {
        self.flags.iter().any(|raised| *raised > 0) || !self.counts.is_zero()
    }

    /// Returns the number of rows, of `outputs` outputs each.
    pub fn rows(&self, outputs: usize) -> u64 {
        (self.values.len() / outputs.max(1)) as u64
    }

    /// Returns whether every row has all its values, and its failures are among them.
    pub(crate) fn is_complete(&self, outputs: usize) -> bool {
        let rows = self.rows(outputs);
        let mut failures = self.failures.iter();
        rows as usize * outputs == self.values.len()
            && failures.all(|(row, output, _)| u64::from(*row) < rows && (*output as usize) < outputs)
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

    /// Returns the rows `rows`, all of them in the block, without flags and counts.
    fn part(&self, rows: Range<u64>, outputs: usize) -> Self {
        let (from, end) = ((rows.start - self.first) as usize, (rows.end - self.first) as usize);
        let failures = self.failures.iter().filter(|(row, ..)| (from..end).contains(&(*row as usize)));
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
    blocks: Mutex<Blocks>,
}

/// Blocks by replicate and first row. They do not overlap.
type Blocks = BTreeMap<(u64, u64), RowBlock>;

impl Store {
    /// Creates an empty store for the rows of a design through `model`.
    pub fn new(model: &dyn Model) -> Self {
        Self { outputs: model.outputs().len(), blocks: Mutex::default() }
    }

    /// Returns the number of outputs of every row.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    fn held(&self) -> MutexGuard<'_, Blocks> {
        // A thread that panicked has ended the run; what it has inserted does not matter then.
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the blocks that contain any of the rows `rows` of `replicate`, in order, each with those of its rows.
    fn overlapping<'b>(&self, held: &'b Blocks, replicate: u64, rows: &Range<u64>) -> Vec<(&'b RowBlock, Range<u64>)> {
        let mut overlapping = Vec::new();
        for (_, block) in held.range((replicate, 0)..(replicate, rows.end)).rev() {
            let end = block.first + block.rows(self.outputs);
            let common = block.first.max(rows.start)..end.min(rows.end);
            if common.is_empty() {
                break;
            }
            overlapping.push((block, common));
        }
        overlapping.reverse();
        overlapping
    }

    /// Saves the rows of `block` in the store, replacing existing ones; returns the number of new rows. Rows that were
    /// counted together with a replaced one become missing, unless `block` has them too.
    pub fn insert(&self, block: RowBlock) -> u64 {
        let rows = block.first..block.first + block.rows(self.outputs);
        let mut held = self.held();
        let replaced = self.overlapping(&held, block.replicate, &rows);
        let existing: u64 = replaced.iter().map(|(_, common)| common.end - common.start).sum();
        let replaced: Vec<RowBlock> = replaced.into_iter().map(|(old, _)| old.clone()).collect();
        for old in replaced {
            held.remove(&(old.replicate, old.first));
            let old_rows = 0..old.rows(self.outputs) as u32;
            let replaced = old_rows.filter(|row| rows.contains(&(old.first + u64::from(*row))));
            self.keep_without(&mut held, &old, replaced);
        }
        if !rows.is_empty() {
            held.insert((block.replicate, block.first), block);
        }
        rows.end - rows.start - existing
    }

    /// Keeps the rows of a removed block except `failed`, unless counts over it, which cannot be divided, go with these.
    fn keep_without(&self, held: &mut Blocks, block: &RowBlock, failed: impl IntoIterator<Item = u32>) {
        if !block.is_counted() {
            let parts = block.without(failed, self.outputs).into_iter();
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
        let (mut present, mut failed) = (0, 0);
        for (block, common) in self.overlapping(&held, replicate, &rows) {
            present += common.end - common.start;
            let rows = block.failed_rows().into_iter().map(|row| block.first + u64::from(row));
            failed += rows.filter(|row| common.contains(row)).count() as u64;
        }
        (present, failed)
    }

    /// Removes the rows that failed in an output, and those that were counted together with one of them, so that they
    /// are missing; returns how many failed.
    pub fn forget_failures(&self) -> u64 {
        let mut held = self.held();
        let failing: Vec<RowBlock> =
            held.extract_if(.., |_, block| !block.failures.is_empty()).map(|(_, block)| block).collect();
        let mut count = 0;
        for block in failing {
            let failed = block.failed_rows();
            count += failed.len() as u64;
            self.keep_without(&mut held, &block, failed);
        }
        count
    }

    /// Returns the rows `rows` of `replicate` as one block; `None` if one of them is missing. Flags and counts are
    /// those of the blocks that begin among them.
    pub fn block(&self, replicate: u64, rows: Range<u64>) -> Option<RowBlock> {
        let held = self.held();
        let mut joined = RowBlock { replicate, first: rows.start, ..RowBlock::default() };
        let mut next = rows.start;
        for (block, common) in self.overlapping(&held, replicate, &rows) {
            if common.start != next {
                return None;
            }
            next = common.end;
            let (begins, before) = (block.first >= rows.start, (common.start - rows.start) as u32);
            let part = block.part(common, self.outputs);
            joined.values.extend(part.values);
            joined.failures.extend(part.failures.into_iter().map(|(row, output, why)| (before + row, output, why)));
            if begins {
                joined.add_counts(&block.flags, &block.counts);
            }
        }
        (next == rows.end).then_some(joined)
    }

    /// Returns all existing rows as blocks in order.
    pub fn blocks(&self) -> Vec<RowBlock> {
        self.held().values().cloned().collect()
    }

    /// Sets `batches`, one for each run, to the base points from `point` on, as many as the batches have rows. Returns
    /// false, with undefined batches, if a row is missing.
    pub(super) fn recall(&self, replicate: u64, point: u64, batches: &mut [Batch]) -> bool {
        let (runs, points) = (batches.len(), batches.first().map_or(0, Batch::rows));
        let (first, outputs) = (point * runs as u64, self.outputs);
        let rows = first..first + (points * runs) as u64;
        let (held, mut next) = (self.held(), first);
        for (block, common) in self.overlapping(&held, replicate, &rows) {
            if common.start != next {
                return false;
            }
            next = common.end;
            // Rows count from the first one that is asked for, places from the first one of the block.
            let (start, end) = ((common.start - first) as usize, (common.end - first) as usize);
            let place = (common.start - block.first) as usize;
            for (run, batch) in batches.iter_mut().enumerate() {
                let row = start + (run + runs - start % runs) % runs;
                if row < end {
                    let values = &block.values[(place + row - start) * outputs..(place + end - start) * outputs];
                    batch.set_rows(row / runs, values, runs * outputs);
                }
            }
            for (row, output, why) in &block.failures {
                if let Some(row) = (*row as usize).checked_sub(place).map(|row| row + start).filter(|row| *row < end) {
                    batches[row % runs].fail(row / runs, *output as usize, why.clone());
                }
            }
            if block.first >= first {
                // Counts are summed over all runs of a block, so any batch may hold them.
                batches[0].add_counts(&block.flags, &block.counts);
            }
        }
        batches.iter_mut().for_each(Batch::settle);
        next == rows.end
    }
}

#[cfg(test)]
#[path = "tests/store.rs"]
mod tests;
