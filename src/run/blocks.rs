//! Blocks of base points as a task: unit cube to SI values, rows to outputs, outputs to totals, totals into the tree.

use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::executor::{Evaluated, Finished, LOOK, Task};
use super::fold::{Fold, merged};
use super::journal::Checkpoint;
use super::totals::{OutputTotals, Place, SAMPLE, Tally, Totals};
use super::{BLOCK, FailurePolicy, Job, RunError, Store};
use crate::design::{BasePoints, Matrix};
use crate::estimate::{BlockOutputs, CentralMoments, MomentParts, Moments, PointOutputs, Workspace, part_length};
use crate::model::{Batch, RowFailure, RunContext, Standing, Worker};

/// Time between checkpoints: a share of what the run has taken, within bounds.
const CHECKPOINT_SHARE: u32 = 4;
const LEAST_INTERVAL: Duration = Duration::from_millis(200);
const MOST_INTERVAL: Duration = Duration::from_secs(3);

/// The base points of every replicate up to `end`, from where a fold stands.
pub(super) struct Blocks<'a> {
    job: Job<'a>,
    context: &'a RunContext<'a>,
    /// Where the replicates lie in the unit cube.
    points: Vec<BasePoints>,
    range: Range<u64>,
    failures: FailurePolicy,
    keeps_outputs: bool,
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
    /// Blocks that were taken and are not in the fold yet.
    in_flight: usize,
    /// Whether no block is given out until all are in the fold, for a checkpoint.
    is_pausing: bool,
    is_writing: bool,
    started: Instant,
    written: Instant,
}

/// A block of one replicate, counted from the first of the task.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    replicate: usize,
    number: u64,
    first: u64,
    points: u64,
}

/// How the outputs of blocks are treated.
#[derive(Clone, Copy)]
pub(super) struct BlockOptions<'a> {
    pub failures: FailurePolicy,
    pub keeps_outputs: bool,
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
        let (next, now) = ((first, 0), Instant::now());
        let (is_pausing, is_writing) = (false, false);
        let state = State { fold, next, in_flight: 0, is_pausing, is_writing, started: now, written: now };
        let BlockOptions { failures, keeps_outputs, store, checkpoint } = options;
        let (state, settled) = (Mutex::new(state), Condvar::new());
        Self { job, context, points, range, failures, keeps_outputs, store, checkpoint, state, settled }
    }

    /// The fold, with all blocks that were finished.
    pub fn into_fold(self) -> Fold {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).fold
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A thread that panicked has ended the run.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The block of that number, if it is one.
    fn block(&self, number: u64, replicate: usize) -> Option<Block> {
        let place = self.range.start / BLOCK + number;
        let first = (place * BLOCK).max(self.range.start);
        let end = ((place + 1) * BLOCK).min(self.range.end);
        (first < end).then(|| Block { replicate, number, first, points: end - first })
    }

    /// Whether a block ends before its time, at the end of the run.
    fn is_tail(&self, block: &Block) -> bool {
        !(block.first + block.points).is_multiple_of(BLOCK)
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
    type Piece = Block;
    type Output = Totals;
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::new(self.job)
    }

    fn next(&self, _: u64, _: usize) -> Option<Block> {
        let mut state = self.state();
        while state.is_pausing {
            if self.context.is_stopped() {
                return None;
            }
            state = self.settled.wait_timeout(state, LOOK).unwrap_or_else(PoisonError::into_inner).0;
        }
        // Block by block through the replicates: where a run stops, they are equally long.
        loop {
            let (number, replicate) = state.next;
            let block = self.block(number, replicate)?;
            state.next = if replicate + 1 < self.points.len() { (number, replicate + 1) } else { (number + 1, 0) };
            if number >= state.fold.blocks(replicate) || self.is_tail(&block) {
                state.in_flight += 1;
                return Some(block);
            }
        }
    }

    fn rows(&self, block: &Block) -> u64 {
        block.points * self.job.design.rows_per_point()
    }

    fn evaluate(
        &self,
        worker: &mut dyn Worker,
        scratch: &mut Scratch,
        block: &Block,
        on_rows: &dyn Fn(u64),
    ) -> Evaluated<Totals> {
        let replicate = block.replicate as u64;
        let sample = (SAMPLE / self.job.design.settings().replicates).max(1);
        let place = BlockPlace {
            first: Place { replicate, point: block.first, run: 0 },
            part_length: part_length(block.first / BLOCK, BLOCK),
            sampled: sample.saturating_sub(block.first) as usize,
            keeps_outputs: self.keeps_outputs,
        };
        let standing = Standing::Final;
        let recalled = self.store.is_some_and(|store| scratch.recall(store, place, block.points as usize));
        if !recalled {
            self.points[block.replicate].fill(block.first, scratch.unit_columns(block.points as usize));
            let given_up = scratch.run_rows(self.job, (worker, self.context), on_rows);
            if given_up.is_some() {
                return Evaluated { output: None, standing, given_up, is_urgent: false };
            }
        }
        let output = Some(scratch.totals(self.job, place));
        Evaluated { output, standing, given_up: None, is_urgent: false }
    }

    fn accept(&self, block: &Block, mut totals: Totals) -> Result<Finished, RunError> {
        let finished = Finished { rows: totals.runs, failed: totals.failed_runs };
        if self.failures == FailurePolicy::Fail
            && let Some((row, reason)) = totals.first_failure()
        {
            return Err(RunError::RowFailed { row, reason });
        }
        let replicate = block.replicate;
        if self.is_tail(block) {
            let mut state = self.state();
            state.fold.put_tail(replicate, totals);
            state.in_flight -= 1;
            return self.write_if_due(state).map(|()| finished);
        }
        let (mut first, mut blocks) = (block.number, 1);
        loop {
            let mut state = self.state();
            // Branches are merged while other threads go on.
            let Some((other, sibling)) = state.fold.take_sibling(replicate, first, blocks) else {
                state.fold.put(replicate, first, blocks, totals);
                state.in_flight -= 1;
                return self.write_if_due(state).map(|()| finished);
            };
            drop(state);
            totals = merged((first, totals), (other, sibling));
            (first, blocks) = (first.min(other), 2 * blocks);
        }
    }
}

