//! Evaluation of trajectories: blocks of them go to the model's workers, and give elementary effects.

use std::collections::BTreeMap;

use super::points::{Move, Trajectories};
use crate::model::{Batch, RowFailure};
use crate::run::{RunError, TableRun, failed_rows};
use crate::space::{Group, Space};
use apportion_base::sum::mean;

/// The results of some trajectories.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    /// For each output, mover by mover within each trajectory: the effect in SI units, NaN if missing.
    pub effects: Vec<Vec<f64>>,
    /// For each output, row by row within each trajectory: the value in SI units, NaN if missing.
    pub values: Vec<Vec<f64>>,
    /// For each mover: steps that did not change a value.
    pub idle: Vec<u64>,
    /// For each output and reason: the failed runs, and the first one's factor values in SI units.
    pub failures: BTreeMap<(usize, RowFailure), (u64, Vec<f64>)>,
    /// Number of runs that failed in at least one output.
    pub failed: u64,
    /// For each validity flag: runs that raised it.
    pub flags: Vec<u64>,
}

/// Evaluates `trajectories` of them by `run`. The outcome has the same bits on any number of threads.
pub(super) fn run(
    space: &Space,
    points: &Trajectories,
    trajectories: u64,
    run: &TableRun<'_>,
) -> Result<Outcome, RunError> {
    let (factors, model) = (space.factors(), run.model());
    let (movers, rows) = (&points.movers, points.rows());
    // Whole trajectories, at least one.
    let block = (run.rows_at_once() / rows).max(1) as u64;
    let mut batch = Batch::new(model);
    let mut outcome = Outcome {
        effects: vec![Vec::new(); model.outputs().len()],
        values: vec![Vec::new(); model.outputs().len()],
        idle: vec![0; movers.len()],
        flags: vec![0; model.flags().len()],
        ..Outcome::default()
    };
    for first in (0..trajectories).step_by(block as usize) {
        let last = (first + block).min(trajectories);
        let moves: Vec<Vec<Move>> = (first..last).map(|number| points.moves(number)).collect();
        let columns = points.columns(factors, &moves, &mut outcome.idle);
        batch.reset(rows * moves.len());
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        run.run(&inputs, &mut batch)?;
        for (output, (effects, values)) in outcome.effects.iter_mut().zip(&mut outcome.values).enumerate() {
            for (moves, values) in moves.iter().zip(batch.column(output).chunks_exact(rows)) {
                effects.extend(movers.iter().map(|mover| effect(mover, moves, values)));
            }
            values.extend(batch.column(output));
        }
        outcome.note(&batch, &inputs);
    }
    Ok(outcome)
}

/// Returns the difference of the output over the step of a mover, for a group the root mean square of its factors' steps;
/// NaN if a run failed or the quotient overflows.
fn effect(mover: &Group, moves: &[Move], values: &[f64]) -> f64 {
    let Move { step, before, after, .. } = moves[mover.factors[0]];
    let squares = mover.factors.iter().map(|&factor| moves[factor].step * moves[factor].step);
    let step = if mover.factors.len() == 1 { step } else { mean(&squares.collect::<Vec<f64>>()).sqrt() };
    let effect = (values[after] - values[before]) / step;
    if effect.is_finite() { effect } else { f64::NAN }
}

impl Outcome {
    /// Records the failures and flags of a settled batch.
    fn note(&mut self, batch: &Batch, inputs: &[&[f64]]) {
        for (output, row, reason) in batch.failures() {
            let entry = self.failures.entry((*output, reason.clone()));
            entry.or_insert_with(|| (0, inputs.iter().map(|column| column[*row]).collect())).0 += 1;
        }
        self.failed += failed_rows(batch);
        for (sum, raised) in self.flags.iter_mut().zip(batch.flags()) {
            *sum += raised;
        }
    }
}
