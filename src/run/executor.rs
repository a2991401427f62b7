//! Distribution of rows: workers take batches of rows from a source, evaluate them, and return the outputs.
//!
//! This module sizes batches, checks for stops, counts failures and reports progress, both for the rows of a design
//! that go into a store and a journal, and for a table of points.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::remote::{DesignKey, Remote, Reply, Request};
use super::rows::{MissingRows, RowRange, RowSource, RowValues};
use super::tracker::Tracker;
use super::{Progress, RunError, threads_in_force};
use crate::model::{Batch, Model, RunContext, Worker};
use apportion_base::clock::Instant;

/// Target time of a batch of rows: short enough to lose little and to share rows evenly, long enough for a journal
/// record.
const BATCH_SECONDS: f64 = 0.2;

/// Maximum number of rows in a batch.
const MAX_ROWS: u64 = 4096;

/// Number of workers up to which batches have the target time; with more, batches are longer (`docs/guide/scaling.md`).
const WORKERS_AT_BASE_RATE: f64 = 256.0;

/// Batches that a remote worker holds at once, so that it need not wait for the next one.
const BATCHES_AHEAD: usize = 2;

/// Stack size in bytes of a thread that serves one remote worker; there may be thousands of them.
const STACK: usize = 1 << 19;

/// The workers of a model for one run: threads of this process, each with a worker that lives as long as the run. Their
/// number is the [concurrency](Model::concurrency) of the model, or else the number of threads.
///
/// [Remote workers](super::RemoteWorkers) (MPI ranks, an executor of another language) join in
/// [`execute`](Self::execute): each has a thread that takes batches for it and returns its outputs.
pub(crate) struct Executor<'a> {
    pub model: &'a dyn Model,
    context: &'a RunContext<'a>,
    workers: usize,
    pub remote: Option<Remote<'a>>,
    idle: Mutex<Vec<Box<dyn Worker + 'a>>>,
}

