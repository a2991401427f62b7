//! Trajectories through a model: blocks of them on a thread pool, each to its elementary effects.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::points::{Move, Trajectories};
use super::{ScreeningError, ScreeningJob};
use crate::model::{Batch, RowFailure};
use crate::run::{Crew, Halt, Progress, RunError, threads_in_force};
use crate::space::Factor;

/// What became of some trajectories.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    /// For each output, factor by factor within each trajectory: the effect in SI units, NaN where there is none.
    pub effects: Vec<Vec<f64>>,
    /// For each factor: steps that did not change its value.
    pub idle: Vec<u64>,
    /// For each output and reason: the failed runs, and the first one's factor values in SI units.
    pub failures: BTreeMap<(usize, RowFailure), (u64, Vec<f64>)>,
    /// Runs that failed in at least one output.
    pub failed: u64,
    /// For each validity flag: runs that raised it.
    pub flags: Vec<u64>,
}

/// Runs `trajectories` of them on as many threads as are asked for (0: one per core), until `stop` is set. The outcome does not depend on the number of
/// threads, in any bit.
pub(super) fn run(
    job: ScreeningJob<'_>,
    (points, trajectories): (&Trajectories, u64),
    (asked, stop): (usize, Option<&AtomicBool>),
    on_progress: &(dyn Fn(Progress) + Sync),
) -> Result<Outcome, ScreeningError> {
    let threads = threads_in_force(asked);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|source| RunError::Threads { threads, source })?;
    let rows = job.space.factors().len() + 1;
    // Whole trajectories, and one at least.
    let block = (Crew::rows_at_once(job.model) / rows).max(1) as u64;
    let start = Instant::now();
    let total = trajectories * rows as u64;
    let (done, failed) = (AtomicU64::new(0), AtomicU64::new(0));
    let one = |bench: &mut Bench<'_>, number: u64| {
        let first = number * block;
        let last = (first + block).min(trajectories);
        let outcome = bench.block(job, points, first..last)?;
        let runs = (last - first) * rows as u64;
        let done = done.fetch_add(runs, Ordering::Relaxed) + runs;
        let failed = failed.fetch_add(outcome.failed, Ordering::Relaxed) + outcome.failed;
        on_progress(Progress { done, recalled: 0, total, failed, elapsed: start.elapsed() });
        Ok(outcome)
    };
    let blocks = trajectories.div_ceil(block);
    let outcomes: Result<Vec<Outcome>, Halt> = if job.model.concurrency().is_some() {
        // Its workers share out the rows of every block among them.
        let mut bench = Bench::new(job, rows, stop);
        bench.crew = bench.crew.at_most(asked);
        (0..blocks).map(|number| one(&mut bench, number)).collect()
    } else {
        pool.install(|| (0..blocks).into_par_iter().map_init(|| Bench::new(job, rows, stop), one).collect())
    };
    let outcomes = outcomes.map_err(|halt| match halt {
        Halt::GaveUp(reason) => RunError::GaveUp { reason },
        Halt::Interrupted => RunError::Interrupted { done: done.load(Ordering::Relaxed), total },
    })?;
    let mut whole = Outcome::of(job);
    outcomes.into_iter().for_each(|outcome| whole.append(outcome));
    Ok(whole)
}

/// What a thread needs to evaluate blocks.
struct Bench<'a> {
    crew: Crew<'a>,
    batch: Batch,
    columns: Vec<Vec<f64>>,
    rows: usize,
}

impl<'a> Bench<'a> {
    fn new(job: ScreeningJob<'a>, rows: usize, stop: Option<&'a AtomicBool>) -> Self {
        let columns = vec![Vec::new(); job.space.factors().len()];
        Self { crew: Crew::new(job.model, stop), batch: Batch::of(job.model), columns, rows }
    }

    fn block(
        &mut self,
        job: ScreeningJob<'_>,
        points: &Trajectories,
        numbers: std::ops::Range<u64>,
    ) -> Result<Outcome, Halt> {
        let mut outcome = Outcome::of(job);
        let moves: Vec<Vec<Move>> = numbers.map(|number| points.moves(number)).collect();
        let rows = self.rows * moves.len();
        for (j, (column, factor)) in self.columns.iter_mut().zip(job.space.factors()).enumerate() {
            column.resize(rows, 0.0);
            for (moves, column) in moves.iter().zip(column.chunks_exact_mut(self.rows)) {
                let values = values_at(factor, &moves[j].u);
                outcome.idle[j] += u64::from(values[0] == values[1]);
                points.fill(&moves[j], values, column);
            }
        }
        self.batch.reset(rows);
        let inputs: Vec<&[f64]> = self.columns.iter().map(Vec::as_slice).collect();
        self.crew.run(&inputs, &mut self.batch)?;
        for (output, effects) in outcome.effects.iter_mut().enumerate() {
            let values = self.batch.column(output).chunks_exact(self.rows);
            for (moves, values) in moves.iter().zip(values) {
                effects.extend(moves.iter().map(|a_move| effect(a_move, values)));
            }
        }
        outcome.note(&self.batch, &inputs);
        Ok(outcome)
    }
}

/// The SI values at two coordinates. Quantiles are for the open interval: its ends are those of the range itself.
fn values_at(factor: &Factor, u: &[f64; 2]) -> [f64; 2] {
    let mut values = [0.0; 2];
    factor.fill_si(u, &mut values);
    let (low, high) = factor.distribution().support();
    for (value, u) in values.iter_mut().zip(u) {
        match u {
            0.0 => *value = factor.unit().to_si(low),
            1.0 => *value = factor.unit().to_si(high),
            _ => (),
        }
    }
    values
}

/// The difference of the output by the step; NaN where a run failed or the quotient overflows.
fn effect(Move { step, rows: [before, after], .. }: &Move, values: &[f64]) -> f64 {
    let effect = (values[*after] - values[*before]) / step;
    if effect.is_finite() { effect } else { f64::NAN }
}

impl Outcome {
    fn of(job: ScreeningJob<'_>) -> Self {
        Self {
            effects: vec![Vec::new(); job.model.outputs().len()],
            idle: vec![0; job.space.factors().len()],
            flags: vec![0; job.model.flags().len()],
            ..Self::default()
        }
    }

    /// Takes note of the failures and flags of a settled batch.
    fn note(&mut self, batch: &Batch, inputs: &[&[f64]]) {
        let mut failed: Vec<usize> = Vec::with_capacity(batch.failures().len());
        for (output, row, reason) in batch.failures() {
            failed.push(*row);
            let values = || inputs.iter().map(|column| column[*row]).collect();
            self.failures.entry((*output, reason.clone())).or_insert_with(|| (0, values())).0 += 1;
        }
        failed.sort_unstable();
        failed.dedup();
        self.failed += failed.len() as u64;
        add(&mut self.flags, batch.flags());
    }

    /// Adds what became of the next trajectories.
    fn append(&mut self, next: Self) {
        for (mine, theirs) in self.effects.iter_mut().zip(next.effects) {
            mine.extend(theirs);
        }
        for (key, (count, first)) in next.failures {
            self.failures.entry(key).or_insert((0, first)).0 += count;
        }
        self.failed += next.failed;
        add(&mut self.idle, &next.idle);
        add(&mut self.flags, &next.flags);
    }
}

fn add(mine: &mut [u64], theirs: &[u64]) {
    for (mine, theirs) in mine.iter_mut().zip(theirs) {
        *mine += theirs;
    }
}
