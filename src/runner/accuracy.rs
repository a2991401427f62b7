//! A run that is told how well the indices must be known, and chooses what gets there at the least cost.
//!
//! Quick models are doubled without surrogates, whose fit costs more than the runs. Others begin with a small trial. If they
//! have cheaper models, these stand in, and each doubling goes where it takes most of the squared error away for its cost; that
//! makes the squared errors of all parts proportional to what they cost, the optimal allocation of Qian et al. (2018, eq. 3.13)
//! for errors that fall as those of random points do. If they have none, a split design is tried first, which is by far the
//! cheapest where polynomials explain the model.

use super::low_fidelity::sibling_path;
use super::{Resume, Runner};
use crate::analysis::{Analysis, OutputAnalysis, Spending, StopReason};
use crate::clock::Instant;
use crate::design::{Design, DesignSettings, Rows};
use crate::model::{Batch, RunContext};
use crate::run::{RowValues, RunError, Store};
use crate::study::{LowFidelity, Study, SurrogateChoice, Target};
use crate::uncertainty::OutputIndices;

/// Base points of each replicate in a trial without plain rows, the fewest that surrogates are fitted to.
const TRIAL_POINTS: u64 = 4;

/// The same with plain rows, and how many of these there are for each run of a base point.
const SPLIT_POINTS: u64 = 2;
const PLAIN_ROWS: u64 = 1;

/// Seconds of a run below which a model counts as quick, and rows that it is measured at: no more than any trial has.
const QUICK_RUN: f64 = 20e-6;
const TIMED_ROWS: u64 = 2 * TRIAL_POINTS;

/// Seconds that a quick model is doubled for before surrogates are tried.
const QUICK_BUDGET: f64 = 2.0;

/// Rows that surrogates of a quick model are fitted to, at most.
const MOST_FITTED_ROWS: u64 = 1 << 16;

/// Share of the variance that surrogates must explain for plain rows to be worth while.
const SMOOTH: f64 = 0.9;

/// Base samples with which a run without surrogates begins.
const FIRST_PLAIN: u64 = 1 << 10;

/// Runs `runner`'s study until it is as accurate as its target says.
pub(super) fn run_accurately(runner: &Runner<'_>, context: &RunContext<'_>) -> Result<Analysis, RunError> {
    let mut attempt = Attempt { runner, context, runs: 0, reasons: Vec::new() };
    let study = runner.study;
    let DesignSettings { sampler, replicates, .. } = *study.design.settings();
    if !study.analysis.takes_surrogates(sampler, replicates, &study.space) {
        attempt.say(
            "surrogates and cheaper models need independent factors, and three or more replicates of Sobol' or random points",
        );
        return attempt.plain(None);
    }
    let trial = attempt.variant(TRIAL_POINTS, 0, SurrogateChoice::Off)?;
    let store = Store::new(&trial.design.longest(), trial.model().as_ref());
    let takes_its_time = study.model().concurrency().is_some();
    if !takes_its_time && attempt.is_quick(&trial) {
        let first = attempt.plain(Some(QUICK_BUDGET))?;
        let is_ours = |reason| matches!(reason, StopReason::Budget { .. });
        if !first.stopped.as_ref().is_some_and(|stopped| is_ours(stopped.reason)) {
            return Ok(first);
        }
        attempt.say("two seconds were not enough for that: surrogates were tried");
        let fitted = attempt.fitted(Vec::new(), Some(MOST_FITTED_ROWS), &store)?;
        if is_met(&fitted) {
            return Ok(fitted);
        }
        attempt.say("they were not accurate enough either");
        return attempt.plain(None);
    }
    let lows = if study.lows.is_empty() { study.subject.cheaper() } else { study.lows.clone() };
    if lows.is_empty() { attempt.split(&store) } else { attempt.fitted(lows, None, &store) }
}

fn is_met(analysis: &Analysis) -> bool {
    analysis.stopped.as_ref().is_some_and(|stopped| stopped.target_met == Some(true))
}

struct Attempt<'a> {
    runner: &'a Runner<'a>,
    context: &'a RunContext<'a>,
    /// Runs of earlier trials.
    runs: u64,
    reasons: Vec<String>,
}