impl<'a> Executor<'a> {
    /// Creates workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks
    /// for, or one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        let workers = match (model.concurrency(), threads) {
            (None, _) => threads_in_force(threads),
            (Some(workers), 0) => workers.max(1),
            (Some(workers), threads) => workers.clamp(1, threads),
        };
        Self { model, context, workers, remote: None, idle: Mutex::default() }
    }

    /// Runs the rows of `source` to their end. `before` is the progress so far; its total is that of all rows of the run.
    ///
    /// # Errors
    /// [`RunError`] if the run is to stop; rows that the source has accepted by then are kept.
    pub fn execute(
        &self,
        source: &dyn RowSource,
        before: Progress,
        start: Instant,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<(), RunError> {
        let remote = self.remote.zip(source.remote());
        let remote_count = remote.map_or(0, |(remote, _)| remote.workers.count());
        let left = usize::try_from(before.total.saturating_sub(before.done).max(1)).unwrap_or(usize::MAX);
        let local_count = self.workers.min(left);
        let remote_count = remote_count.min(left - local_count);
        let workers = local_count + remote_count;
        let tracker = Tracker::new(self.context, before, start, on_progress);
        let execution = &Execution { executor: self, source, workers, tracker: &tracker };
        if workers == 1 && remote_count == 0 {
            execution.work();
        } else {
            // Workers may wait for programs and other machines: they get separate threads, not the pool's.
            std::thread::scope(|scope| {
                for (worker, (remote, rows)) in (0..remote_count).zip(std::iter::repeat(remote).flatten()) {
                    let thread = std::thread::Builder::new().stack_size(STACK);
                    let spawned = thread.spawn_scoped(scope, move || execution.work_remotely(remote, worker, rows));
                    if let Err(source) = spawned {
                        tracker.end(RunError::Threads { threads: workers, source: source.into() });
                    }
                }
                for _ in 0..local_count {
                    // This thread works too if no more can be started.
                    if std::thread::Builder::new().spawn_scoped(scope, move || execution.work()).is_err() {
                        return execution.work();
                    }
                }
            });
        }
        tracker.finish()
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Box<dyn Worker + 'a>>> {
        // A worker that panicked ends the run when the threads are joined.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The state of one call of `execute`.
struct Execution<'e, 'a> {
    executor: &'e Executor<'a>,
    source: &'e dyn RowSource,
    workers: usize,
    tracker: &'e Tracker<'e>,
}

impl Execution<'_, '_> {
    fn work(&self) {
        let Executor { model, context, .. } = *self.executor;
        let _guard = self.tracker.end_if_panicking();
        let idle = self.executor.idle().pop();
        let mut worker = idle.unwrap_or_else(|| model.worker(context));
        let (mut values, mut batch) = (RowValues::default(), Batch::new(model));
        let mut max_rows = 1;
        while let Some(range) = self.next(max_rows) {
            let begun = Instant::now();
            batch.reset(range.count() as usize);
            worker.run(&self.source.inputs(&mut values, &range), &mut batch);
            batch.settle();
            let seconds = begun.elapsed().as_secs_f64();
            if !self.count(self.source.accept(&range, &batch)) {
                break;
            }
            if let Some(give_up) = batch.given_up() {
                self.tracker.end(RunError::GaveUp(give_up.clone()));
                break;
            }
            max_rows = self.fitting(range.count(), seconds);
        }
        self.executor.idle().push(worker);
    }

    /// Does the same for a remote worker: a batch is evaluated while the next one is on its way.
    fn work_remotely(&self, remote: Remote<'_>, worker: usize, rows: &MissingRows<'_>) {
        let _guard = self.tracker.end_if_panicking();
        if let Err(source) = self.converse(remote, worker, rows) {
            self.tracker.end(RunError::LostWorker { worker, source });
        }
    }

    fn converse(&self, remote: Remote<'_>, worker: usize, rows: &MissingRows<'_>) -> std::io::Result<()> {
        let mut sent = VecDeque::new();
        let (mut max_rows, mut goes_on) = (1, true);
        loop {
            while goes_on && sent.len() < BATCHES_AHEAD {
                let Some(range) = self.next(max_rows) else { break };
                let request = Request { subject: remote.subject, design: DesignKey::new(rows.job.design), range };
                remote.workers.send(worker, serde_json::to_vec(&request)?)?;
                sent.push_back(request.range);
            }
            let Some(range) = sent.pop_front() else { return Ok(()) };
            let Reply { seconds, given_up, blocks } =
                remote.receive(worker, self.executor.context, &range, rows.store.outputs())?;
            // Receive all outstanding replies, so that the next run begins with a worker that has nothing to send.
            goes_on &= self.count(rows.keep(blocks));
            if let Some(give_up) = given_up {
                self.tracker.end(RunError::GaveUp(give_up));
                goes_on = false;
            }
            max_rows = self.fitting(range.count(), seconds);
        }
    }

    /// Returns the next rows for a worker, unless the run is to stop.
    fn next(&self, max_rows: u64) -> Option<RowRange> {
        if self.tracker.goes_on() { self.source.next(max_rows, self.workers) } else { None }
    }

    /// Returns the number of rows for the next batch, given that `rows` rows took `seconds`.
    fn fitting(&self, rows: u64, seconds: f64) -> u64 {
        // A thousand workers must not send a thousand replies at once.
        let batch_seconds = BATCH_SECONDS * (self.workers as f64 / WORKERS_AT_BASE_RATE).max(1.0);
        let fitting = (batch_seconds * rows as f64 / seconds.max(1e-9)) as u64;
        fitting.clamp(1, rows.saturating_mul(8).clamp(1, MAX_ROWS))
    }

    /// Counts accepted rows; returns whether they were accepted.
    fn count(&self, accepted: Result<(u64, u64), RunError>) -> bool {
        let counted = accepted.map(|(rows, failed)| self.tracker.add(rows, failed));
        counted.map_err(|error| self.tracker.end(error)).is_ok()
    }
}
