//! The one place where rows are run: workers take pieces of a task from its source, evaluate them, and hand what comes of
//! them to its sink.
//!
//! Pieces are sized, stops watched, failures counted and progress told here, whatever is run: blocks of a design that are
//! folded into sums, rows of a design that go into a store and a journal, or a table of points.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::{Progress, RunError, threads_in_force};
use crate::model::{Model, RowFailure, RunContext, Standing, Worker};

/// Time that a piece of rows should take: short enough to lose little, and to share out evenly; long enough to be worth a
/// record.
const PIECE_SECONDS: f64 = 0.2;

/// Most rows of a piece.
const MOST_ROWS: u64 = 4096;

/// Rows to be run: a source of pieces, how a worker evaluates one, and a sink of what comes of them. A source that knows
/// the outputs of some rows already does not give them out.
pub(crate) trait Task: Sync {
    /// Some of the rows.
    type Piece: Clone + Send;
    /// What comes of them.
    type Output: Send;
    /// What a thread keeps from piece to piece.
    type Scratch;

    /// Scratch space for one thread.
    fn scratch(&self) -> Self::Scratch;

    /// The source: a piece of best `most` rows for one of `workers` workers; `None` if there is none left.
    fn next(&self, most: u64, workers: usize) -> Option<Self::Piece>;

    /// Rows of a piece.
    fn rows(&self, piece: &Self::Piece) -> u64;

    /// What a worker makes of a piece; `on_rows` is told of rows as soon as they are evaluated.
    fn evaluate(
        &self,
        worker: &mut dyn Worker,
        scratch: &mut Self::Scratch,
        piece: &Self::Piece,
        on_rows: &dyn Fn(u64),
    ) -> Evaluated<Self::Output>;

    /// The sink. An error ends the run.
    fn accept(&self, piece: &Self::Piece, output: Self::Output) -> Result<Finished, RunError>;
}

/// What has come of a piece.
pub(crate) struct Evaluated<O> {
    /// `None` if there is nothing to hand over, since the worker has given up.
    pub output: Option<O>,
    pub standing: Standing,
    pub given_up: Option<RowFailure>,
    /// Whether it must be known at once that the rows stand.
    pub is_urgent: bool,
}

/// Rows that have gone into the sink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Finished {
    pub rows: u64,
    /// Those that failed in at least one output.
    pub failed: u64,
}

/// The workers of a model for one run: threads of this process, each with a worker of its own that lives as long as the
/// run. There are as many as the model asks for by its [concurrency](Model::concurrency), or else as many as threads.
///
/// Workers elsewhere (MPI ranks, an executor of another language) come in here, beside the threads of
/// [`execute`](Self::execute): all that they need of a [`Task`] is to take pieces and to hand over outputs.
pub(crate) struct Executor<'a> {
    model: &'a dyn Model,
    context: &'a RunContext<'a>,
    workers: usize,
    idle: Mutex<Vec<Box<dyn Worker + 'a>>>,
}

