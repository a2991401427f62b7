//! Evaluation of tables of points: rows go to the workers, outputs into one batch.

use std::sync::{Mutex, PoisonError};

use thiserror::Error;

use super::executor::Executor;
use super::rows::{RowRange, RowSource, RowValues};
use super::{Progress, RunError};
use crate::model::{Batch, GiveUp, Model, RunContext};
use apportion_base::clock::Instant;

/// Why rows were not all evaluated.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EvaluationStopped {
    /// The model cannot continue.
    #[error("the model cannot continue: {0}")]
    GaveUp(GiveUp),
    /// The run was interrupted.
    #[error("interrupted")]
    Interrupted,
}

/// Minimum rows in a batch of a fast model: fewer are not worth a thread.
const MIN_QUICK_ROWS: u64 = 1024;

/// The workers of a model for points in tables.
pub struct TableRun<'a>(Executor<'a>);

impl<'a> TableRun<'a> {
    /// Creates workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks
    /// for, or one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        Self(Executor::new(model, context, threads))
    }

    /// Returns the recommended number of rows per call.
    pub fn rows_at_once(&self) -> usize {
        if self.0.model.concurrency().is_some() { 1 << 16 } else { 1 << 14 }
    }

    /// Evaluates rows as [`Worker::run`](crate::model::Worker::run) does, and settles the batch. The number of workers
    /// does not matter.
    ///
    /// # Errors
    /// [`EvaluationStopped`] if the model gives up or the run is to stop; the batch is then undefined.
    pub fn run(&self, inputs: &[&[f64]], batch: &mut Batch) -> Result<(), EvaluationStopped> {
        let total = batch.rows() as u64;
        if total == 0 {
            return Ok(());
        }
        let before = Progress { total, ..Progress::default() };
        let is_quick = self.0.model.concurrency().is_none();
        let table = Table { inputs, is_quick, sink: Mutex::new((0, batch)) };
        self.0.execute(&table, before, Instant::now(), &|_| ()).map_err(|error| match error {
            RunError::GaveUp(give_up) => EvaluationStopped::GaveUp(give_up),
            // A table has no failure policy and no sink, so nothing else can end it.
            _ => EvaluationStopped::Interrupted,
        })?;
        let (_, batch) = table.sink.into_inner().unwrap_or_else(PoisonError::into_inner);
        batch.settle();
        Ok(())
    }
}

struct Table<'a> {
    inputs: &'a [&'a [f64]],
    is_quick: bool,
    /// The next row, and where outputs go.
    sink: Mutex<(u64, &'a mut Batch)>,
}

impl RowSource for Table<'_> {
    fn next(&self, max_rows: u64, workers: usize) -> Option<RowRange> {
        let mut sink = self.sink.lock().unwrap_or_else(PoisonError::into_inner);
        let (first, rows) = (sink.0, sink.1.rows() as u64);
        let share = ((rows - first) / (2 * workers as u64)).max(1);
        let length = if self.is_quick { share.max(MIN_QUICK_ROWS) } else { share.min(max_rows) };
        sink.0 = rows.min(first + length);
        (first < rows).then(|| RowRange { replicate: 0, rows: first..sink.0 })
    }

    fn inputs<'s>(&'s self, _: &'s mut RowValues, range: &RowRange) -> Vec<&'s [f64]> {
        let rows = range.rows.start as usize..range.rows.end as usize;
        self.inputs.iter().map(|column| &column[rows.clone()]).collect()
    }

    fn accept(&self, range: &RowRange, part: &Batch) -> Result<(u64, u64), RunError> {
        if part.given_up().is_some() {
            return Ok((0, 0));
        }
        let mut sink = self.sink.lock().unwrap_or_else(PoisonError::into_inner);
        sink.1.take_over(range.rows.start as usize, part);
        Ok((range.count(), 0))
    }
}

#[cfg(test)]
mod tests;