impl Attempt<'_> {
    fn say(&mut self, reason: impl Into<String>) {
        self.reasons.push(reason.into());
    }

    /// The study with another design.
    fn variant(&self, points: u64, plain_rows: u32, surrogate: SurrogateChoice) -> Result<Study, RunError> {
        let study = self.runner.study;
        let settings = study.design.settings();
        let base_samples = points.saturating_mul(settings.replicates);
        let rows = Rows { plain_rows, ..study.design.asked().clone() };
        let mut variant = study.clone();
        variant.design = Design::new(DesignSettings { base_samples, ..settings.clone() }, study.design.factors(), rows)
            .map_err(RunError::Design)?;
        variant.analysis.surrogate = surrogate;
        variant.lows = Vec::new();
        Ok(variant)
    }

    /// Whether the model is so quick that fits cost more than runs, by one worker at the first rows of `trial`.
    fn is_quick(&mut self, trial: &Study) -> bool {
        let model = trial.model();
        let (mut worker, mut batch) = (model.worker(self.context), Batch::new(model.as_ref()));
        let (mut values, mut of_run) = (RowValues::default(), f64::INFINITY);
        // Single rows first, the second of them after what only the first one waits for: a slow model has no others.
        for (number, rows) in [1, 1, TIMED_ROWS].into_iter().enumerate() {
            if number == 2 && of_run > 10.0 * QUICK_RUN {
                break;
            }
            let columns = values.values(&trial.space, &trial.design, 0, 0..rows);
            let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            batch.reset(rows as usize);
            let start = Instant::now();
            worker.run(&inputs, &mut batch);
            of_run = of_run.min(start.elapsed().as_secs_f64() / rows as f64);
            self.runs += rows;
        }
        let is_quick = of_run < QUICK_RUN;
        self.say(if is_quick {
            format!("a run takes less than {:.0} us: runs are cheaper than fits", 1e6 * QUICK_RUN)
        } else {
            format!("a run takes about {of_run:.0e} s: fits are cheaper than runs")
        });
        is_quick
    }

    /// Without surrogates, for so many seconds.
    fn plain(&mut self, max_time: Option<f64>) -> Result<Analysis, RunError> {
        let replicates = self.runner.study.design.settings().replicates;
        let mut study = self.variant((FIRST_PLAIN / replicates.max(1)).max(2), 0, SurrogateChoice::Off)?;
        study.target.max_time = study.target.max_time.into_iter().chain(max_time).reduce(f64::min);
        self.run(&study, None, None)
    }

    /// With surrogates and `lows`, all runs at base points; those in `store` are there already.
    fn fitted(&mut self, lows: Vec<LowFidelity>, most_rows: Option<u64>, store: &Store) -> Result<Analysis, RunError> {
        let mut study = self.variant(TRIAL_POINTS, 0, SurrogateChoice::On)?;
        study.lows = lows;
        let max_runs = study.target.max_runs.into_iter().chain(most_rows).min();
        study.target = Target { max_runs, ..study.target };
        self.run(&study, None, Some(store))
    }

    /// With plain rows, if polynomials explain the model; `unsplit` holds outputs of rows without them.
    fn split(&mut self, unsplit: &Store) -> Result<Analysis, RunError> {
        let of_point = self.variant(SPLIT_POINTS, 0, SurrogateChoice::On)?.design.rows_per_point();
        let plain_rows = u32::try_from(of_point * PLAIN_ROWS).unwrap_or(u32::MAX).min(crate::design::MAX_PLAIN_ROWS);
        let study = self.variant(SPLIT_POINTS, plain_rows, SurrogateChoice::On)?;
        let trial_runs = study.design.rows();
        if study.target.max_runs.is_some_and(|most| trial_runs > most) {
            return self.fitted(Vec::new(), None, unsplit);
        }
        let store = Store::new(&study.design.longest(), study.model().as_ref());
        let mut trial = study.clone();
        trial.target = Target { max_runs: Some(trial_runs), ..study.target };
        let first = self.run(&trial, Some("split"), Some(&store))?;
        if is_met(&first) {
            return Ok(self.with_reasons(first, format!("a trial of {trial_runs} runs was enough")));
        }
        let explained = explained(&first);
        let percent = 100.0 * explained.clamp(0.0, 1.0);
        if explained >= SMOOTH {
            self.say(format!(
                "in a trial of {trial_runs} runs polynomials explained {percent:.1} % of the variance: plain rows"
            ));
            self.runs -= trial_runs;
            return self.run(&study, Some("split"), Some(&store));
        }
        self.say(format!(
            "in a trial of {trial_runs} runs polynomials explained {percent:.0} % of the variance: no plain rows"
        ));
        self.fitted(Vec::new(), None, unsplit)
    }

    fn with_reasons(&mut self, mut analysis: Analysis, more: String) -> Analysis {
        self.say(more);
        if let Some(spending) = &mut analysis.spending {
            spending.reasons.clone_from(&self.reasons);
        }
        analysis
    }

    fn run(&mut self, study: &Study, kind: Option<&str>, store: Option<&Store>) -> Result<Analysis, RunError> {
        let Runner { journal, resume, .. } = self.runner;
        let journal = match (journal, kind) {
            (Some(path), Some(kind)) => Some(sibling_path(path, kind)),
            (path, _) => path.clone(),
        };
        let resume = if *resume == Resume::Require { Resume::IfThere } else { *resume };
        let part = Runner { study, journal, resume, store: self.runner.store.or(store), ..self.runner.clone() };
        let journal = part.open(None, self.context.messages())?;
        let mut analysis = part.analyse(self.context, journal)?;
        self.runs += analysis.design.rows();
        let accuracy = study.target.accuracy.unwrap_or_default();
        analysis.spending = Some(Spending {
            accuracy,
            runs: self.runs,
            surrogate: study.analysis.surrogate,
            plain_runs: plain_runs(&analysis, accuracy),
            reasons: self.reasons.clone(),
        });
        Ok(analysis)
    }
}

/// The least share of the variance of an output that surrogates explain.
fn explained(analysis: &Analysis) -> f64 {
    let of_output = |output: &OutputAnalysis| {
        let Ok(indices) = &output.indices else { return 0.0 };
        indices.surrogate.as_ref().map_or(0.0, |used| used.explained)
    };
    analysis.outputs.iter().map(of_output).fold(1.0, f64::min)
}

/// See [`Spending::plain_runs`].
fn plain_runs(analysis: &Analysis, accuracy: f64) -> Option<u64> {
    let of_output = |indices: &OutputIndices| match &indices.surrogate {
        None => indices.largest_half_width(),
        Some(used) => used.plain_half_width(),
    };
    let mut widest = analysis.outputs.iter().filter_map(|output| output.indices.as_ref().ok()).map(of_output);
    let widest = widest.try_fold(0.0, |widest: f64, half| Some(widest.max(half?)))?;
    let design = &analysis.design;
    let rows = (design.rows_per_point() - u64::from(design.plain_rows())) * design.settings().base_samples;
    let runs = rows as f64 * (widest / accuracy);
    (runs.is_finite() && runs < u64::MAX as f64).then_some(runs.ceil() as u64)
}
