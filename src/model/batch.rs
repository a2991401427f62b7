//! Outputs of blocks of rows, with their failures and validity flags.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::{Counts, Model};

/// Why a row has no value of an output, as a message of its model. Equal reasons are counted together, so a reason
/// should not contain values of the row; cheap to clone.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RowFailure(Arc<str>);

impl RowFailure {
    /// Creates the reason `text`, a sentence without a full stop.
    pub fn new(text: &str) -> Self {
        Self(text.into())
    }

    /// Returns the reason of an output that is infinite or NaN without an explanation.
    pub(crate) fn not_finite() -> Self {
        Self::new("the model returned a value that is not finite")
    }

    /// Returns the reason of a row that an interrupted run did not finish.
    pub fn interrupted() -> Self {
        Self::new("the run was interrupted")
    }
}

impl fmt::Display for RowFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Why a model cannot continue.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GiveUp {
    /// What happened, and what to do.
    pub reason: RowFailure,
    /// Whether the model must be changed before any run: an error in the input, not a failed run.
    pub is_bad_input: bool,
}

impl From<RowFailure> for GiveUp {
    fn from(reason: RowFailure) -> Self {
        Self { reason, is_bad_input: false }
    }
}

impl fmt::Display for GiveUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason.fmt(f)
    }
}

/// Number of outputs that are transposed at a time: a line of the cache in the table of rows, and few lines of columns.
const TILE: usize = 8;

/// Returns the outputs of each tile.
fn tiles(outputs: usize) -> impl Iterator<Item = Range<usize>> {
    (0..outputs).step_by(TILE).map(move |first| first..(first + TILE).min(outputs))
}

/// Outputs of a block of rows: one column per output, one entry per row.
#[derive(Debug, Clone, Default)]
pub struct Batch {
    rows: usize,
    outputs: usize,
    /// Column by column.
    values: Vec<f64>,
    failures: Vec<(usize, usize, RowFailure)>,
    flags: Vec<u64>,
    counts: Counts,
    given_up: Option<GiveUp>,
}

impl Batch {
    /// Creates an empty batch for the outputs, validity flags and counters of `model`.
    pub fn new(model: &dyn Model) -> Self {
        Self {
            outputs: model.outputs().len(),
            flags: vec![0; model.flags().len()],
            counts: Counts::new(model.counters()),
            ..Self::default()
        }
    }

