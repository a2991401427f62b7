//! Rows that are run again, to check that the model is reproducible.

use super::shard::quotient;
use super::{Job, RowValues, RunError, Store};
use crate::design::Design;
use crate::model::{Batch, RunContext};
use crate::result::{Irreproducible, Warning};

/// One in this many runs is repeated, up to the maximum number of rows.
const RUNS_PER_REPEAT: u64 = 100;
const MAX_ROWS: u64 = 16;
/// Studies with fewer runs repeat none.
const MIN_RUNS: u64 = 50;

/// Relative difference up to which outputs are equal: sums in another order differ in their last digits.
const ROUNDING: f64 = 1e-9;

/// The results of repeated rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Repeats {
    /// Number of repeated rows.
    pub rows: u64,
    /// Number of them with a different output, by output.
    pub differing: Vec<u64>,
    /// The cause, if any differed.
    pub cause: Option<Irreproducible>,
}

impl Repeats {
    /// Returns a warning about an output of which `differing` rows changed; `None` if none changed. `has_noise` is whether
    /// the model gets a seed with every row.
    pub fn warning(&self, differing: u64, has_noise: bool) -> Option<Warning> {
        let cause = self.cause.filter(|_| differing > 0)?;
        Some(Warning::Irreproducible { differing, rows: self.rows, cause, has_noise })
    }
}

/// Returns the rows that a run of `evaluated` runs of `design` repeats, as (replicate, row): a function of these alone.
fn rows_to_repeat(design: &Design, evaluated: u64) -> Vec<(u64, u64)> {
    if evaluated < MIN_RUNS {
        return Vec::new();
    }
    let count = (evaluated / RUNS_PER_REPEAT).clamp(1, MAX_ROWS);
    let rows_per_replicate = design.points_per_replicate() * design.rows_per_point();
    let rows = rows_per_replicate * design.settings().replicates;
    let spread = (0..count).map(|number| quotient(2 * number + 1, rows, 2 * count));
    spread.map(|row| (row / rows_per_replicate, row % rows_per_replicate)).collect()
}

/// Runs some rows of a run of `evaluated` rows again on a new worker, if its model may be random, and compares their
/// outputs with those in `store`, or with those of another new worker if some are missing there. Returns `None` if the
/// model no longer responds, which does not cost the result.
pub(crate) fn repeat_rows(
    job: Job<'_>,
    context: &RunContext<'_>,
    evaluated: u64,
    store: Option<&Store>,
) -> Option<Repeats> {
    let rows = rows_to_repeat(job.design, evaluated);
    if !job.model.may_be_random() || rows.is_empty() {
        return None;
    }
    let first = match store.and_then(|store| stored_outputs(store, &rows)) {
        Some(outputs) => outputs,
        None => outputs_of(job, context, &rows).ok()?,
    };
    compare(job, context, &rows, &first).ok()
}

/// Returns the outputs of rows in `store`; `None` if one is missing.
fn stored_outputs(store: &Store, rows: &[(u64, u64)]) -> Option<Vec<Vec<f64>>> {
    rows.iter().map(|(replicate, row)| Some(store.block(*replicate, *row..*row + 1)?.values)).collect()
}

/// Runs `rows` again on a new worker, and compares their outputs with those `before`.
///
/// # Errors
/// [`RunError`] if the model gives up or the run of `context` is to stop.
pub(super) fn compare(
    job: Job<'_>,
    context: &RunContext<'_>,
    rows: &[(u64, u64)],
    before: &[Vec<f64>],
) -> Result<Repeats, RunError> {
    // In another order: the output of a row must not depend on its position.
    let backwards: Vec<(u64, u64)> = rows.iter().rev().copied().collect();
    let second = outputs_of(job, context, &backwards)?;
    let mut differing = vec![0; job.model.outputs().len()];
    for (outputs, others) in before.iter().zip(second.iter().rev()) {
        for (count, (a, b)) in differing.iter_mut().zip(outputs.iter().zip(others)) {
            *count += u64::from(!is_same(*a, *b));
        }
    }
    let mut repeats = Repeats { rows: rows.len() as u64, differing, cause: None };
    if repeats.differing.iter().any(|count| *count > 0) {
        let third = outputs_of(job, context, &backwards)?;
        let is_repeated = second.iter().flatten().zip(third.iter().flatten()).all(|(a, b)| is_same(*a, *b));
        repeats.cause = Some(if is_repeated { Irreproducible::Remembers } else { Irreproducible::Random });
    }
    Ok(repeats)
}

/// Returns whether two outputs are equal within rounding; missing values count as equal.
fn is_same(a: f64, b: f64) -> bool {
    !a.is_finite() || !b.is_finite() || (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}

/// Returns the outputs of rows evaluated by a new worker.
fn outputs_of(job: Job<'_>, context: &RunContext<'_>, rows: &[(u64, u64)]) -> Result<Vec<Vec<f64>>, RunError> {
    let mut inputs = vec![Vec::with_capacity(rows.len()); job.design.factors()];
    let mut values = RowValues::default();
    for (replicate, row) in rows {
        let of_row = values.values(job.space, job.design, *replicate, *row..*row + 1);
        for (column, value) in inputs.iter_mut().zip(of_row) {
            column.extend_from_slice(value);
        }
    }
    let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let mut batch = Batch::new(job.model);
    batch.reset(rows.len());
    job.model.worker(context).run(&inputs, &mut batch);
    if let Some(give_up) = batch.given_up() {
        return Err(RunError::GaveUp(give_up.clone()));
    }
    Ok((0..rows.len()).map(|row| (0..batch.outputs()).map(|output| batch.column(output)[row]).collect()).collect())
}
