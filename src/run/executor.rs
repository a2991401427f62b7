//! The one place where rows are run: workers take pieces of a task from its source, evaluate them, and hand what comes of
//! them to its sink.
//!
//! Pieces are sized, stops watched, failures counted and progress told here, whatever is run: blocks of a design that are
//! folded into sums, rows of a design that go into a store and a journal, or a table of points.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::remote::{Abroad, Answer, Remote, Talk};
use super::task::{Evaluated, Finished, Task};
use super::{Progress, RunError, threads_in_force};
use crate::clock::Instant;
use crate::model::{GiveUp, Model, RunContext, Worker};

/// Time that a piece of rows should take: short enough to lose little, and to share out evenly; long enough to be worth a
/// record.
const PIECE_SECONDS: f64 = 0.2;

/// Workers whose pieces can come in at that rate: with more, pieces are longer (`docs/scaling.md`).
const HANDS_AT_EASE: f64 = 256.0;

/// Pieces that a worker in another process has at once: it need not wait while the next one is on its way.
const PIECES_AHEAD: usize = 2;

/// The workers of a model for one run: threads of this process, each with a worker of its own that lives as long as the
/// run. There are as many as the model asks for by its [concurrency](Model::concurrency), or else as many as threads.
///
/// [Workers elsewhere](super::RemoteWorkers) (MPI ranks, an executor of another language) come in here, beside the threads
/// of [`execute`](Self::execute): each has a thread that takes pieces for it and hands over what it makes of them.
pub(crate) struct Executor<'a> {
    model: &'a dyn Model,
    context: &'a RunContext<'a>,
    workers: usize,
    remote: Option<Remote<'a>>,
    idle: Mutex<Vec<Box<dyn Worker + 'a>>>,
}

/// Bytes of the stack of a thread that talks to a worker elsewhere, of which there may be thousands.
const STACK: usize = 1 << 19;

impl<'a> Executor<'a> {
    /// Workers of `model` for the run of `context`, on at most `threads` threads (0: as many as the model asks for, or
    /// one per core).
    pub fn new(model: &'a dyn Model, context: &'a RunContext<'a>, threads: usize) -> Self {
        let workers = match (model.concurrency(), threads) {
            (None, _) => threads_in_force(threads),
            (Some(workers), 0) => workers.max(1),
            (Some(workers), threads) => workers.clamp(1, threads),
        };
        Self { model, context, workers, remote: None, idle: Mutex::default() }
    }

    /// The same with workers in other processes.
    pub fn with_remote(self, remote: Option<Remote<'a>>) -> Self {
        Self { remote, ..self }
    }

