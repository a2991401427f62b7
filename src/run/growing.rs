//! A run of totals that can be doubled.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use super::blocks::{BlockOptions, Blocks};
use super::executor::Executor;
use super::fold::{Fold, Sums};
use super::journal::Checkpoint;
use super::pool::thread_pool;
use super::remote::Remote;
use super::rows::{Known, MissingRows};
use super::{BLOCK, FailurePolicy, Job, MAX_STORED_BYTES, PieceSink, Progress, RunError, Store, Totals};
use crate::clock::Instant;
use crate::design::Design;
use crate::model::RunContext;

/// A run that can go on: every replicate holds the same number of base points, and can be given more.
pub struct GrowingRun<'a> {
    job: Job<'a>,
    executor: Executor<'a>,
    /// For what is estimated from the totals.
    pool: Option<Arc<rayon::ThreadPool>>,
    start: Instant,
    failures: FailurePolicy,
    keeps_outputs: bool,
    store: Option<&'a Store>,
    sink: Option<PieceSink<'a>>,
    checkpoint: Option<&'a Checkpoint>,
    /// Sums from which the run begins, until it does.
    recorded: Option<Sums>,
    /// The sums of all that was run, as bytes, if there is a checkpoint.
    last_sums: Vec<u8>,
    /// Base points of every replicate that have been run.
    points: u64,
    /// See [`Sums`].
    began: u64,
    totals: Vec<Totals>,
    progress: Progress,
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
        let pool = thread_pool(threads)?;
        Ok(Self {
            job,
            executor: Executor::new(job.model, context, threads),
            pool,
            start: Instant::now(),
            failures: FailurePolicy::DropBlock,
            keeps_outputs: false,
            store: None,
            sink: None,
            checkpoint: None,
            recorded: None,
            last_sums: Vec::new(),
            points: 0,
            began: 0,
            totals: Vec::new(),
            progress: Progress { done: 0, recalled: 0, total: 0, failed: 0, elapsed: Duration::ZERO },
        })
    }

    /// The same run with workers in other processes too.
    #[must_use]
    pub(crate) fn with_remote(self, remote: Option<Remote<'a>>) -> Self {
        Self { executor: self.executor.with_remote(remote), ..self }
    }

    /// The same run with outputs kept in `store`: rows that are there are not evaluated. `sink` takes every piece of
    /// outputs before it joins the store.
    #[must_use]
    pub fn with_store(self, store: &'a Store, sink: Option<PieceSink<'a>>) -> Self {
        Self { store: Some(store), sink, ..self }
    }

    /// The same run with its sums recorded in `checkpoint` from time to time. It begins from `sums`.
    #[must_use]
    pub fn with_checkpoint(self, checkpoint: &'a Checkpoint, sums: Sums) -> Self {
        Self { checkpoint: Some(checkpoint), recorded: Some(sums), ..self }
    }

    /// The same run under another policy than [`FailurePolicy::DropBlock`].
    #[must_use]
    pub fn with_failures(self, failures: FailurePolicy) -> Self {
        Self { failures, ..self }
    }

    /// The same run with the outputs of every run kept in [`OutputTotals::kept`](super::OutputTotals::kept), if `keeps_outputs`.
    #[must_use]
    pub fn with_outputs_kept(self, keeps_outputs: bool) -> Self {
        Self { keeps_outputs, ..self }
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
        if (self.keeps_outputs || self.store.is_some()) && bytes > MAX_STORED_BYTES {
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
    /// run are not run again. From one power of two to the next, from [`BLOCK`] on, the totals are
    /// the same bits as those of a run that began with the larger number.
    ///
    /// # Errors
    /// [`RunError::RowFailed`] if a row fails and the run is to stop at that; the run is then of no further use.
    /// [`RunError::TooManyOutputs`] if there is no [room](Self::room_for) for the outputs that are to be kept.
    pub fn grow_to(&mut self, points: u64, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<(), RunError> {
        let points = points.min(self.job.design.points_per_replicate());
        if points <= self.points {
            return Ok(());
        }
        self.room_for(points)?;
        let design = self.job.design;
        let replicates = design.settings().replicates;
        if let Some(store) = self.store {
            let rows = points * design.rows_per_point();
            let all: Vec<(u64, Range<u64>)> = (0..replicates).map(|replicate| (replicate, 0..rows)).collect();
            self.run_missing(&all, store, on_progress)?;
        }
        let sums = self.recorded.take().unwrap_or_else(|| self.sums());
        self.began = sums.began;
        let total = points * replicates * design.rows_per_point();
        let known = |count: fn(&Totals) -> u64| sums.totals().map(count).sum::<u64>();
        let (done, failed) = (known(|totals| totals.runs), known(|totals| totals.failed_runs));
        let recalled = if self.points == 0 { done } else { self.progress.recalled };
        let before = Progress { done, recalled, total, failed, elapsed: self.start.elapsed() };
        if recalled > 0 {
            on_progress(before);
        }
        let options = BlockOptions {
            failures: self.failures,
            keeps_outputs: self.keeps_outputs,
            // Outputs that are here are folded here.
            in_strips: self.store.is_none() && self.executor.has_remote(),
            store: self.store,
            checkpoint: self.checkpoint,
        };
        let blocks = Blocks::new(self.job, self.executor.context(), Fold::new(sums), points, options);
        let outcome = if self.store.is_some() {
            // The rows were counted when they were evaluated.
            self.executor.execute(&blocks, before, self.start, &|_| ())
        } else {
            self.executor.execute(&blocks, before, self.start, on_progress)
        };
        let fold = blocks.into_fold();
        if self.checkpoint.is_some() {
            self.last_sums.clear();
            fold.write_sums(&mut self.last_sums);
        }
        self.progress = outcome?;
        self.totals = fold.into_totals();
        self.points = points;
        Ok(())
    }

    /// The sums of all that has been run, to go on with.
    fn sums(&mut self) -> Sums {
        let replicates = self.job.design.settings().replicates;
        if self.began == 0 && self.points > 0 && !(self.points.is_power_of_two() && self.points >= BLOCK) {
            self.began = self.points;
        }
        let heads = std::mem::take(&mut self.totals);
        Sums { began: self.began, from: self.points, heads, ..Sums::new(replicates) }
    }

    /// Evaluates those of `rows` (replicate, and rows counted within it) that `store` lacks.
    ///
    /// # Errors
    /// [`RunError`] if the run ends before that.
    pub fn run_missing(
        &self,
        rows: &[(u64, Range<u64>)],
        store: &'a Store,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<(), RunError> {
        let (task, known) = MissingRows::new(self.job, rows, store, self.sink, self.failures);
        let Known { total, rows: done, failed } = known;
        let before = Progress { done, recalled: done, total, failed, elapsed: self.start.elapsed() };
        if done > 0 {
            on_progress(before);
        }
        if done < total {
            self.executor.execute(&task, before, self.start, on_progress)?;
        }
        Ok(())
    }

    /// Writes a last checkpoint, if there are checkpoints.
    ///
    /// # Errors
    /// [`RunError::NotKept`] if it cannot be written.
    pub fn write_checkpoint(&self) -> Result<(), RunError> {
        match self.checkpoint {
            Some(checkpoint) if !self.last_sums.is_empty() => {
                checkpoint.write(&self.last_sums).map_err(|source| RunError::NotKept { source })
            }
            _ => Ok(()),
        }
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
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}
