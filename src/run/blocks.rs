//! Blocks of base points as a task: unit cube to SI values, rows to outputs, outputs to totals, totals into the tree.

use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::failures::Place;
use super::fold::{Branch, Fold, append, merged};
use super::journal::Checkpoint;
use super::remote::{Abroad, DesignKey, Errand};
use super::scratch::{BlockPlace, Scratch};
use super::task::{Evaluated, Finished, Task};
use super::totals::{SAMPLE, Totals};
use super::{BLOCK, FailurePolicy, Job, LOOK, RunError, Store};
use crate::binary::{Binary, Reader, binary_fields};
use crate::clock::Instant;
use crate::design::BasePoints;
use crate::estimate::{PointOutputs, part_length};
use crate::model::{RunContext, Worker};

/// Time between checkpoints: a share of what the run has taken, within bounds.
const CHECKPOINT_SHARE: u32 = 4;
const LEAST_INTERVAL: Duration = Duration::from_millis(200);
const MOST_INTERVAL: Duration = Duration::from_secs(3);

/// Most rows of a strip, and of one whose outputs are kept.
const MOST_ROWS: u64 = 1 << 40;
const MOST_KEPT_ROWS: u64 = 1 << 17;

/// The base points of every replicate up to `end`, from where a fold stands.
pub(super) struct Blocks<'a> {
    job: Job<'a>,
    context: &'a RunContext<'a>,
    /// Where the replicates lie in the unit cube.
    points: Vec<BasePoints>,
    range: Range<u64>,
    failures: FailurePolicy,
    keeps_outputs: bool,
    /// Whether blocks are given out in strips, for workers that are far away.
    in_strips: bool,
    /// Outputs that are known.
    store: Option<&'a Store>,
    checkpoint: Option<&'a Checkpoint>,
    state: Mutex<State>,
    settled: Condvar,
}

struct State {
    fold: Fold,
    /// The next block: its number, and its replicate.
    next: (u64, usize),
    /// Where the strip of blocks ends that every replicate gives out in turn.
    strip_end: u64,
    /// Blocks that were taken and are not in the fold yet; of strips, those that are on their way into it.
    in_flight: usize,
    /// Whether no block is given out until all are in the fold, for a checkpoint; of strips, none is taken in.
    is_pausing: bool,
    is_writing: bool,
    started: Instant,
    written: Instant,
}

/// Consecutive blocks of one replicate, counted from the first of the task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Strip {
    pub replicate: usize,
    pub number: u64,
    pub blocks: u64,
}

binary_fields!(Strip { replicate, number, blocks });

/// How the outputs of blocks are treated.
#[derive(Clone, Copy)]
pub(super) struct BlockOptions<'a> {
    pub failures: FailurePolicy,
    pub keeps_outputs: bool,
    /// Whether blocks are given out in strips, for workers that are far away. A checkpoint then does not wait for them: it
    /// holds the blocks before the first one that is still away.
    pub in_strips: bool,
    /// Outputs that are known.
    pub store: Option<&'a Store>,
    /// Where sums are recorded from time to time.
    pub checkpoint: Option<&'a Checkpoint>,
}

impl<'a> Blocks<'a> {
    /// The blocks that `fold` lacks of the base points before `end` of every replicate.
    pub fn new(job: Job<'a>, context: &'a RunContext<'a>, fold: Fold, end: u64, options: BlockOptions<'a>) -> Self {
        let replicates = job.design.settings().replicates;
        let points = (0..replicates).map(|replicate| job.design.replicate(replicate)).collect();
        let range = fold.from()..end;
        let first = (0..replicates as usize).map(|replicate| fold.blocks(replicate)).min().unwrap_or(0);
        let (next, strip_end, now) = ((first, 0), first, Instant::now());
        let (is_pausing, is_writing) = (false, false);
        let state = State { fold, next, strip_end, in_flight: 0, is_pausing, is_writing, started: now, written: now };
        let BlockOptions { failures, keeps_outputs, in_strips, store, checkpoint } = options;
        let (state, settled) = (Mutex::new(state), Condvar::new());
        Self { job, context, points, range, failures, keeps_outputs, in_strips, store, checkpoint, state, settled }
    }

    /// The fold, with all blocks that were finished.
    pub fn into_fold(self) -> Fold {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).fold
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A thread that panicked has ended the run.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The base points of the block of that number, if it is one.
    fn block(&self, number: u64) -> Option<Range<u64>> {
        let place = self.range.start / BLOCK + number;
        let points = (place * BLOCK).max(self.range.start)..((place + 1) * BLOCK).min(self.range.end);
        (!points.is_empty()).then_some(points)
    }