    /// Clears the batch and makes room for `rows` rows.
    pub fn reset(&mut self, rows: usize) {
        self.rows = rows;
        self.values.clear();
        self.values.resize(rows * self.outputs, f64::NAN);
        self.failures.clear();
        self.flags.fill(0);
        self.counts.clear();
        self.given_up = None;
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of outputs of every row.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Sets one value, in SI units.
    pub fn set(&mut self, row: usize, output: usize, value: f64) {
        self.column_mut(output)[row] = value;
    }

    /// Returns the column of one output, for models that fill it at once.
    pub fn column_mut(&mut self, output: usize) -> &mut [f64] {
        &mut self.values[output * self.rows..(output + 1) * self.rows]
    }

    /// Sets all outputs of the rows from `first` on, as many as `table` has: row k begins at place `k * stride` of it.
    pub fn set_rows(&mut self, first: usize, table: &[f64], stride: usize) {
        let rows = self.rows;
        for (outputs, columns) in tiles(self.outputs).zip(self.values.chunks_mut((TILE * rows).max(1))) {
            for (row, of_row) in table.chunks(stride.max(1)).enumerate() {
                for (column, value) in columns.chunks_exact_mut(rows).zip(&of_row[outputs.clone()]) {
                    column[first + row] = *value;
                }
            }
        }
    }

    /// Writes all outputs of every row to `table`, row by row: row k to place `k * stride`.
    pub(crate) fn write_rows(&self, table: &mut [f64], stride: usize) {
        for (outputs, columns) in tiles(self.outputs).zip(self.values.chunks((TILE * self.rows).max(1))) {
            for (row, of_row) in table.chunks_mut(stride.max(1)).take(self.rows).enumerate() {
                for (column, value) in columns.chunks_exact(self.rows).zip(&mut of_row[outputs.clone()]) {
                    *value = column[row];
                }
            }
        }
    }

    /// Marks one output of a row as failed.
    pub fn fail(&mut self, row: usize, output: usize, failure: RowFailure) {
        self.set(row, output, f64::NAN);
        self.failures.push((output, row, failure));
    }

    /// Marks all outputs of a row as failed.
    pub fn fail_row(&mut self, row: usize, failure: &RowFailure) {
        for output in 0..self.outputs {
            self.fail(row, output, failure.clone());
        }
    }

    /// Records that the model cannot continue, with these rows or any others: those without value or failure fail for
    /// this reason, and the run ends.
    pub fn give_up(&mut self, reason: impl Into<GiveUp>) {
        self.given_up = Some(reason.into());
    }

    /// Returns why the model cannot continue, if so.
    pub fn given_up(&self) -> Option<&GiveUp> {
        self.given_up.as_ref()
    }

    /// Counts a validity flag raised by `rows` rows.
    pub fn raise_by(&mut self, flag: usize, rows: u64) {
        self.flags[flag] += rows;
    }

    /// Adds `amount` to the counter with that index.
    pub fn count(&mut self, counter: usize, amount: f64) {
        self.counts.add(counter, amount);
    }

    /// Fails every value that is not finite and has no failure yet, with `RowFailure::not_finite` or the reason why
    /// the model gave up, and sorts the failures. Must be called once after the worker.
    pub fn settle(&mut self) {
        let unnamed = self.given_up.clone().map_or_else(RowFailure::not_finite, |give_up| give_up.reason);
        self.failures.sort_unstable();
        let named = self.failures.len();
        for (output, column) in self.values.chunks_exact(self.rows.max(1)).enumerate() {
            // Without an early exit, many values are tested at a time.
            if column.iter().fold(true, |all, value| all & value.is_finite()) {
                continue;
            }
            for (row, _) in column.iter().enumerate().filter(|(_, value)| !value.is_finite()) {
                let place = self.failures[..named].partition_point(|(o, r, _)| (*o, *r) < (output, row));
                if !matches!(self.failures[..named].get(place), Some((o, r, _)) if (*o, *r) == (output, row)) {
                    self.failures.push((output, row, unnamed.clone()));
                }
            }
        }
        self.failures.sort_unstable();
    }

    /// Returns the values of one output; NaN or infinite where it failed.
    pub fn column(&self, output: usize) -> &[f64] {
        &self.values[output * self.rows..(output + 1) * self.rows]
    }

    /// Returns all failures as (output, row, reason), in order once settled.
    pub fn failures(&self) -> &[(usize, usize, RowFailure)] {
        &self.failures
    }

    /// Returns how often each validity flag was raised.
    pub fn flags(&self) -> &[u64] {
        &self.flags
    }

    /// Returns the model's counters.
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Takes as many rows as this batch has from `other`, from `first` on, with their failures, but no flags and counts.
    pub(crate) fn copy_rows(&mut self, other: &Self, first: usize) {
        let rows = first..first + self.rows;
        for output in 0..self.outputs {
            self.column_mut(output).copy_from_slice(&other.column(output)[rows.clone()]);
        }
        let failures = other.failures.iter().filter(|(_, row, _)| rows.contains(row));
        self.failures.extend(failures.map(|(output, row, why)| (*output, row - first, why.clone())));
    }

    /// Adds flags and counts of rows of this batch that were evaluated earlier.
    pub(crate) fn add_counts(&mut self, flags: &[u64], counts: &Counts) {
        for (mine, theirs) in self.flags.iter_mut().zip(flags) {
            *mine += theirs;
        }
        self.counts.merge(counts);
    }
}

#[cfg(test)]
#[path = "tests/batch.rs"]
mod tests;
