//! The rows of a batch on their way to a program and back.

use std::collections::BTreeMap;

use apportion::model::{Batch, RowFailure};

use super::super::not_a_value;
use crate::command::CommandModel;

pub(super) struct Rows<'a> {
    pub inputs: &'a [&'a [f64]],
    /// A value for each output of the program and each row; NaN where it failed.
    values: Vec<f64>,
    /// The number of those outputs.
    outputs: usize,
    failures: Vec<(usize, RowFailure)>,
    /// Rows that have their answer, and how many have none.
    answered: Vec<bool>,
    pub open: usize,
    /// The first row that was never asked.
    next: usize,
    /// Rows over which processes ended, and how many: they are asked one at a time.
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

    /// The row that is asked next, if any is left.
    pub(super) fn next(&mut self) -> Option<usize> {
        if let Some((row, _)) = self.suspects.first_key_value() {
            return Some(*row);
        }
        let row = self.next;
        self.next += usize::from(row < self.answered.len());
        (row < self.answered.len()).then_some(row)
    }

    /// A process ended over the row; how many have so far. One that had answered other rows counts once only: it may have
    /// ended over something else.
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

    /// Puts the outputs that are asked for into `batch`.
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