    /// Blocks before the one that ends before its time, at the end of the run, if there is one.
    fn whole_blocks(&self) -> u64 {
        self.range.end / BLOCK - self.range.start / BLOCK
    }

    /// Whether a strip is the block that ends before its time.
    fn is_tail(&self, strip: &Strip) -> bool {
        strip.number >= self.whole_blocks()
    }

    /// Where a strip of best `most` rows for one of `workers` workers ends that begins with block `number`.
    fn strip_end(&self, number: u64, most: u64, workers: usize) -> u64 {
        let whole = self.whole_blocks();
        if !self.in_strips || number >= whole {
            return number + 1;
        }
        let replicates = self.points.len() as u64;
        let share = (whole - number) * replicates / (2 * workers as u64);
        let blocks = (most / (BLOCK * self.job.design.rows_per_point())).min(share).max(1);
        // From one multiple of a power of two to the next the strip is one branch of the tree.
        let width = 1 << blocks.ilog2();
        ((number / width + 1) * width).min(whole)
    }

    /// Waits until no checkpoint is about to be taken; `None` if the run is to end first.
    fn unless_pausing(&self) -> Option<MutexGuard<'_, State>> {
        let mut state = self.state();
        while state.is_pausing {
            if self.context.is_stopped() {
                return None;
            }
            state = self.settled.wait_timeout(state, LOOK).unwrap_or_else(PoisonError::into_inner).0;
        }
        Some(state)
    }

    /// Puts a branch into the tree.
    fn put(&self, replicate: usize, branch: Branch) {
        let Branch { mut first, mut blocks, mut totals } = branch;
        loop {
            let mut state = self.state();
            // Branches are merged while other threads go on.
            let Some((other, sibling)) = state.fold.take_sibling(replicate, first, blocks) else {
                return state.fold.put(replicate, first, blocks, totals);
            };
            drop(state);
            totals = merged((first, totals), (other, sibling));
            (first, blocks) = (first.min(other), 2 * blocks);
        }
    }

    /// Writes a checkpoint if it is time for one and nothing is under way.
    fn write_if_due(&self, mut state: MutexGuard<'_, State>) -> Result<(), RunError> {
        let Some(checkpoint) = self.checkpoint else { return Ok(()) };
        let interval = (state.started.elapsed() / CHECKPOINT_SHARE).clamp(LEAST_INTERVAL, MOST_INTERVAL);
        state.is_pausing |= !state.is_writing && state.written.elapsed() >= interval;
        if !state.is_pausing || state.in_flight > 0 {
            return Ok(());
        }
        let mut sums = Vec::new();
        state.fold.write_sums(&mut sums);
        (state.is_pausing, state.is_writing) = (false, true);
        self.settled.notify_all();
        drop(state);
        let written = checkpoint.write(&sums).map_err(|source| RunError::NotKept { source });
        let mut state = self.state();
        (state.is_writing, state.written) = (false, Instant::now());
        written
    }
}

