//! The rows of a batch on their way to a program and back.

use super::super::not_a_value;
use crate::model::command::CommandModel;
use crate::model::{Batch, RowFailure};

pub(super) struct Piece<'a> {
    pub inputs: &'a [&'a [f64]],
    /// A value for each output of the program and each row; NaN where it failed.
    values: Vec<f64>,
    /// The number of those outputs.
    outputs: usize,
    failures: Vec<(usize, RowFailure)>,
    /// Rows that have their answer, and how many have none.
    answered: Vec<bool>,
    pub open: usize,
    /// Of a program without row numbers: the first rows, whose answers are certain.
    firm: usize,
    /// Whether the answers of a process were found certain before the last row.
    pub is_parted: bool,
    /// Rows that the present process has been sent, in this order, and how many it had before them.
    order: Vec<usize>,
    pub base: usize,
    /// The first row that may have to be sent next.
    next: usize,
    /// Rows asked by a process of their own, since the program was out of step.
    pub alone: usize,
}

impl<'a> Piece<'a> {
    pub(super) fn new(inputs: &'a [&'a [f64]], rows: usize, outputs: usize) -> Self {
        Self {
            inputs,
            values: vec![f64::NAN; rows * outputs],
            outputs,
            failures: Vec::new(),
            answered: vec![false; rows],
            open: rows,
            firm: 0,
            is_parted: false,
            order: Vec::with_capacity(rows),
            base: 0,
            next: 0,
            alone: 0,
        }
    }

    /// A process begins that has had `base` rows.
    pub(super) fn begin(&mut self, base: usize) {
        self.order.clear();
        (self.base, self.next) = (base, 0);
    }

    /// The next row for the process, which is under way from now on.
    pub(super) fn send_next(&mut self) -> Option<usize> {
        let row = self.next_row()?;
        self.order.push(row);
        self.next = row + 1;
        Some(row)
    }

    pub(super) fn has_next(&mut self) -> bool {
        self.next_row().is_some()
    }

    fn next_row(&mut self) -> Option<usize> {
        self.next += self.answered.get(self.next..)?.iter().take_while(|answered| **answered).count();
        (self.next < self.answered.len()).then_some(self.next)
    }

    /// The row that the process got as its `count`th, if it is one of these and has no answer yet.
    pub(super) fn open_row(&self, count: usize) -> Option<usize> {
        let row = *self.order.get(count.checked_sub(self.base)?)?;
        (!self.answered[row]).then_some(row)
    }

    /// The first row under way without an answer.
    pub(super) fn first_open(&self) -> Option<usize> {
        self.order.iter().copied().find(|row| !self.answered[*row])
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
        if !std::mem::replace(&mut self.answered[row], true) {
            self.open -= 1;
        }
    }

    /// All answers so far are certain.
    pub(super) fn confirm(&mut self) {
        self.firm = self.answered.len() - self.open;
        self.is_parted = true;
    }

    /// Forgets the answers that are not certain.
    pub(super) fn rewind(&mut self) {
        self.answered[self.firm..].fill(false);
        self.values[self.firm * self.outputs..].fill(f64::NAN);
        self.failures.retain(|(row, _)| *row < self.firm);
        self.open = self.answered.len() - self.firm;
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
        (0..self.alone).for_each(|_| batch.raise(0));
    }
}