/// What a thread needs to evaluate blocks, kept from block to block.
pub(super) struct Scratch {
    /// The columns of the base points, in the unit cube.
    unit: Vec<Vec<f64>>,
    /// The same in SI units.
    values: Vec<Vec<f64>>,
    /// Outputs of every run of the design.
    batches: Vec<Batch>,
    workspace: Workspace,
}

impl Scratch {
    fn new(job: Job<'_>) -> Self {
        let (columns, runs) = (job.design.columns(), job.design.runs().len());
        Self {
            unit: vec![Vec::new(); columns],
            values: vec![Vec::new(); columns],
            batches: vec![Batch::new(job.model); runs],
            workspace: Workspace::default(),
        }
    }

    /// The unit-cube columns for `rows` base points, to be filled.
    fn unit_columns(&mut self, rows: usize) -> &mut [Vec<f64>] {
        for column in &mut self.unit {
            column.resize(rows, 0.0);
        }
        &mut self.unit
    }

    /// Sets the outputs of `points` base points at `place` to those in `store`; false if a row is missing there.
    fn recall(&mut self, store: &Store, place: BlockPlace, points: usize) -> bool {
        self.batches.iter_mut().for_each(|batch| batch.reset(points));
        store.recall(place.first.replicate, place.first.point, &mut self.batches)
    }

    /// The totals of the outputs that were evaluated or recalled last.
    fn totals(&mut self, job: Job<'_>, place: BlockPlace) -> Totals {
        let rows = self.batches.first().map_or(0, Batch::rows);
        let mut totals = Totals {
            runs: (rows * self.batches.len()) as u64,
            failed_runs: self.batches.iter().map(failed_rows).sum(),
            ..Totals::none(job.model)
        };
        for batch in &self.batches {
            totals.counts.merge(batch.counts());
            for (total, raised) in totals.flags.iter_mut().zip(batch.flags()) {
                *total += raised;
            }
        }
        for (output, of_output) in totals.outputs.iter_mut().enumerate() {
            *of_output = self.totals_of(job, output, place);
        }
        totals
    }

