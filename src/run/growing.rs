//! Runs whose totals can be extended by more base points.

use std::ops::Range;
use std::sync::{Mutex, OnceLock};

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::executor::Executor;
use super::fold::Fold;
use super::journal::Journal;
use super::remote::Remote;
use super::rows::MissingRows;
use super::tracker::Tracker;
use super::{FailurePolicy, Job, MAX_STORED_BYTES, Progress, RunError, Store, Totals, threads_in_force};
use crate::design::Design;
use crate::model::RunContext;
use apportion_base::clock::Instant;

/// A run that can be extended: every replicate has the same number of base points, and can grow.
///
/// Blocks of base points are evaluated and folded at once. In a run with a [store](Self::store), as slow models and
/// remote workers need, rows are evaluated in batches of any size, and are folded from there.
pub struct GrowingRun<'a> {
    pub(super) job: Job<'a>,
    pub(super) context: &'a RunContext<'a>,
    executor: Executor<'a>,
    /// Threads for blocks and for estimates from the totals; `None` to use those of the caller.
    pool: Option<ThreadPool>,
    start: Instant,
    /// What happens when a row fails; by default [`FailurePolicy::DropBlock`].
    pub failures: FailurePolicy,
    /// Whether the outputs of every run are kept in `OutputTotals::point_outputs`.
    pub keeps_outputs: bool,
    /// Keeps outputs: rows that it already has are not evaluated.
    pub store: Option<&'a Store>,
    /// Records every block of evaluated rows, once it is open.
    pub(crate) journal: Option<&'a OnceLock<Journal>>,
    /// Base points of every replicate evaluated so far.
    points: u64,
    pub(super) totals: Vec<Totals>,
}

impl<'a> GrowingRun<'a> {
    /// Creates an empty run on `threads` threads (0: one per core), whose workers receive `context`.
    ///
    /// # Panics
    /// If the number of factors of the space differs from that of the design.
    pub fn new(job: Job<'a>, context: &'a RunContext<'a>, threads: usize) -> Self {
        assert_eq!(job.space.factors().len(), job.design.factors(), "space and design have the same factors");
        Self {
            job,
            context,
            executor: Executor::new(job.model, context, threads),
            pool: thread_pool(threads),
            start: Instant::now(),
            failures: FailurePolicy::DropBlock,
            keeps_outputs: false,
            store: None,
            journal: None,
            points: 0,
            totals: Vec::new(),
        }
    }

    /// Adds remote workers, which evaluate rows of a run with a store.
    #[must_use]
    pub(crate) fn with_remote(mut self, remote: Option<Remote<'a>>) -> Self {
        self.executor.remote = remote;
        self
    }

    /// Checks that the outputs of `points` base points of every replicate fit in memory, if they are to be kept.
    ///
    /// # Errors
    /// [`RunError::TooManyOutputs`] if they take more than [`MAX_STORED_BYTES`].
    pub fn room_for(&self, points: u64) -> Result<(), RunError> {
        let design = self.job.design;
        let runs = points.saturating_mul(design.settings().replicates).saturating_mul(design.rows_per_point());
        let numbers = runs.saturating_mul(self.job.model.outputs().len() as u64);
        let bytes = numbers.saturating_mul(size_of::<f64>() as u64);
        if (self.keeps_outputs || self.store.is_some()) && bytes > MAX_STORED_BYTES {
            return Err(RunError::TooManyOutputs { runs, bytes });
        }
        Ok(())
    }

