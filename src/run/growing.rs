//! A run of totals that can be doubled, and the blocks on their way through the model or out of a store.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::block::{BlockPlace, Scratch};
use super::fill::Filling;
use super::{
    BLOCK, FailurePolicy, Job, Keep, MOST_KEPT, Place, Progress, RunError, SAMPLE, Store, Totals, threads_in_force,
};
use crate::design::{BasePoints, Design};
use crate::estimate::part_length;
use crate::model::RowFailure;

/// A run that can go on: every replicate holds the same number of base points, and can be given more.
pub struct GrowingRun<'a> {
    job: Job<'a>,
    /// As asked for: 0 if not said.
    threads: usize,
    pool: rayon::ThreadPool,
    start: Instant,
    failures: FailurePolicy,
    keeps_outputs: bool,
    store: Option<&'a Store>,
    keep: Option<Keep<'a>>,
    stop: Option<&'a AtomicBool>,
    /// Base points of every replicate that have been run.
    points: u64,
    totals: Vec<Totals>,
    done: u64,
    failed: u64,
}

impl<'a> GrowingRun<'a> {
    /// A run of nothing yet, on `threads` threads (0: one per core).
    ///
    /// # Panics
    /// If the space has not as many factors as the design.
    ///
    /// # Errors
    /// [`RunError::Threads`] if the threads cannot be started.
    pub fn new(job: Job<'a>, threads: usize) -> Result<Self, RunError> {
        assert_eq!(job.space.factors().len(), job.design.factors(), "space and design have the same factors");
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads_in_force(threads))
            .build()
            .map_err(|source| RunError::Threads { threads: threads_in_force(threads), source })?;
        let (totals, start) = (Vec::new(), Instant::now());
        let (failures, keeps_outputs) = (FailurePolicy::DropBlock, false);
        let (store, keep, stop) = (None, None, None);
        Ok(Self {
            job,
            threads,
            pool,
            start,
            failures,
            keeps_outputs,
            store,
            keep,
            stop,
            points: 0,
            totals,
            done: 0,
            failed: 0,
        })
    }

    /// The same run with outputs kept in `store`: rows that are there are not evaluated.
    #[must_use]
    pub fn with_store(self, store: &'a Store) -> Self {
        Self { store: Some(store), ..self }
    }

    /// The same run, with a store, that tells `keep` of what it evaluates.
    #[must_use]
    pub fn with_keep(self, keep: Option<Keep<'a>>) -> Self {
        Self { keep, ..self }
    }

    /// The same run, ending as soon as `stop` is set.
    #[must_use]
    pub fn with_stop(self, stop: Option<&'a AtomicBool>) -> Self {
        Self { stop, ..self }
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
    /// [`RunError::TooManyOutputs`] if they take more than [`MOST_KEPT`].
    pub fn room_for(&self, points: u64) -> Result<(), RunError> {
        let design = self.job.design;
        let runs = points.saturating_mul(design.settings().replicates).saturating_mul(design.rows_per_point());
        let numbers = runs.saturating_mul(self.job.model.outputs().len() as u64);
        let bytes = numbers.saturating_mul(size_of::<f64>() as u64);
        if (self.keeps_outputs || self.store.is_some()) && bytes > MOST_KEPT {
            return Err(RunError::TooManyOutputs { runs, bytes });
        }
        Ok(())
    }

    /// What `work` returns, done on the threads of this run.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.install(work)
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
        if self.store.is_some() {
            let rows = points * design.rows_per_point();
            let all: Vec<(u64, Range<u64>)> = (0..replicates).map(|replicate| (replicate, 0..rows)).collect();
            self.fill(&all, on_progress)?;
        }
        let growth = Growth {
            job: self.job,
            range: self.points..points,
            total: points * replicates * design.rows_per_point(),
            on_progress,
            start: self.start,
            done: AtomicU64::new(self.done),
            failed: AtomicU64::new(self.failed),
            failures: self.failures,
            keeps_outputs: self.keeps_outputs,
            store: self.store,
            stop: self.stop,
            given_up: AtomicBool::new(false),
            end: Mutex::new(None),
            failure: Mutex::new(None),
            idle: Mutex::new(Vec::new()),
        };
        let grown = self.pool.install(|| growth.replicates(0..replicates));
        if let Some((row, reason)) = growth.failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(RunError::RowFailed { row, reason });
        }
        if let Some(end) = growth.end.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(end);
        }
        if self.totals.is_empty() {
            self.totals = grown;
        } else {
            self.totals.iter_mut().zip(&grown).for_each(|(totals, more)| totals.merge(more));
        }
        (self.done, self.failed) = (growth.done.into_inner(), growth.failed.into_inner());
        self.points = points;
        Ok(())
    }

    /// Evaluates those of `rows` (replicate, and rows counted within it) that the store of the run lacks; nothing without a
    /// store.
    ///
    /// # Errors
    /// [`RunError`] if the run ends before that.
    pub fn fill(&self, rows: &[(u64, Range<u64>)], on_progress: &(dyn Fn(Progress) + Sync)) -> Result<(), RunError> {
        let Some(store) = self.store else { return Ok(()) };
        let filling = Filling {
            job: self.job,
            store,
            keep: self.keep,
            failures: self.failures,
            workers: self.workers(),
            stop: self.stop,
            on_progress,
            start: self.start,
        };
        filling.fill(rows)
    }

    /// Workers at once: what the model asks for, but no more than the threads that somebody has asked for.
    fn workers(&self) -> usize {
        match (self.job.model.concurrency(), self.threads) {
            (None, _) => self.pool.current_num_threads(),
            (Some(workers), 0) => workers,
            (Some(workers), threads) => workers.min(threads),
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

/// The base points `range` of every replicate, on their way through the model.
struct Growth<'a, 'p> {
    job: Job<'a>,
    range: Range<u64>,
    /// Rows there will be in all.
    total: u64,
    on_progress: &'p (dyn Fn(Progress) + Sync),
    start: Instant,
    done: AtomicU64,
    failed: AtomicU64,
    failures: FailurePolicy,
    keeps_outputs: bool,
    store: Option<&'a Store>,
    stop: Option<&'a AtomicBool>,
    given_up: AtomicBool,
    end: Mutex<Option<RunError>>,
    failure: Mutex<Option<(Place, RowFailure)>>,
    /// Scratch space and workers not in use: one per thread that has ever been busy at once.
    idle: Mutex<Vec<Scratch<'a>>>,
}

impl Growth<'_, '_> {
    fn replicates(&self, range: Range<u64>) -> Vec<Totals> {
        match range.end - range.start {
            1 => vec![self.replicate(range.start)],
            n => {
                let middle = range.start + n / 2;
                let (mut left, right) =
                    rayon::join(|| self.replicates(range.start..middle), || self.replicates(middle..range.end));
                left.extend(right);
                left
            }
        }
    }

    fn replicate(&self, replicate: u64) -> Totals {
        let points = self.job.design.replicate(replicate);
        let blocks = self.range.start / BLOCK..self.range.end.div_ceil(BLOCK);
        self.tree(&|block| self.block(&points, replicate, block), blocks)
    }

    /// Folds the blocks of `range`: the left branch holds the largest power of two below their number, so a design
    /// that is doubled has the tree of the shorter one as its left branch.
    fn tree(&self, leaf: &(dyn Fn(u64) -> Totals + Sync), range: Range<u64>) -> Totals {
        match range.end - range.start {
            1 => leaf(range.start),
            n => {
                let middle = range.start + n.next_power_of_two() / 2;
                let (mut left, right) =
                    rayon::join(|| self.tree(leaf, range.start..middle), || self.tree(leaf, middle..range.end));
                left.merge(&right);
                left
            }
        }
    }

    fn block(&self, points: &BasePoints, replicate: u64, block: u64) -> Totals {
        let first = (block * BLOCK).max(self.range.start);
        let rows = ((block + 1) * BLOCK).min(self.range.end) - first;
        if self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            let (done, total) = (self.done.load(Ordering::Relaxed), self.total);
            self.end(RunError::Interrupted { done, total });
        }
        if self.given_up.load(Ordering::Relaxed) {
            return Totals::none(self.job.model);
        }
        // A thread that panicked holding the lock has ended the run already; its scratch space is as good as any.
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut scratch = taken.unwrap_or_else(|| Scratch::new(self.job));
        let sample = (SAMPLE / self.job.design.settings().replicates).max(1);
        let place = BlockPlace {
            first: Place { replicate, point: first, run: 0 },
            part_length: part_length(block, BLOCK),
            sampled: sample.saturating_sub(first) as usize,
            keeps_outputs: self.keeps_outputs,
        };
        let recalled = self.store.is_some_and(|store| scratch.recall(store, place, rows as usize));
        if !recalled {
            points.fill(first, scratch.unit_columns(rows as usize));
            if let Some(reason) = scratch.run_rows(self.job, &|runs, failed| self.report(runs, failed)) {
                self.end(RunError::GaveUp { reason });
                return Totals::none(self.job.model);
            }
        }
        let totals = scratch.totals(self.job, place);
        idle().push(scratch);
        if self.failures == FailurePolicy::Fail {
            self.note_failure(&totals);
        }
        totals
    }

    /// The run ends, by the first reason given.
    fn end(&self, error: RunError) {
        self.given_up.store(true, Ordering::Relaxed);
        self.end.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    fn note_failure(&self, totals: &Totals) {
        let failures = totals.outputs.iter().flat_map(|output| &output.failures);
        let Some((reason, tally)) = failures.min_by_key(|(_, tally)| tally.first) else { return };
        self.given_up.store(true, Ordering::Relaxed);
        let mut noted = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if noted.as_ref().is_none_or(|(place, _)| tally.first < *place) {
            *noted = Some((tally.first, reason.clone()));
        }
    }

    fn report(&self, runs: u64, failed: u64) {
        let done = self.done.fetch_add(runs, Ordering::Relaxed) + runs;
        let failed = self.failed.fetch_add(failed, Ordering::Relaxed) + failed;
        (self.on_progress)(Progress { done, recalled: 0, total: self.total, failed, elapsed: self.start.elapsed() });
    }
}
