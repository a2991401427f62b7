//! Pilot runs, which predict how long a design will take.

use std::time::Instant;

use super::repeats::compare;
use super::{Job, Repeats, RowValues, RunError, failed_rows, threads_in_force};
use crate::model::{Batch, RunContext};

/// A few runs of a design, and the predicted time of the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Pilot {
    /// Number of pilot runs.
    pub runs: u64,
    /// Predicted seconds for the whole design, startup included.
    pub seconds: f64,
    /// Seconds that a worker takes before its first run; 0 if it needs none.
    pub startup: f64,
    /// Result of running the first row again on a new worker; `None` for models known to be deterministic.
    pub repeats: Option<Repeats>,
    /// Pilot runs that failed in some output.
    pub failed: u64,
    /// Why the first of them failed.
    pub reason: Option<String>,
}

impl Pilot {
    /// Runs a growing number of first rows on one worker until they take long enough to be measured, or are a whole
    /// replicate. The startup time is the extra time of the first row compared with the same row run once more.
    ///
    /// # Errors
    /// [`RunError`] if the model gives up or the run of `context` is to stop.
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
            // The last batch contains all rows, so its failures replace earlier ones.
            failed = failed_rows(&batch);
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
