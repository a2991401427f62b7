//! A run of totals that can be doubled.

use std::ops::Range;
use std::sync::Mutex;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::executor::Executor;
use super::fold::Fold;
use super::remote::Remote;
use super::rows::MissingRows;
use super::tracker::Tracker;
use super::{FailurePolicy, Job, MAX_STORED_BYTES, OutputSink, Progress, RunError, Store, Totals, threads_in_force};
use crate::clock::Instant;
use crate::design::Design;
use crate::model::RunContext;

/// A run that can go on: every replicate holds the same number of base points, and can be given more.
///
/// Blocks of base points of quick models are evaluated and folded at once. The rows of a model that takes its time, and
/// those that remote workers share, go through a store: in batches of any size, and folded from there.
pub struct GrowingRun<'a> {
    job: Job<'a>,
    context: &'a RunContext<'a>,
    executor: Executor<'a>,
    /// Threads for blocks, and for what is estimated from the totals; `None` for those of the caller.
    pool: Option<ThreadPool>,
    start: Instant,
    failures: FailurePolicy,
    keeps_outputs: bool,
    store: Option<&'a Store>,
    /// Of a run that needs a store and was given none.
    own_store: Option<Store>,
    sink: Option<&'a dyn OutputSink>,
    /// Base points of every replicate that have been run.
    points: u64,
    totals: Vec<Totals>,
}

impl<'a> GrowingRun<'a> {
    /// A run of nothing yet, on `threads` threads (0: one per core), whose workers know of `context`.
    ///
    /// # Panics
    /// If the space has not as many factors as the design.
    ///
    /// # Errors
    /// [`RunError::Threads`] if the threads cannot be started.
    pub fn new(job: Job<'a>, context: &'a RunContext<'a>, threads: usize) -> Result<Self, RunError> {
        assert_eq!(job.space.factors().len(), job.design.factors(), "space and design have the same factors");
        Ok(Self {
            job,
            context,
            executor: Executor::new(job.model, context, threads),
            pool: thread_pool(threads)?,
            start: Instant::now(),
            failures: FailurePolicy::DropBlock,
            keeps_outputs: false,
            store: None,
            own_store: None,
            sink: None,
            points: 0,
            totals: Vec::new(),
        })
    }

    /// The same run with workers in other processes too.
    #[must_use]
    pub(crate) fn with_remote(self, remote: Option<Remote<'a>>) -> Self {
        Self { executor: self.executor.with_remote(remote), ..self }
    }

    /// The same run with outputs kept in `store`: rows that are there are not evaluated.
    #[must_use]
    pub fn with_store(self, store: &'a Store) -> Self {
        Self { store: Some(store), ..self }
    }

    /// The same run with `sink`, which takes every piece of outputs that is evaluated before its rows count as done.
    #[must_use]
    pub fn with_sink(self, sink: &'a dyn OutputSink) -> Self {
        Self { sink: Some(sink), ..self }
    }

    /// The same run under another policy than [`FailurePolicy::DropBlock`].
    #[must_use]
    pub fn with_failures(self, failures: FailurePolicy) -> Self {
        Self { failures, ..self }
    }

    /// The same run with the outputs of every run kept in `OutputTotals::kept`, if `keeps_outputs`.
    #[must_use]
    pub fn with_outputs_kept(self, keeps_outputs: bool) -> Self {
        Self { keeps_outputs, ..self }
    }

    /// Whether rows go through a store.
    fn needs_store(&self) -> bool {
        self.store.is_some() || self.job.model.is_slow() || self.executor.has_remote()
    }

    /// Whether the outputs of `points` base points of every replicate can be kept, where they are to be.
    ///
    /// # Errors
    /// [`RunError::TooManyOutputs`] if they take more than [`MAX_STORED_BYTES`].
    pub fn room_for(&self, points: u64) -> Result<(), RunError> {
        let design = self.job.design;
        let runs = points.saturating_mul(design.settings().replicates).saturating_mul(design.rows_per_point());
        let numbers = runs.saturating_mul(self.job.model.outputs().len() as u64);
        let bytes = numbers.saturating_mul(size_of::<f64>() as u64);
        if (self.keeps_outputs || self.needs_store()) && bytes > MAX_STORED_BYTES {
            return Err(RunError::TooManyOutputs { runs, bytes });
        }
        Ok(())
    }

