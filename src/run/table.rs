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
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;
    use std::time::Duration;

    use super::*;
    use crate::model::{FunctionModel, Model, Output, RowFailure, RunContext, Worker};
    use apportion_base::quantity::Unit;

    /// A function evaluated by several workers, until it gives up at a value.
    struct Slow<M> {
        inner: M,
        workers: usize,
        gives_up_at: f64,
        threads: Mutex<Vec<thread::ThreadId>>,
    }

    struct SlowWorker<'a, M>(Box<dyn Worker + 'a>, &'a Slow<M>);

    impl<M: Model> Model for Slow<M> {
        fn outputs(&self) -> &[Output] {
            self.inner.outputs()
        }

        fn concurrency(&self) -> Option<usize> {
            Some(self.workers)
        }

        fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
            Box::new(SlowWorker(self.inner.worker(context), self))
        }
    }

    impl<M: Model> Worker for SlowWorker<'_, M> {
        fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
            self.1.threads.lock().unwrap().push(thread::current().id());
            thread::sleep(Duration::from_millis(1));
            self.0.run(inputs, batch);
            if inputs[0].contains(&self.1.gives_up_at) {
                batch.give_up(RowFailure::new("enough"));
            }
        }
    }

    fn slow(workers: usize, gives_up_at: f64) -> Slow<impl Model> {
        let output = Output::new("y", Unit::dimensionless(), "");
        let inner = FunctionModel::new(vec![output], |x: &[f64], y: &mut [f64]| {
            if x[0] % 7.0 == 3.0 {
                return Err(RowFailure::new("three"));
            }
            y[0] = if x[0] % 11.0 == 5.0 { f64::NAN } else { x[0] * 2.0 };
            Ok(())
        });
        Slow { inner, workers, gives_up_at, threads: Mutex::default() }
    }

    fn rows(count: usize) -> Vec<f64> {
        (0..count).map(|row| row as f64).collect()
    }

    #[test]
    fn rows_keep_their_places_and_failures_for_any_number_of_workers() {
        let x = rows(1000);
        let alone = slow(1, -1.0);
        let mut expected = Batch::new(&alone);
        expected.reset(x.len());
        alone.inner.worker(&RunContext::default()).run(&[&x], &mut expected);
        expected.settle();
        for workers in [1, 2, 3, 16, 1024] {
            let model = slow(workers, -1.0);
            let context = RunContext::default();
            let (table, mut batch) = (TableRun::new(&model, &context, 0), Batch::new(&model));
            for _ in 0..2 {
                batch.reset(x.len());
                table.run(&[&x], &mut batch).unwrap();
                assert_eq!(batch.failures(), expected.failures());
                assert!(batch.column(0).iter().zip(expected.column(0)).all(|(a, b)| a.to_bits() == b.to_bits()));
            }
            let mut threads = std::mem::take(&mut *model.threads.lock().unwrap());
            threads.sort_by_key(|id| format!("{id:?}"));
            threads.dedup();
            assert!(workers == 1 || threads.len() > 1);
        }
    }

    #[test]
    fn no_rows_are_no_work() {
        let model = slow(4, -1.0);
        let mut batch = Batch::new(&model);
        batch.reset(0);
        TableRun::new(&model, &RunContext::default(), 0).run(&[&[]], &mut batch).unwrap();
        assert!(batch.failures().is_empty());
    }

    #[test]
    fn a_model_that_gives_up_ends_the_work() {
        let x = rows(1000);
        let model = slow(3, 500.0);
        let mut batch = Batch::new(&model);
        batch.reset(x.len());
        let context = RunContext::default();
        let halt = TableRun::new(&model, &context, 0).run(&[&x], &mut batch).unwrap_err();
        assert!(matches!(halt, RunError::GaveUp(give_up) if give_up == RowFailure::new("enough").into()));
    }

    #[test]
    fn a_stop_ends_the_work() {
        let (x, stop) = (rows(100_000), AtomicBool::new(false));
        let model = slow(2, -1.0);
        let mut batch = Batch::new(&model);
        batch.reset(x.len());
        let context = RunContext::new(Some(&stop), |_| ());
        let workers = TableRun::new(&model, &context, 0);
        stop.store(true, Ordering::Relaxed);
        assert!(matches!(workers.run(&[&x], &mut batch), Err(RunError::Interrupted { done: 0, total: None })));
        assert!(model.threads.lock().unwrap().is_empty());
    }
}
