//! Evaluation of tables of points: rows go to the workers, outputs into one batch.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

use super::executor::Executor;
use super::journal::Journal;
use super::rows::{RowRange, RowSource, RowValues, answered};
use super::{Progress, RunError, Store, failed_rows, record};
use crate::model::{Batch, Model, RunContext};
use apportion_base::clock::Instant;

/// Minimum rows in a batch of a fast model: fewer are not worth a thread.
const MIN_QUICK_ROWS: u64 = 1024;

/// The workers of a model for points in tables.
pub struct TableRun<'a> {
    executor: Executor<'a>,
    /// Keeps outputs: rows that it already has are not evaluated. Rows are counted over all calls of [`run`](Self::run).
    pub(crate) store: Option<&'a Store>,
    /// Records every block of evaluated rows, once it is open.
    pub(crate) journal: Option<&'a OnceLock<Journal>>,
    pub(crate) on_progress: &'a (dyn Fn(Progress) + Sync),
    /// Number of rows of all calls, if it is known.
    pub(crate) total: Option<u64>,
    /// After the previous call.
    before: Mutex<Progress>,
    start: Instant,
}

impl<'a> TableRun<'a> {
    /// Creates workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks
    /// for, or one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        Self {
            executor: Executor::new(model, context, threads),
            store: None,
            journal: None,
            on_progress: &|_| (),
            total: None,
            before: Mutex::default(),
            start: Instant::now(),
        }
    }

    /// Returns the model.
    pub fn model(&self) -> &'a dyn Model {
        self.executor.model
    }

    /// Returns the recommended number of rows per call.
    pub fn rows_at_once(&self) -> usize {
        if self.executor.model.concurrency().is_some() { 1 << 16 } else { 1 << 14 }
    }

    /// Evaluates rows as [`Worker::run`](crate::model::Worker::run) does, and settles the batch. The number of workers
    /// does not matter.
    ///
    /// # Errors
    /// [`RunError`] if the model gives up, the run is to stop, or the journal cannot be written; the batch is then
    /// undefined.
    pub fn run(&self, inputs: &[&[f64]], batch: &mut Batch) -> Result<(), RunError> {
        let rows = batch.rows() as u64;
        if rows == 0 {
            return Ok(());
        }
        let mut before = self.before.lock().unwrap_or_else(PoisonError::into_inner);
        let Progress { done: first, recalled, failed, .. } = *before;
        let new = Store::new(self.executor.model);
        let store = self.store.unwrap_or(&new);
        let missing = store.missing(0, first..first + rows);
        let (existing, failing) = store.count(0, first..first + rows);
        let table = Table { run: self, store, first, inputs, waiting: Mutex::new(missing.into()) };
        let in_all = |now: Progress| Progress {
            done: first + now.done,
            recalled: recalled + now.recalled,
            total: self.total.unwrap_or(0),
            failed: failed + now.failed,
            elapsed: self.start.elapsed(),
        };
        let of_call =
            Progress { done: existing, recalled: existing, total: rows, failed: failing, ..Progress::default() };
        let ended = self.executor.execute(&table, of_call, self.start, &|now| (self.on_progress)(in_all(now)));
        ended.map_err(|error| match error {
            RunError::Interrupted { done, .. } => RunError::Interrupted { done: first + done, total: self.total },
            error => error,
        })?;
        store.recall(0, first, std::slice::from_mut(batch));
        *before = in_all(Progress { done: rows, failed: failed_rows(batch), ..of_call });
        Ok(())
    }
}

struct Table<'t, 'a> {
    run: &'t TableRun<'a>,
    store: &'t Store,
    /// The first row of `inputs` among those of all calls.
    first: u64,
    inputs: &'t [&'t [f64]],
    waiting: Mutex<VecDeque<Range<u64>>>,
}

impl RowSource for Table<'_, '_> {
    fn next(&self, max_rows: u64, workers: usize) -> Option<RowRange> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let rows: u64 = waiting.iter().map(|rows| rows.end - rows.start).sum();
        let share = (rows / (2 * workers as u64)).max(1);
        let is_quick = !self.run.executor.model.is_slow();
        let length = if is_quick { share.max(MIN_QUICK_ROWS) } else { share.min(max_rows) };
        let first = waiting.front_mut()?;
        let rows = first.start..first.end.min(first.start + length);
        first.start = rows.end;
        if first.is_empty() {
            waiting.pop_front();
        }
        Some(RowRange { replicate: 0, rows })
    }

    fn inputs<'s>(&'s self, _: &'s mut RowValues, range: &RowRange) -> Vec<&'s [f64]> {
        let rows = (range.rows.start - self.first) as usize..(range.rows.end - self.first) as usize;
        self.inputs.iter().map(|column| &column[rows.clone()]).collect()
    }

    fn accept(&self, range: &RowRange, batch: &Batch) -> Result<(u64, u64), RunError> {
        let mut rows = 0;
        for block in answered(range, batch) {
            self.run.journal.map_or(Ok(()), |journal| record(journal, &block))?;
            rows += self.store.insert(block);
        }
        Ok((rows, failed_rows(batch)))
    }
}

#[cfg(test)]
#[path = "tests/table.rs"]
mod tests;