impl Task for Blocks<'_> {
    type Piece = Strip;
    type Output = Vec<Branch>;
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::new(self.job)
    }

    fn next(&self, most: u64, workers: usize) -> Option<Strip> {
        let mut state = if self.in_strips { self.state() } else { self.unless_pausing()? };
        // Strip by strip through the replicates: where a run stops, they are equally long.
        loop {
            let (number, replicate) = state.next;
            self.block(number)?;
            if replicate == 0 {
                state.strip_end = self.strip_end(number, most, workers);
            }
            let end = state.strip_end;
            state.next = if replicate + 1 < self.points.len() { (number, replicate + 1) } else { (end, 0) };
            let is_tail = number >= self.whole_blocks();
            let number = if is_tail { number } else { number.max(state.fold.blocks(replicate)) };
            if number < end {
                state.in_flight += usize::from(!self.in_strips);
                return Some(Strip { replicate, number, blocks: end - number });
            }
        }
    }

    fn most_rows(&self) -> u64 {
        match (self.in_strips, self.keeps_outputs) {
            (true, false) => MOST_ROWS,
            (true, true) => MOST_KEPT_ROWS,
            (false, _) => 1,
        }
    }

    fn rows(&self, strip: &Strip) -> u64 {
        let first = self.block(strip.number).map_or(0, |points| points.start);
        let end = self.block(strip.number + strip.blocks - 1).map_or(first, |points| points.end);
        (end - first) * self.job.design.rows_per_point()
    }

    fn evaluate(
        &self,
        worker: &mut dyn Worker,
        scratch: &mut Scratch,
        strip: &Strip,
        on_rows: &dyn Fn(u64),
    ) -> Evaluated<Vec<Branch>> {
        let replicate = strip.replicate as u64;
        let sample = (SAMPLE / self.job.design.settings().replicates).max(1);
        let mut branches = Vec::new();
        for number in strip.number..strip.number + strip.blocks {
            let Some(block) = self.block(number) else { continue };
            let points = (block.end - block.start) as usize;
            let place = BlockPlace {
                first: Place { replicate, point: block.start, run: 0 },
                part_length: part_length(block.start / BLOCK, BLOCK),
                sampled: sample.saturating_sub(block.start) as usize,
                keeps_outputs: self.keeps_outputs,
            };
            let recalled = self.store.is_some_and(|store| scratch.recall(store, place, points));
            if !recalled {
                self.points[strip.replicate].fill(block.start, scratch.unit_columns(points));
                let given_up = scratch.run_rows(self.job, worker, self.context, on_rows);
                if given_up.is_some() {
                    return Evaluated { output: None, given_up };
                }
            }
            append(&mut branches, Branch { first: number, blocks: 1, totals: scratch.totals(self.job, place) });
        }
        Evaluated { output: Some(branches), given_up: None }
    }

    fn accept(&self, strip: &Strip, branches: Vec<Branch>) -> Result<Finished, RunError> {
        let mut finished = Finished { rows: 0, failed: 0 };
        for Branch { totals, .. } in &branches {
            finished.rows += totals.runs;
            finished.failed += totals.failed_runs;
            if self.failures == FailurePolicy::Fail
                && let Some((row, reason)) = totals.first_failure()
            {
                return Err(RunError::RowFailed { row, reason });
            }
        }
        if self.in_strips {
            // A run that is to end takes no checkpoint any more.
            let mut state = self.unless_pausing().unwrap_or_else(|| self.state());
            state.in_flight += 1;
        }
        for branch in branches {
            if self.is_tail(strip) {
                self.state().fold.put_tail(strip.replicate, branch.totals);
            } else {
                self.put(strip.replicate, branch);
            }
        }
        let mut state = self.state();
        state.in_flight -= 1;
        self.write_if_due(state).map(|()| finished)
    }

    fn abroad(&self) -> Option<&dyn Abroad<Strip, Vec<Branch>>> {
        self.in_strips.then_some(self)
    }
}

impl Abroad<Strip, Vec<Branch>> for Blocks<'_> {
    fn errand(&self) -> Errand {
        Errand {
            is_of_blocks: true,
            design: DesignKey::new(self.job.design),
            from: self.range.start,
            end: self.range.end,
            keeps_outputs: self.keeps_outputs,
            fails: self.failures == FailurePolicy::Fail,
        }
    }

    fn write_piece(&self, strip: &Strip, out: &mut Vec<u8>) {
        strip.write(out);
    }

    fn read_piece(&self, from: &mut Reader<'_>) -> Option<Strip> {
        let strip = Strip::read(from)?;
        let is_one = strip.replicate < self.points.len() && strip.blocks > 0;
        let last = strip.number.checked_add(strip.blocks)?.checked_sub(1)?;
        (is_one && last <= self.whole_blocks() && self.block(last).is_some()).then_some(strip)
    }

    fn write_output(&self, branches: &Vec<Branch>, out: &mut Vec<u8>) {
        branches.len().write(out);
        for Branch { first, blocks, totals } in branches {
            first.write(out);
            blocks.write(out);
            totals.write(out);
            if self.keeps_outputs {
                totals.outputs.iter().for_each(|output| output.point_outputs.write(out));
            }
        }
    }

    fn read_output(&self, strip: &Strip, from: &mut Reader<'_>) -> Option<Vec<Branch>> {
        let mut branches = Vec::new();
        let mut next = strip.number;
        for _ in 0..u64::read(from)? {
            let (first, blocks, mut totals) = (u64::read(from)?, u64::read(from)?, Totals::read(from)?);
            for output in totals.outputs.iter_mut().filter(|_| self.keeps_outputs) {
                output.point_outputs = PointOutputs::read(from)?;
            }
            if first != next || !totals.fits(self.job.design, self.job.model) {
                return None;
            }
            next = next.checked_add(blocks)?;
            branches.push(Branch { first, blocks, totals });
        }
        (next == strip.number + strip.blocks).then_some(branches)
    }
}
