//! Evaluation of tables of points: rows go to the workers, outputs into one batch.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, OnceLock, PoisonError};

use thiserror::Error;

use super::executor::Executor;
use super::journal::Journal;
use super::rows::{RowRange, RowSource, RowValues, answered};
use super::{Progress, RunError, Store, record};
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
    /// The journal could not be written, or the files of the model changed; the reason.
    #[error("{0}")]
    NotKept(String),
}

/// Minimum rows in a batch of a fast model: fewer are not worth a thread.
const MIN_QUICK_ROWS: u64 = 1024;

/// The journal of a [`TableRun`], opened by [`Runner::table_journal`](crate::Runner::table_journal): rows in it are not
/// evaluated again. Its outputs are in memory.
pub struct TableJournal {
    pub(crate) store: Store,
    pub(crate) open: OnceLock<Journal>,
}

/// The workers of a model for points in tables.
pub struct TableRun<'a> {
    executor: Executor<'a>,
    journal: Option<TableJournal>,
    /// Rows that have their outputs.
    done: AtomicU64,
}

impl<'a> TableRun<'a> {
    /// Creates workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks
    /// for, or one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        Self { executor: Executor::new(model, context, threads), journal: None, done: AtomicU64::new(0) }
    }

    /// Keeps the outputs in `journal`, and evaluates only rows that are missing there. Rows are counted over all calls of
    /// [`run`](Self::run).
    #[must_use]
    pub fn with_journal(self, journal: Option<TableJournal>) -> Self {
        Self { journal, ..self }
    }

    /// Returns the number of rows that have their outputs.
    pub fn rows_done(&self) -> u64 {
        self.done.load(Relaxed)
    }

    /// Returns the recommended number of rows per call.
    pub fn rows_at_once(&self) -> usize {
        if self.executor.model.concurrency().is_some() { 1 << 16 } else { 1 << 14 }
    }

    /// Evaluates rows as [`Worker::run`](crate::model::Worker::run) does, and settles the batch. The number of workers
    /// does not matter.
    ///
    /// # Errors
    /// [`EvaluationStopped`] if the model gives up, the run is to stop, or the journal cannot be written; the batch is
    /// then undefined.
    pub fn run(&self, inputs: &[&[f64]], batch: &mut Batch) -> Result<(), EvaluationStopped> {
        let total = batch.rows() as u64;
        if total == 0 {
            return Ok(());
        }
        let before = Progress { total, ..Progress::default() };
        let first = self.rows_done();
        let (new, journal) = (Store::new(self.executor.model), self.journal.as_ref());
        let store = journal.map_or(&new, |journal| &journal.store);
        let missing = store.missing(0, first..first + total);
        self.done.fetch_add(store.count(0, first..first + total).0, Relaxed);
        let table = Table { run: self, store, first, inputs, waiting: Mutex::new(missing.into()) };
        self.executor.execute(&table, before, Instant::now(), &|_| ()).map_err(|error| match error {
            RunError::GaveUp(give_up) => EvaluationStopped::GaveUp(give_up),
            RunError::Interrupted { .. } => EvaluationStopped::Interrupted,
            error => EvaluationStopped::NotKept(error.to_string()),
        })?;
        store.recall(0, first, std::slice::from_mut(batch));
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
            self.run.journal.as_ref().map_or(Ok(()), |journal| record(&journal.open, &block))?;
            rows += self.store.insert(block);
        }
        self.run.done.fetch_add(rows, Relaxed);
        Ok((rows, 0))
    }
}

#[cfg(test)]
mod tests;
