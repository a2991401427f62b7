//! Running a design through a model: fixed blocks of base points on the rayon pool, folded into constant-size totals.
//!
//! A block is [`BLOCK`] base points with all of their rows. Blocks are merged in a binary tree whose shape depends on
//! the number of blocks alone, so that the totals are the same bits on any number of threads; and only the totals of
//! the open branches exist at any time, so that memory does not grow with the number of samples.

mod block;
mod totals;

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use thiserror::Error;

pub use totals::{OutputTotals, SAMPLE, Tally, Totals};

use crate::design::Design;
use crate::model::Model;
use crate::space::Space;
use block::{Place, Scratch};

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

/// Why a run could not take place.
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
}

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
    assert_eq!(job.space.factors().len(), job.design.factors(), "space and design have the same factors");
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads_in_force(threads))
        .build()
        .map_err(|source| RunError::Threads { threads: threads_in_force(threads), source })?;
    let runner = Runner {
        job,
        on_progress,
        start: Instant::now(),
        done: AtomicU64::new(0),
        failed: AtomicU64::new(0),
        idle: Mutex::new(Vec::new()),
    };
    let replicates = job.design.settings().replicates;
    Ok(pool.install(|| runner.replicates(0..replicates)))
}

/// Number of threads that `run` uses when asked for `threads`.
pub fn threads_in_force(threads: usize) -> usize {
    if threads == 0 { std::thread::available_parallelism().map_or(1, usize::from) } else { threads }
}

struct Runner<'a> {
    job: Job<'a>,
    on_progress: &'a (dyn Fn(Progress) + Sync),
    start: Instant,
    done: AtomicU64,
    failed: AtomicU64,
    /// Scratch space and workers not in use: one per thread that has ever been busy at once.
    idle: Mutex<Vec<Scratch<'a>>>,
}

impl Runner<'_> {
    fn replicates(&self, range: std::ops::Range<u64>) -> Vec<Totals> {
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
        let blocks = self.job.design.points_per_replicate().div_ceil(BLOCK);
        self.tree(&|block| self.block(&points, replicate, block), 0..blocks)
    }

    /// Folds the blocks of `range`: the left branch holds the largest power of two below their number, so a design
    /// that is doubled has the tree of the shorter one as its left branch.
    fn tree(&self, leaf: &(dyn Fn(u64) -> Totals + Sync), range: std::ops::Range<u64>) -> Totals {
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

    fn block(&self, points: &crate::design::BasePoints, replicate: u64, block: u64) -> Totals {
        let design = self.job.design;
        let first = block * BLOCK;
        let rows = BLOCK.min(design.points_per_replicate() - first) as usize;
        // A thread that panicked holding the lock has ended the run already; its scratch space is as good as any.
        let idle = || self.idle.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let taken = idle().pop();
        let mut scratch = taken.unwrap_or_else(|| Scratch::new(self.job));
        points.fill(first, scratch.unit_columns(rows));
        let place = Place {
            first_row: (replicate * design.points_per_replicate() + first) * design.rows_per_point(),
            sampled: (SAMPLE / design.settings().replicates).max(1).saturating_sub(first) as usize,
        };
        let totals = scratch.evaluate(self.job, place, &|runs, failed| self.report(runs, failed));
        idle().push(scratch);
        totals
    }

    fn report(&self, runs: u64, failed: u64) {
        let done = self.done.fetch_add(runs, Ordering::Relaxed) + runs;
        let failed = self.failed.fetch_add(failed, Ordering::Relaxed) + failed;
        (self.on_progress)(Progress { done, total: self.job.design.rows(), failed, elapsed: self.start.elapsed() });
    }
}

#[cfg(test)]
mod tests;