    /// What `work` returns, done on the threads of this run.
    ///
    /// # Panics
    /// If the caller is a thread of another pool, and no thread can be started to wait for this one.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let Some(pool) = &self.pool else { return work() };
        if rayon::current_thread_index().is_none() {
            return pool.install(work);
        }
        // A thread of another pool that waits for this one does other work of its pool, which may be a run as well, and
        // another one in that: many runs side by side would use up its stack.
        std::thread::scope(|scope| scope.spawn(|| pool.install(work)).join())
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }

    /// Runs the base points that every replicate lacks to hold `points` of them, at most the design's. Those that have been
    /// run are not run again. From one power of two to the next, from [`BLOCK`](super::BLOCK) on, the totals are
    /// the same bits as those of a run that began with the larger number.
    ///
    /// # Errors
    /// [`RunError::RowFailed`] if a row fails and the run is to stop at that; the run is then of no further use.
    /// [`RunError::TooManyOutputs`] if there is no [room](Self::room_for) for the outputs that are to be kept.
    pub fn grow_to(&mut self, points: u64, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<(), RunError> {
        let design = self.job.design;
        let points = points.min(design.points_per_replicate());
        if points <= self.points {
            return Ok(());
        }
        self.room_for(points)?;
        if self.store.is_none() && self.own_store.is_none() && self.needs_store() {
            self.own_store = Some(Store::new(design, self.job.model));
        }
        let store = self.store.or(self.own_store.as_ref());
        let replicates = design.settings().replicates;
        let silent: &(dyn Fn(Progress) + Sync) = &|_| ();
        let on_progress = match store {
            None => on_progress,
            Some(store) => {
                let rows = points * design.rows_per_point();
                let all: Vec<(u64, Range<u64>)> = (0..replicates).map(|replicate| (replicate, 0..rows)).collect();
                self.run_missing(&all, store, on_progress)?;
                silent
            }
        };
        let [done, failed] = [|totals: &Totals| totals.runs, |totals: &Totals| totals.failed_runs]
            .map(|count| self.totals.iter().map(count).sum::<u64>());
        let total = points * replicates * design.rows_per_point();
        let before = Progress { done, recalled: 0, total, failed, elapsed: self.start.elapsed() };
        let tracker = Tracker::new(self.context, before, self.start, on_progress);
        let fold = Fold {
            job: self.job,
            context: self.context,
            failures: self.failures,
            keeps_outputs: self.keeps_outputs,
            store,
            sink: self.sink,
            tracker: &tracker,
            idle: Mutex::default(),
        };
        let new = self.install(|| fold.run(self.points..points));
        drop(fold);
        tracker.finish()?;
        let new = new.unwrap_or_default();
        if self.totals.is_empty() {
            self.totals = new;
        } else {
            self.totals.iter_mut().zip(&new).for_each(|(totals, new)| totals.merge(new));
        }
        self.points = points;
        Ok(())
    }

    /// Evaluates those of `rows` (replicate, and rows counted within it) that `store` lacks.
    ///
    /// # Errors
    /// [`RunError`] if the run ends before that.
    pub fn run_missing(
        &self,
        rows: &[(u64, Range<u64>)],
        store: &Store,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<(), RunError> {
        let (missing, before) = MissingRows::new(self.job, rows, store, self.sink, self.failures);
        let before = Progress { elapsed: self.start.elapsed(), ..before };
        if before.done > 0 {
            on_progress(before);
        }
        if before.done < before.total {
            self.executor.execute(&missing, before, self.start, on_progress)?;
        }
        Ok(())
    }

    /// The design that the run grows into.
    pub fn design(&self) -> &'a Design {
        self.job.design
    }

    /// Base points of every replicate that have been run.
    pub fn points_per_replicate(&self) -> u64 {
        self.points
    }

    pub(super) fn into_totals(self) -> Vec<Totals> {
        self.totals
    }

    /// Totals of each replicate, in order; empty before anything has been run.
    pub fn totals(&self) -> &[Totals] {
        &self.totals
    }

    /// Time since the run was made.
    pub fn elapsed(&self) -> std::time::Duration {
        self.start.elapsed()
    }
}

/// A pool of `threads` threads (0: one per core); `None` if those that the caller has are as many: to start a pool takes
/// longer than many a run.
pub(super) fn thread_pool(threads: usize) -> Result<Option<ThreadPool>, RunError> {
    let threads = threads_in_force(threads);
    // A page has one thread, and cannot start another.
    let is_page = cfg!(target_family = "wasm");
    if is_page || rayon::current_thread_index().is_none() && rayon::current_num_threads() == threads {
        return Ok(None);
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map(Some).map_err(|source| RunError::Threads { threads, source: source.into() })
}
