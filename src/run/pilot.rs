//! Pilot runs, which predict how long a design will take.

use super::repeats::compare;
use super::rows::{RowRange, RowWorker};
use super::{Job, Repeats, RunError, failed_rows, threads_in_force};
use crate::model::RunContext;
use crate::study::Study;

/// A few runs of a design, and the predicted time of all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Pilot {
    /// Number of pilot runs.
    pub runs: u64,
    /// Predicted seconds for all rows of the design, startup included.
    pub seconds: f64,
    /// Seconds that a worker takes before its first run; 0 if it needs none.
    pub startup: f64,
    /// Result of running the first row again on a new worker; `None` for deterministic models.
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
    pub fn new(study: &Study, context: &RunContext<'_>) -> Result<Self, RunError> {
        const MIN_SECONDS: f64 = 0.3;
        const MAX_ROWS: u64 = 1 << 18;
        const MAX_NUMBERS: u64 = 1 << 24;
        let (design, space, model) = (study.design(), study.space(), study.model());
        let mut worker = RowWorker::new(model.as_ref(), context);
        let mut seconds_of = |rows: u64| {
            let seconds = worker.run(space, design, &RowRange { replicate: 0, rows: 0..rows });
            worker.batch.given_up().map_or(Ok(seconds), |give_up| Err(RunError::GaveUp(give_up.clone())))
        };
        let first = seconds_of(1)?;
        let rows = design.points_per_replicate() * design.rows_per_point();
        let max_rows = rows.min(MAX_ROWS).min(MAX_NUMBERS / (design.factors() + model.outputs().len()) as u64);
        let (mut runs, mut seconds) = (1, seconds_of(1)?);
        let startup = (first - seconds).max(0.0);
        while seconds < MIN_SECONDS && runs < max_rows {
            runs = (runs * 4).min(max_rows);
            seconds = seconds_of(runs)?;
        }
        // Every batch begins with the first row, and the last one has all rows, with their failures.
        let batch = worker.batch;
        let mut repeats = None;
        if model.may_be_random() {
            let first_row = (0..batch.outputs()).map(|output| batch.column(output)[0]).collect();
            repeats = Some(compare(Job { design, space, model: model.as_ref() }, context, &[(0, 0)], &[first_row])?);
        }
        let workers = model.concurrency().unwrap_or_else(|| threads_in_force(0)).max(1);
        let all_rows = seconds * design.rows() as f64 / runs as f64 / workers as f64;
        let reason = batch.failures().first().map(|(.., reason)| reason.to_string());
        Ok(Self { runs, seconds: all_rows + startup, startup, repeats, failed: failed_rows(&batch), reason })
    }
}