    /// Runs `work` on the threads of this run and returns its result.
    ///
    /// # Panics
    /// If the caller is a thread of another pool, and no thread can be started to wait for this one.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let Some(pool) = &self.pool else { return work() };
        if rayon::current_thread_index().is_none() {
            return pool.install(work);
        }
        // A thread of another pool that waits for this one runs other work of its pool, which may be a run as well, and
        // so on: many simultaneous runs would use up its stack.
        std::thread::scope(|scope| scope.spawn(|| pool.install(work)).join())
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }

    /// Runs the base points missing for every replicate to have `points` of them, at most the design's. Existing ones
    /// are not run again. From one power of two to the next, from [`BLOCK`](super::BLOCK) on, the totals have the same
    /// bits as those of a run that began with the larger number.
    ///
    /// # Errors
    /// [`RunError::RowFailed`] if a row fails and the run is to stop at that; the run cannot be used afterwards.
    /// [`RunError::TooManyOutputs`] if there is no [room](Self::room_for) for the outputs that are to be kept.
    pub fn grow_to(&mut self, points: u64, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<(), RunError> {
        let design = self.job.design;
        let points = points.min(design.points_per_replicate());
        if points <= self.points {
            return Ok(());
        }
        self.room_for(points)?;
        let replicates = design.settings().replicates;
        let silent: &(dyn Fn(Progress) + Sync) = &|_| ();
        let on_progress = match self.store {
            None => on_progress,
            Some(store) => {
                let rows = points * design.rows_per_point();
                let all: Vec<(u64, Range<u64>)> = (0..replicates).map(|replicate| (replicate, 0..rows)).collect();
                self.run_missing(&all, store, on_progress)?;
                silent
            }
        };
        let before = Progress {
            done: self.totals.iter().map(|totals| totals.runs).sum(),
            recalled: 0,
            total: points * replicates * design.rows_per_point(),
            failed: self.totals.iter().map(|totals| totals.failed_runs).sum(),
            elapsed: self.start.elapsed(),
        };
        let tracker = Tracker::new(self.context, before, self.start, on_progress);
        let fold = Fold { run: self, tracker: &tracker, idle: Mutex::default() };
        let new = self.install(|| fold.run(self.points..points));
        tracker.finish()?;
        let new = new.unwrap_or_default();
        if self.totals.is_empty() {
            self.totals = new;
        } else {
            for (totals, new) in self.totals.iter_mut().zip(new) {
                totals.merge(new);
            }
        }
        self.points = points;
        Ok(())
    }

    /// Evaluates those of `rows` (replicate, and rows counted within it) that are missing in `store`.
    ///
    /// # Errors
    /// [`RunError`] if the run ends before that.
    pub fn run_missing(
        &self,
        rows: &[(u64, Range<u64>)],
        store: &Store,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<(), RunError> {
        let (missing, before) = MissingRows::new(self.job, rows, store, self.journal, self.failures);
        let before = Progress { elapsed: self.start.elapsed(), ..before };
        if before.done > 0 {
            on_progress(before);
        }
        if before.done < before.total {
            self.executor.execute(&missing, before, self.start, on_progress)?;
        }
        Ok(())
    }

    /// Returns the design that the run grows into.
    pub fn design(&self) -> &'a Design {
        self.job.design
    }

    /// Returns the number of base points of every replicate that have been run.
    pub fn points_per_replicate(&self) -> u64 {
        self.points
    }

    /// Returns the totals of each replicate, in order; empty before the first base point has been run.
    pub fn totals(&self) -> &[Totals] {
        &self.totals
    }

    /// Returns the time since the run was created.
    pub fn elapsed(&self) -> std::time::Duration {
        self.start.elapsed()
    }
}

/// Creates a pool of `threads` threads (0: one per core); `None` if the caller already has this many, because starting
/// a pool takes longer than many runs, or if the system does not let so many start.
pub(super) fn thread_pool(threads: usize) -> Option<ThreadPool> {
    let threads = threads_in_force(threads);
    // A web page has one thread, and cannot start another.
    let is_page = cfg!(target_family = "wasm");
    if is_page || rayon::current_thread_index().is_none() && rayon::current_num_threads() == threads {
        return None;
    }
    ThreadPoolBuilder::new().num_threads(threads).build().ok()
}