impl<'a> Executor<'a> {
    /// Workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks for, or
    /// one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        let workers = match (model.concurrency(), threads) {
            (None, _) => threads_in_force(threads),
            (Some(workers), 0) => workers.max(1),
            (Some(workers), threads) => workers.clamp(1, threads),
        };
        Self { model, context, workers, idle: Mutex::default() }
    }

    pub fn model(&self) -> &'a dyn Model {
        self.model
    }

    pub fn context(&self) -> &'a RunContext<'a> {
        self.context
    }

    /// Runs `task` to its end. `before` is how far the run has come before it: its total is that of the whole run.
    ///
    /// # Errors
    /// [`RunError`] if the run is to end; what has gone into the sink by then stays there.
    pub fn execute<T: Task>(
        &self,
        task: &T,
        (before, start): (Progress, Instant),
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Progress, RunError> {
        let [done, failed] = [before.done, before.failed].map(AtomicU64::new);
        let (pending, end) = (AtomicU64::new(0), Mutex::new(None));
        let execution = Execution { executor: self, task, before, start, on_progress, done, failed, pending, end };
        let left = before.total.saturating_sub(before.done).max(1);
        match self.workers.min(usize::try_from(left).unwrap_or(usize::MAX)) {
            1 => execution.work(),
            workers => std::thread::scope(|scope| {
                for _ in 0..workers {
                    scope.spawn(|| execution.work());
                }
            }),
        }
        let progress = Progress { done: execution.done.load(Ordering::Relaxed), ..execution.progress() };
        match execution.end.into_inner().unwrap_or_else(PoisonError::into_inner) {
            None => Ok(progress),
            // Rows that were pending may have come to stand since.
            Some(RunError::Interrupted { total, .. }) => Err(RunError::Interrupted { done: progress.done, total }),
            Some(error) => Err(error),
        }
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Box<dyn Worker + 'a>>> {
        // A worker that panicked ends the run when the threads are joined.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A task on its way through the workers.
struct Execution<'e, 'a, T> {
    executor: &'e Executor<'a>,
    task: &'e T,
    before: Progress,
    start: Instant,
    on_progress: &'e (dyn Fn(Progress) + Sync),
    done: AtomicU64,
    failed: AtomicU64,
    /// Rows evaluated that are not in the sink yet.
    pending: AtomicU64,
    end: Mutex<Option<RunError>>,
}

impl<T: Task> Execution<'_, '_, T> {
    fn work(&self) {
        let Executor { model, context, workers, .. } = *self.executor;
        let _guard = EndIfPanicking(context);
        let idle = self.executor.idle().pop();
        let mut worker = idle.unwrap_or_else(|| model.worker(context));
        let mut scratch = self.task.scratch();
        let mut most = 1;
        let mut unconfirmed = Unconfirmed::<T>::new();
        loop {
            if context.is_interrupted() {
                self.end(RunError::Interrupted { done: 0, total: self.before.total });
            }
            let is_stopped = context.is_stopped();
            let again = if is_stopped { None } else { unconfirmed.again.pop_front() };
            let piece = again.or_else(|| if is_stopped { None } else { self.task.next(most, workers) });
            let Some(piece) = piece else {
                if unconfirmed.pieces.is_empty() || !self.hand_over(&mut unconfirmed, worker.confirm()) {
                    break;
                }
                continue;
            };
            let (began, rows) = (Instant::now(), self.task.rows(&piece));
            let told = std::cell::Cell::new(0);
            let on_rows = |rows: u64| {
                told.set(told.get() + rows);
                self.pending.fetch_add(rows, Ordering::Relaxed);
                (self.on_progress)(self.progress());
            };
            let evaluated = self.task.evaluate(&mut *worker, &mut scratch, &piece, &on_rows);
            let Evaluated { output, mut standing, given_up, is_urgent } = evaluated;
            let seconds = began.elapsed().as_secs_f64();
            if standing == Standing::Pending && is_urgent {
                standing = worker.confirm();
            }
            self.pending.fetch_add(rows - told.get(), Ordering::Relaxed);
            unconfirmed.pieces.push((piece, output));
            if standing == Standing::Pending {
                (self.on_progress)(self.progress());
            }
            if !self.hand_over(&mut unconfirmed, standing) {
                break;
            }
            if let Some(reason) = given_up {
                self.end(if context.is_interrupted() {
                    RunError::Interrupted { done: 0, total: self.before.total }
                } else {
                    RunError::GaveUp { reason }
                });
                break;
            }
            let fitting = (PIECE_SECONDS * rows as f64 / seconds.max(1e-9)) as u64;
            most = fitting.clamp(1, (8 * rows).min(MOST_ROWS));
        }
        self.executor.idle().push(worker);
    }

    /// Hands to the sink what stands; whether it was taken.
    fn hand_over(&self, unconfirmed: &mut Unconfirmed<T>, standing: Standing) -> bool {
        if standing == Standing::Pending {
            return true;
        }
        for (piece, _) in &unconfirmed.pieces {
            self.pending.fetch_sub(self.task.rows(piece), Ordering::Relaxed);
        }
        if standing == Standing::Revoked {
            unconfirmed.revoke();
            return true;
        }
        for (piece, output) in unconfirmed.pieces.drain(..) {
            let Some(output) = output else { continue };
            match self.task.accept(&piece, output) {
                Err(error) => {
                    self.end(error);
                    return false;
                }
                Ok(Finished { rows, failed }) => {
                    self.done.fetch_add(rows, Ordering::Relaxed);
                    self.failed.fetch_add(failed, Ordering::Relaxed);
                    (self.on_progress)(self.progress());
                }
            }
        }
        true
    }

    /// How far the run has come, rows that are not in the sink yet included.
    fn progress(&self) -> Progress {
        let done = self.done.load(Ordering::Relaxed) + self.pending.load(Ordering::Relaxed);
        let failed = self.failed.load(Ordering::Relaxed);
        Progress { done: done.min(self.before.total), failed, elapsed: self.start.elapsed(), ..self.before }
    }

    /// The run ends, by the first reason given; of rows that failed the first in the design counts.
    fn end(&self, error: RunError) {
        let mut end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
        let is_earlier = match (&*end, &error) {
            (Some(RunError::RowFailed { row: first, .. }), RunError::RowFailed { row, .. }) => row < first,
            (Some(_), RunError::RowFailed { .. }) | (None, _) => true,
            (Some(_), _) => false,
        };
        if is_earlier {
            *end = Some(error);
        }
        self.executor.context.end();
    }
}

/// Pieces that are evaluated but may still be revoked, and those that were.
struct Unconfirmed<T: Task> {
    pieces: Vec<(T::Piece, Option<T::Output>)>,
    /// To be evaluated again, in order.
    again: VecDeque<T::Piece>,
}

impl<T: Task> Unconfirmed<T> {
    fn new() -> Self {
        Self { pieces: Vec::new(), again: VecDeque::new() }
    }

    fn revoke(&mut self) {
        self.pieces.drain(..).rev().for_each(|(piece, _)| self.again.push_front(piece));
    }
}

/// Lets the other workers end when one panics: they may wait for it.
struct EndIfPanicking<'a>(&'a RunContext<'a>);

impl Drop for EndIfPanicking<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.end();
        }
    }
}

/// How long is waited for other workers between two looks at whether the run is to end.
pub(super) const LOOK: Duration = Duration::from_millis(20);
