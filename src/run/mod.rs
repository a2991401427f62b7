//! Running a design through a model: fixed blocks of base points on the rayon pool, folded into constant-size totals.
//!
//! A block is [`BLOCK`] base points with all of their rows. Blocks are merged in a binary tree whose shape depends on
//! the number of blocks alone, so that the totals are the same bits on any number of threads; and only the totals of
//! the open branches exist at any time, so that memory does not grow with the number of samples, unless the outputs are
//! kept for intervals that need them.

mod block;
mod totals;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use thiserror::Error;

pub use totals::{OutputTotals, Place, SAMPLE, Tally, Totals};

use crate::design::{BasePoints, Design};
use crate::estimate::part_length;
use crate::model::{Model, RowFailure};
use crate::space::Space;
use block::{BlockPlace, Scratch};

/// Base points in a block: their columns stay in the cache, and a block takes long enough to be worth a task.
pub const BLOCK: u64 = 256;

/// What is run: every row of `design`, as points of `space`, through `model`.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// Where the rows lie in the unit cube.
    pub design: &'a Design,
    /// What they mean in SI units; has as many factors as the design.
    pub space: &'a Space,
    /// What is evaluated.
    pub model: &'a dyn Model,
}

/// How far a run has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Model runs finished.
    pub done: u64,
    /// Model runs of the whole design.
    pub total: u64,
    /// Model runs finished that have failed in at least one output.
    pub failed: u64,
    /// Time since the start.
    pub elapsed: Duration,
}

/// Why a run could not take place, or was given up.
#[derive(Debug, Error)]
pub enum RunError {
    /// The operating system refused the threads.
    #[error("cannot start {threads} threads: {source}")]
    Threads {
        /// The number asked for.
        threads: usize,
        /// What rayon said.
        source: rayon::ThreadPoolBuildError,
    },
    /// A row failed, and the run was to stop at the first one.
    #[error("a run failed, and the study says to stop then: {reason}")]
    RowFailed {
        /// The row.
        row: Place,
        /// Why.
        reason: RowFailure,
    },
    /// The outputs of all runs were to be kept, and are too many.
    #[error(
        "the outputs of {runs} runs, which these intervals need all at once, take {bytes} bytes of memory, more than the \
         {MOST_KEPT} that they may: take fewer base samples or fewer outputs, or intervals = \"batches\""
    )]
    TooManyOutputs {
        /// Model runs.
        runs: u64,
        /// Bytes that their outputs take.
        bytes: u64,
    },
}

/// Memory that kept outputs may take, in bytes: 8 GiB.
pub const MOST_KEPT: u64 = 8 << 30;

/// Runs the whole job on `threads` threads (0: one per core) and returns the totals of each replicate, in order.
///
/// `on_progress` is called whenever a block has gone through one kind of row, from the thread that did it. The result
/// does not depend on the number of threads, in any bit.
///
/// # Panics
/// If the space has not as many factors as the design.
///
/// # Errors
/// [`RunError::Threads`] if the threads cannot be started. Rows that fail are part of the totals, not errors.
pub fn run(job: Job<'_>, threads: usize, on_progress: &(dyn Fn(Progress) + Sync)) -> Result<Vec<Totals>, RunError> {
    let mut run = GrowingRun::new(job, threads)?;
    run.grow_to(job.design.points_per_replicate(), on_progress)?;
    Ok(run.totals)
}

/// Number of threads that a run uses when asked for `threads`.
pub fn threads_in_force(threads: usize) -> usize {
    if threads == 0 { std::thread::available_parallelism().map_or(1, usize::from) } else { threads }
}

/// What happens when a row fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailurePolicy {
    /// The indices that need the row do without its base point.
    DropBlock,
    /// The run is given up.
    Fail,
}

impl FailurePolicy {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::DropBlock, Self::Fail];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::DropBlock => "drop-block",
            Self::Fail => "fail",
        }
    }
}

/// A run that can go on: every replicate holds the same number of base points, and can be given more.
pub struct GrowingRun<'a> {
    job: Job<'a>,
    pool: rayon::ThreadPool,
    start: Instant,
    failures: FailurePolicy,
    keeps_outputs: bool,
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
        Ok(Self { job, pool, start, failures, keeps_outputs, points: 0, totals, done: 0, failed: 0 })
    }

    /// The same run under another policy than [`FailurePolicy::DropBlock`].
    #[must_use]
    pub fn with_failures(self, failures: FailurePolicy) -> Self {
        Self { failures, ..self }
    }

    /// The same run with the outputs of every run kept in [`OutputTotals::kept`], if `keeps_outputs`.
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
        if self.keeps_outputs && bytes > MOST_KEPT {
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
            given_up: AtomicBool::new(false),
            failure: Mutex::new(None),
            idle: Mutex::new(Vec::new()),
        };
        let grown = self.pool.install(|| growth.replicates(0..replicates));
        if let Some((row, reason)) = growth.failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(RunError::RowFailed { row, reason });
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

    /// The design that the run grows into.
    pub fn design(&self) -> &'a Design {
        self.job.design
    }

    /// Base points of every replicate that have been run.
    pub fn points_per_replicate(&self) -> u64 {
        self.points
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
    given_up: AtomicBool,
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
        if self.given_up.load(Ordering::Relaxed) {
            return Totals::none(self.job.model);
        }
        // A thread that panicked holding the lock has ended the run already; its scratch space is as good as any.
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        let mut scratch = taken.unwrap_or_else(|| Scratch::new(self.job));
        points.fill(first, scratch.unit_columns(rows as usize));
        let sample = (SAMPLE / self.job.design.settings().replicates).max(1);
        let place = BlockPlace {
            first: Place { replicate, point: first, run: 0 },
            part_length: part_length(block, BLOCK),
            sampled: sample.saturating_sub(first) as usize,
            keeps_outputs: self.keeps_outputs,
        };
        let totals = scratch.evaluate(self.job, place, &|runs, failed| self.report(runs, failed));
        idle().push(scratch);
        if self.failures == FailurePolicy::Fail {
            self.note_failure(&totals);
        }
        totals
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
        (self.on_progress)(Progress { done, total: self.total, failed, elapsed: self.start.elapsed() });
    }
}

#[cfg(test)]
mod tests;