    /// Whether there are workers in other processes.
    pub fn has_remote(&self) -> bool {
        self.remote.is_some()
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
        before: Progress,
        start: Instant,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Progress, RunError> {
        let [done, failed] = [before.done, before.failed].map(AtomicU64::new);
        let (pending, end) = (AtomicU64::new(0), Mutex::new(None));
        let abroad = self.remote.zip(task.abroad());
        let remote = abroad.map_or(0, |(remote, _)| remote.workers.count());
        let hands = self.workers + remote;
        let execution =
            &Execution { executor: self, task, hands, before, start, on_progress, done, failed, pending, end };
        let left = usize::try_from(before.total.saturating_sub(before.done).max(1)).unwrap_or(usize::MAX);
        let workers = self.workers.min(left);
        match (workers, remote.min(left - workers)) {
            (1, 0) => execution.work(),
            (workers, remote) => std::thread::scope(|scope| {
                for _ in 0..workers {
                    scope.spawn(move || execution.work());
                }
                for worker in 0..remote {
                    let Some((remote, abroad)) = abroad else { break };
                    let talk = move || execution.work_remotely(remote.talk(worker, self.context), abroad);
                    let thread = std::thread::Builder::new().stack_size(STACK);
                    if let Err(source) = thread.spawn_scoped(scope, talk) {
                        execution.end(RunError::Threads { threads: hands, source: source.into() });
                    }
                }
            }),
        }
        let progress = Progress { done: execution.done.load(Ordering::Relaxed), ..execution.progress() };
        let end = execution.end.lock().unwrap_or_else(PoisonError::into_inner).take();
        match end {
            None => Ok(progress),
            // Other workers may have handed over rows since.
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
    /// Workers in all.
    hands: usize,
    before: Progress,
    start: Instant,
    on_progress: &'e (dyn Fn(Progress) + Sync),
    done: AtomicU64,
    failed: AtomicU64,
    /// Rows of pieces under way that are evaluated already.
    pending: AtomicU64,
    end: Mutex<Option<RunError>>,
}

impl<T: Task> Execution<'_, '_, T> {
    fn work(&self) {
        let Executor { model, context, .. } = *self.executor;
        let _guard = EndIfPanicking(context);
        let idle = self.executor.idle().pop();
        let mut worker = idle.unwrap_or_else(|| model.worker(context));
        let mut scratch = self.task.scratch();
        let mut most = 1;
        while let Some(piece) = self.next(most) {
            let (began, rows) = (Instant::now(), self.task.rows(&piece));
            let told = std::cell::Cell::new(0);
            let on_rows = |rows: u64| {
                told.set(told.get() + rows);
                self.pending.fetch_add(rows, Ordering::Relaxed);
                (self.on_progress)(self.progress());
            };
            let evaluated = self.task.evaluate(&mut *worker, &mut scratch, &piece, &on_rows);
            let Evaluated { output, given_up } = evaluated;
            let seconds = began.elapsed().as_secs_f64();
            self.pending.fetch_sub(told.get(), Ordering::Relaxed);
            if !self.hand_over(&piece, output) {
                break;
            }
            if let Some(give_up) = given_up {
                self.give_up(give_up);
                break;
            }
            most = self.fitting(rows, seconds);
        }
        self.executor.idle().push(worker);
    }

    /// The same for a worker in another process: a piece is evaluated while the next one is on its way.
    fn work_remotely(&self, talk: Talk<'_>, abroad: &dyn Abroad<T::Piece, T::Output>) {
        let _guard = EndIfPanicking(self.executor.context);
        let worker = talk.worker();
        if let Err(source) = self.converse(talk, abroad) {
            self.end(RunError::LostWorker { worker, source });
        }
    }

    fn converse(&self, talk: Talk<'_>, abroad: &dyn Abroad<T::Piece, T::Output>) -> std::io::Result<()> {
        let errand = abroad.errand();
        let mut sent = VecDeque::new();
        let (mut most, mut goes_on) = (1, true);
        loop {
            while goes_on && sent.len() < PIECES_AHEAD {
                let Some(piece) = self.next(most) else { break };
                talk.ask(&errand, |out| abroad.write_piece(&piece, out))?;
                sent.push_back(piece);
            }
            let Some(piece) = sent.pop_front() else { return Ok(()) };
            let rows = self.task.rows(&piece);
            let Answer { seconds, given_up, output } = talk.hear(|from| abroad.read_output(&piece, from))?;
            // What is on its way is heard to the end: the next task begins with a worker that has nothing to say.
            goes_on &= self.hand_over(&piece, output);
            if let Some(give_up) = given_up {
                self.give_up(give_up);
                goes_on = false;
            }
            most = self.fitting(rows, seconds);
        }
    }

    /// The next piece for a worker, of best `most` rows, unless the run is to end.
    fn next(&self, most: u64) -> Option<T::Piece> {
        let context = self.executor.context;
        if context.is_interrupted() {
            self.end(RunError::Interrupted { done: 0, total: self.before.total });
        }
        if context.is_stopped() {
            return None;
        }
        self.task.next(most, self.hands)
    }

    /// Rows of the next piece, where so many took so many seconds.
    fn fitting(&self, rows: u64, seconds: f64) -> u64 {
        // A thousand workers must not bring a thousand answers at once.
        let piece_seconds = PIECE_SECONDS * (self.hands as f64 / HANDS_AT_EASE).max(1.0);
        let fitting = (piece_seconds * rows as f64 / seconds.max(1e-9)) as u64;
        fitting.clamp(1, rows.saturating_mul(8).clamp(1, self.task.most_rows()))
    }

    /// A worker cannot go on.
    fn give_up(&self, give_up: GiveUp) {
        self.end(if self.executor.context.is_interrupted() {
            RunError::Interrupted { done: 0, total: self.before.total }
        } else {
            RunError::GaveUp(give_up)
        });
    }

    /// Hands to the sink what has come of a piece, if anything; whether it was taken.
    fn hand_over(&self, piece: &T::Piece, output: Option<T::Output>) -> bool {
        let Some(output) = output else { return true };
        match self.task.accept(piece, output) {
            Err(error) => {
                self.end(error);
                false
            }
            Ok(Finished { rows, failed }) => {
                self.done.fetch_add(rows, Ordering::Relaxed);
                self.failed.fetch_add(failed, Ordering::Relaxed);
                (self.on_progress)(self.progress());
                true
            }
        }
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

/// Lets the other workers end when one panics: they may wait for it.
struct EndIfPanicking<'a>(&'a RunContext<'a>);

impl Drop for EndIfPanicking<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.end();
        }
    }
}
