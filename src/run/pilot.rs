//! How long the runs of a design will take, by a few of them.

use std::collections::BTreeSet;
use std::time::Instant;

use super::repeats::compare;
use super::{Job, Repeats, RowValues, RunError, threads_in_force};
use crate::model::{Batch, RunContext};

/// A few runs of a design, and how long the whole of it would take by them.
#[derive(Debug, Clone, PartialEq)]
pub struct Pilot {
    /// Runs it took.
    pub runs: u64,
    /// Seconds that the whole design will take, the start included.
    pub seconds: f64,
    /// Seconds that a worker takes before its first run, where it takes any.
    pub startup: f64,
    /// What the first row says of the model, run once more by a new worker; `None` of models that are known to be no random ones.
    pub repeats: Option<Repeats>,
    /// Runs that failed in some output.
    pub failed: u64,
    /// Why the first of them did.
    pub reason: Option<String>,
}

impl Pilot {
    /// Runs ever more first rows of the design by one worker until they take long enough to be measured, or are all of a
    /// replicate. What the first row takes longer than the same row once more is the start.
    ///
    /// # Errors
    /// [`RunError`] if the model gives up or the run of `context` is to end.
    pub fn new(job: Job<'_>, context: &RunContext<'_>) -> Result<Self, RunError> {
        const MIN_SECONDS: f64 = 0.3;
        const MAX_ROWS: u64 = 1 << 18;
        let Job { design, model, .. } = job;
        let (mut worker, mut batch, mut values) = (model.worker(context), Batch::new(model), RowValues::default());
        let (mut failed, mut reason, mut first_row) = (0, None, Vec::new());
        let mut timed = |rows: u64| {
            let columns = values.values(job.space, design, 0, 0..rows);
            let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            batch.reset(rows as usize);
            let start = Instant::now();
            worker.run(&inputs, &mut batch);
            let seconds = start.elapsed().as_secs_f64();
            batch.settle();
            // Every batch begins with the first row.
            first_row = (0..batch.outputs()).map(|output| batch.column(output)[0]).collect();
            // So that the last one has them all.
            let rows: BTreeSet<usize> = batch.failures().iter().map(|(_, row, _)| *row).collect();
            failed = rows.len() as u64;
            reason = batch.failures().first().map(|(.., reason)| reason.to_string());
            batch.given_up().map_or(Ok(seconds), |give_up| Err(RunError::GaveUp(give_up.clone())))
        };
        let first = timed(1)?;
        let rows = design.points_per_replicate() * design.rows_per_point();
        let (mut runs, mut seconds) = (1, timed(1)?);
        let startup = (first - seconds).max(0.0);
        while seconds < MIN_SECONDS && runs < rows.min(MAX_ROWS) {
            runs = (runs * 4).min(rows).min(MAX_ROWS);
            seconds = timed(runs)?;
        }
        let repeats = || compare(job, context, &[(0, 0)], &[first_row]);
        let repeats = model.may_be_random().then(repeats).transpose()?;
        let workers = model.concurrency().unwrap_or_else(|| threads_in_force(0)).max(1);
        let whole = seconds * design.rows() as f64 / runs as f64 / workers as f64;
        Ok(Self { runs, seconds: whole + startup, startup, repeats, failed, reason })
    }
}
