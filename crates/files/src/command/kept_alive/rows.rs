//! The rows of a batch and their replies.

use std::collections::BTreeMap;

use apportion::model::{Batch, RowFailure};

use super::super::not_a_value;
use crate::command::CommandModel;

pub(super) struct Rows<'a> {
    pub inputs: &'a [&'a [f64]],
    /// A value for each output of the program and each row; NaN where it failed.
    values: Vec<f64>,
    /// The number of the outputs.
    outputs: usize,
    failures: Vec<(usize, RowFailure)>,
    /// Which rows have a reply; the number of those without one follows.
    answered: Vec<bool>,
    pub open: usize,
    /// The first row that was never sent.
    next: usize,
    /// Rows that were pending when processes ended, with the number of these: they are sent one at a time.
    pub suspects: BTreeMap<usize, u32>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(inputs: &'a [&'a [f64]], rows: usize, outputs: usize) -> Self {
        Self {
            inputs,
            values: vec![f64::NAN; rows * outputs],
            outputs,
            failures: Vec::new(),
            answered: vec![false; rows],
            open: rows,
            next: 0,
            suspects: BTreeMap::new(),
        }
    }

    /// Returns the row to send next, if any is left.
    pub(super) fn next(&mut self) -> Option<usize> {
        if let Some((row, _)) = self.suspects.first_key_value() {
            return Some(*row);
        }
        let row = self.next;
        self.next += usize::from(row < self.answered.len());
        (row < self.answered.len()).then_some(row)
    }

    /// Records that a process ended while the row was pending, and returns how many have so far. A process that had
    /// answered other rows counts only once: it may have ended for another reason.
    pub(super) fn suspect(&mut self, row: usize, is_own: bool) -> u32 {
        let is_new = !self.suspects.contains_key(&row);
        let count = self.suspects.entry(row).or_default();
        *count += u32::from(is_own || is_new);
        *count
    }

    pub(super) fn answer(&mut self, row: usize, values: &[f64]) {
        self.values[row * self.outputs..][..self.outputs].copy_from_slice(values);
        self.close(row);
    }

    pub(super) fn fail(&mut self, row: usize, reason: &str) {
        self.failures.push((row, RowFailure::new(reason)));
        self.close(row);
    }

    fn close(&mut self, row: usize) {
        self.suspects.remove(&row);
        self.answered[row] = true;
        self.open -= 1;
    }

    /// Copies the requested outputs to `batch`.
    pub(super) fn hand_over(mut self, model: &CommandModel, batch: &mut Batch) {
        self.failures.sort_unstable_by_key(|(row, _)| *row);
        for (column, place) in model.settings.asked.iter().enumerate() {
            let unit = &model.settings.outputs[*place].unit;
            for (row, values) in self.values.chunks(self.outputs).enumerate().filter(|(row, _)| self.answered[*row]) {
                batch.set(row, column, unit.to_si(values[*place]));
                let failed = || self.failures.binary_search_by_key(&row, |(row, _)| *row).is_ok();
                if !values[*place].is_finite() && !failed() {
                    batch.fail(row, column, not_a_value(values[*place]));
                }
            }
        }
        for (row, failure) in &self.failures {
            batch.fail_row(*row, failure);
        }
    }
}