    /// Evaluates the base points in the unit columns; `on_rows` is told of every batch. Returns why the model gave up, if
    /// it did.
    fn run_rows(
        &mut self,
        job: Job<'_>,
        (worker, context): (&mut dyn Worker, &RunContext<'_>),
        on_rows: &dyn Fn(u64),
    ) -> Option<RowFailure> {
        let factors = job.design.factors();
        for (k, (unit, values)) in self.unit.iter().zip(&mut self.values).enumerate() {
            values.resize(unit.len(), 0.0);
            job.space.factors()[k % factors].fill_si(unit, values);
        }
        let values = &self.values;
        let columns_of = |matrix: Matrix| &values[job.design.first_column(matrix)..][..factors];
        let mut inputs: Vec<&[f64]> = Vec::with_capacity(factors);
        for (run, batch) in job.design.runs().iter().zip(&mut self.batches) {
            if context.is_stopped() {
                return Some(RowFailure::interrupted());
            }
            inputs.clear();
            inputs.extend(columns_of(run.base).iter().map(Vec::as_slice));
            for &column in &run.columns {
                inputs[column] = &columns_of(run.from)[column];
            }
            batch.reset(inputs[0].len());
            worker.run(&inputs, batch);
            batch.settle();
            if let Some(reason) = batch.given_up() {
                return Some(reason.clone());
            }
            on_rows(batch.rows() as u64);
        }
        None
    }

    fn totals_of(&mut self, job: Job<'_>, output: usize, place: BlockPlace) -> OutputTotals {
        let design = job.design;
        let mut totals = OutputTotals::default();
        for (run, batch) in self.batches.iter_mut().enumerate() {
            let failures = batch.failures().iter().filter(|(o, _, _)| *o == output).map(|(_, row, why)| (*row, why));
            let failed: Vec<usize> = failures.clone().map(|(row, _)| row).collect();
            for (row, failure) in failures {
                let first = Place { point: place.first.point + row as u64, run: run as u64, ..place.first };
                totals.runs_failed += 1;
                totals.count(failure.clone(), Tally { count: 1, first });
            }
            // Whatever the model left there: it says that it failed.
            for row in failed {
                batch.set(row, output, f64::NAN);
            }
        }
        let column = |run: &usize| self.batches[*run].column(output);
        let columns = |runs: &[usize]| runs.iter().map(column).collect::<Vec<&[f64]>>();
        let (a, b) = (column(&0), column(&1));
        let (ab, ba) = (columns(design.ab_runs()), columns(design.ba_runs()));
        let (bc, cb) = (columns(design.bc_runs()), columns(design.cb_runs()));
        let length = place.part_length as usize;
        let mut parts = Vec::with_capacity(a.len().div_ceil(length));
        let mut cut: [Vec<&[f64]>; 4] = Default::default();
        for first in (0..a.len()).step_by(length) {
            let part = first..(first + length).min(a.len());
            for (cut, whole) in cut.iter_mut().zip([&ab, &ba, &bc, &cb]) {
                cut.clear();
                cut.extend(whole.iter().map(|column| &column[part.clone()]));
            }
            let [ab, ba, bc, cb] = cut.each_ref().map(Vec::as_slice);
            let outputs =
                BlockOutputs { a: &a[part.clone()], b: &b[part.clone()], ab, ba, bc, cb, paired: design.paired() };
            parts.push(Moments::of_block(outputs, &mut self.workspace));
        }
        if place.keeps_outputs {
            let runs: Vec<&[f64]> = self.batches.iter().map(|batch| batch.column(output)).collect();
            totals.point_outputs = PointOutputs::of_block(&runs);
        }
        totals.moments = MomentParts::new(place.part_length, a.len() as u64, parts);
        totals.values = CentralMoments::of(a);
        totals.values.merge(&CentralMoments::of(b));
        totals.sample = a.iter().zip(b).take(place.sampled).flat_map(|(a, b)| [*a, *b]).collect();
        totals
    }
}

/// Where a block lies in its design, and what is kept of it.
#[derive(Debug, Clone, Copy)]
struct BlockPlace {
    /// The first base point's A.
    first: Place,
    /// Base points in each part whose moments are kept apart, a power of two.
    part_length: u64,
    /// How many of its base points, from the first on, belong to the sample.
    sampled: usize,
    /// Whether all outputs are kept.
    keeps_outputs: bool,
}

/// Rows of a settled batch with at least one failure.
fn failed_rows(batch: &Batch) -> u64 {
    let mut rows: Vec<usize> = batch.failures().iter().map(|&(_, row, _)| row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.len() as u64
}
