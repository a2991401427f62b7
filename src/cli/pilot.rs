//! How long the runs of a study will take, by a few of them.

use std::collections::BTreeSet;
use std::time::Instant;

use anyhow::anyhow;
use apportion::design::{Design, DesignSettings};
use apportion::model::{Batch, Model, Standing};
use apportion::run::{Job, RowValues, run};
use apportion::study::Study;

use super::Failure;

/// A few runs of the study's model, and how long the whole design would take by them.
pub struct Pilot {
    /// Runs it took.
    pub runs: u64,
    /// Seconds that the whole design will take, the start included.
    pub seconds: f64,
    /// Seconds that a worker takes before its first run, where it takes any.
    pub startup: f64,
    /// Whether what it answered was not known to be in step with its rows in the end.
    pub is_out_of_step: bool,
    /// Runs that failed in some output.
    pub failed: u64,
    /// Why the first of them did.
    pub reason: Option<String>,
}

/// Runs ever larger first parts of the design until they take long enough to be measured, or are all of it.
pub fn pilot(study: &Study) -> Result<Pilot, Failure> {
    const ENOUGH: f64 = 0.1;
    let model = study.model();
    if let Some(workers) = model.concurrency() {
        return of_one_worker(study, model.as_ref(), workers);
    }
    let mut points = 2;
    loop {
        let settings = DesignSettings { base_samples: points, replicates: 1, ..study.design.settings().clone() };
        let design = Design::new(settings, study.design.factors(), study.design.asked().clone())
            .map_err(|error| Failure::Input(error.into()))?;
        let start = Instant::now();
        let totals = run(Job { design: &design, space: &study.space, model: model.as_ref() }, 0, &|_| ())?;
        let seconds = start.elapsed().as_secs_f64();
        if seconds >= ENOUGH || points >= study.design.settings().base_samples {
            let share = study.design.rows() as f64 / design.rows() as f64;
            let failures = totals.iter().flat_map(|totals| &totals.outputs).flat_map(|output| &output.failures);
            let first = failures.min_by_key(|(_, tally)| tally.first);
            return Ok(Pilot {
                runs: design.rows(),
                seconds: seconds * share,
                startup: 0.0,
                is_out_of_step: false,
                failed: totals.iter().map(|totals| totals.failed_runs).sum(),
                reason: first.map(|(reason, _)| reason.to_string()),
            });
        }
        points = (points * 4).min(study.design.settings().base_samples);
    }
}

/// A pilot of a model that takes its time, by one of its workers. What the first row takes longer than the same row once
/// more is the start.
fn of_one_worker(study: &Study, model: &dyn Model, workers: usize) -> Result<Pilot, Failure> {
    const ENOUGH: f64 = 0.5;
    const MOST: u64 = 4096;
    let job = Job { design: &study.design, space: &study.space, model };
    let (mut worker, mut batch, mut values) = (model.worker(), Batch::of(model), RowValues::default());
    let (mut failed, mut reason, mut is_out_of_step) = (0, None, false);
    let mut timed = |rows: u64| {
        let columns = values.values(job, 0, 0..rows);
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        batch.reset(rows as usize);
        let start = Instant::now();
        while worker.run_ahead(&inputs, &mut batch) == Standing::Revoked && batch.given_up().is_none() {
            is_out_of_step = true;
            batch.reset(rows as usize);
        }
        let seconds = start.elapsed().as_secs_f64();
        // Every piece begins with the first row, so that the last one has them all.
        let rows: BTreeSet<usize> = batch.failures().iter().map(|(_, row, _)| *row).collect();
        failed = rows.len() as u64;
        reason = batch.failures().first().map(|(.., reason)| reason.to_string());
        batch.given_up().map_or(Ok(seconds), |reason| Err(Failure::Run(anyhow!("the model cannot go on: {reason}"))))
    };
    let first = timed(1)?;
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    let (mut runs, mut seconds) = (1, timed(1)?);
    let startup = (first - seconds).max(0.0);
    while seconds < ENOUGH && runs < rows.min(MOST) {
        runs = (runs * 4).min(rows).min(MOST);
        seconds = timed(runs)?;
    }
    is_out_of_step |= worker.confirm() == Standing::Revoked;
    let whole = seconds * study.design.rows() as f64 / runs as f64 / workers as f64;
    Ok(Pilot { runs, seconds: whole + startup, startup, is_out_of_step, failed, reason })
}
