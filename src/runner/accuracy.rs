//! Runs to a given accuracy of the indices, by the method with the least cost.
//!
//! A run begins with a small trial. If the study has low-fidelity models, they are used, and each doubling is spent
//! where it reduces the squared error most for its cost. The squared errors of all parts then become proportional to
//! their costs, the optimal allocation of Qian et al. (2018, eq. 3.13) for errors that fall as those of random points
//! do. Otherwise, a split design is tried first, by far the cheapest one where polynomials explain the model. Models
//! inside the program continue without surrogates if these do not reach the accuracy within a million runs.

use super::low_fidelity::sibling_path;
use super::{Resume, Runner};
use crate::design::{Design, DesignSettings, Rows};
use crate::model::RunContext;
use crate::result::{OutputResult, SpendingRecord, StopReason, StudyResult};
use crate::run::{RunError, Store};
use crate::study::{LowFidelity, Study, SurrogateChoice, Target};
use crate::uncertainty::largest_half_width;

/// Base points of each replicate in a trial without plain rows, the minimum to which surrogates are fitted.
const TRIAL_POINTS: u64 = 4;

/// The same with plain rows, and the number of plain rows for each run of a base point.
const SPLIT_POINTS: u64 = 2;
const PLAIN_ROWS: u64 = 1;

/// Maximum number of runs of a model inside the program for which surrogates are tried.
const MAX_CORRECTED_RUNS: u64 = 1 << 20;

/// Share of the variance that surrogates must explain for plain rows to be useful.
const SMOOTH: f64 = 0.9;

/// Base samples with which a run without surrogates begins.
const FIRST_PLAIN: u64 = 1 << 10;

/// Runs `runner`'s study until it reaches the accuracy of its target.
pub(super) fn run_accurately(runner: &Runner<'_>, context: &RunContext<'_>) -> Result<StudyResult, RunError> {
    let mut attempt = Attempt { runner, context, runs: 0, reasons: Vec::new() };
    let study = runner.study;
    let DesignSettings { sampler, replicates, .. } = *study.design.settings();
    if !study.analysis.takes_surrogates(sampler, replicates, &study.space) {
        attempt.say(
            "surrogates and cheaper models need independent factors, and three or more replicates of Sobol' or random points",
        );
        return Ok(attempt.plain()?.0);
    }
    let trial = attempt.variant(TRIAL_POINTS, 0, SurrogateChoice::Off)?;
    let store = Store::new(trial.model().as_ref());
    let lows = if study.lows.is_empty() { study.subject.cheaper() } else { study.lows.clone() };
    let (first, reason) = if lows.is_empty() { attempt.split(&store)? } else { attempt.fitted(lows, &store)? };
    let is_ours = |reason| matches!(reason, StopReason::MaxRuns { .. }) && study.target.max_runs != attempt.max_runs();
    if !reason.is_some_and(is_ours) {
        return Ok(first);
    }
    attempt.say(format!("corrected indices of {MAX_CORRECTED_RUNS} runs would not reach the accuracy: no surrogates"));
    Ok(attempt.plain()?.0)
}

/// A result, and why its run stopped.
type Ended = (StudyResult, Option<StopReason>);

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

    /// Returns the study with another design.
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

    /// Runs without surrogates.
    fn plain(&mut self) -> Result<Ended, RunError> {
        let replicates = self.runner.study.design.settings().replicates;
        let study = self.variant((FIRST_PLAIN / replicates.max(1)).max(2), 0, SurrogateChoice::Off)?;
        self.run(&study, None, None)
    }

    /// Returns the maximum number of runs with surrogates.
    fn max_runs(&self) -> Option<u64> {
        let study = self.runner.study;
        let own = study.model().concurrency().is_none().then_some(MAX_CORRECTED_RUNS);
        study.target.max_runs.into_iter().chain(own).min()
    }

    /// Runs with surrogates and `lows`, all runs at base points; those in `store` are reused.
    fn fitted(&mut self, lows: Vec<LowFidelity>, store: &Store) -> Result<Ended, RunError> {
        let mut study = self.variant(TRIAL_POINTS, 0, self.runner.study.analysis.surrogate)?;
        study.lows = lows;
        study.target = Target { max_runs: self.max_runs(), ..study.target };
        self.run(&study, None, Some(store))
    }

    /// Runs with plain rows, if polynomials explain the model; `unsplit` holds outputs of rows without them.
    fn split(&mut self, unsplit: &Store) -> Result<Ended, RunError> {
        let of_point = self.variant(SPLIT_POINTS, 0, SurrogateChoice::On)?.design.rows_per_point();
        let plain_rows = u32::try_from(of_point * PLAIN_ROWS).unwrap_or(u32::MAX).min(crate::design::MAX_PLAIN_ROWS);
        let mut study = self.variant(SPLIT_POINTS, plain_rows, SurrogateChoice::On)?;
        study.target.max_runs = self.max_runs();
        let trial_runs = study.design.rows();
        if study.target.max_runs.is_some_and(|most| trial_runs > most) {
            return self.fitted(Vec::new(), unsplit);
        }
        let store = Store::new(study.model().as_ref());
        let mut trial = study.clone();
        trial.target = Target { max_runs: Some(trial_runs), ..study.target };
        let (mut first, reason) = self.run(&trial, Some("split"), Some(&store))?;
        if matches!(reason, Some(StopReason::TargetMet { .. })) {
            self.say(format!("a trial of {trial_runs} runs was enough"));
            first.spending.iter_mut().for_each(|spending| spending.reasons.clone_from(&self.reasons));
            return Ok((first, reason));
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
        self.fitted(Vec::new(), unsplit)
    }

    fn run(&mut self, study: &Study, kind: Option<&str>, store: Option<&Store>) -> Result<Ended, RunError> {
        let Runner { journal, resume, .. } = self.runner;
        let journal = match (journal, kind) {
            (Some(path), Some(kind)) => Some(sibling_path(path, kind)),
            (path, _) => path.clone(),
        };
        let resume = if *resume == Resume::Require { Resume::IfThere } else { *resume };
        let part = Runner { study, journal, resume, store: self.runner.store.or(store), ..self.runner.clone() };
        let journal = part.open(None, self.context.messages())?;
        let (mut result, reason) = part.analyse(self.context, journal)?;
        self.runs += result.provenance.model_runs;
        let accuracy = study.target.accuracy.unwrap_or_default();
        result.spending = Some(SpendingRecord {
            accuracy,
            runs: self.runs,
            plain_runs: plain_runs(study, &result, accuracy),
            reasons: self.reasons.clone(),
            surrogate: study.analysis.surrogate,
            stated_lows: self.runner.study.lows.len(),
        });
        // Report the limit of the study, not that of this attempt.
        result.stopping.iter_mut().for_each(|stopping| stopping.max_runs = self.runner.study.target.max_runs);
        Ok((result, reason))
    }
}

/// Returns the smallest share of the variance of an output that surrogates explain.
fn explained(result: &StudyResult) -> f64 {
    let of_output = |output: &OutputResult| output.surrogate.as_ref().map_or(0.0, |used| used.explained);
    result.outputs.iter().map(of_output).fold(1.0, f64::min)
}

/// Computes [`SpendingRecord::plain_runs`].
fn plain_runs(study: &Study, result: &StudyResult, accuracy: f64) -> Option<u64> {
    let of_output = |output: &OutputResult| match &output.surrogate {
        None => output.largest_half_width(),
        Some(used) => {
            largest_half_width(used.plain.iter().flat_map(|plain| [plain.first_order, plain.total]).flatten())
        }
    };
    let mut widest = result.outputs.iter().filter(|output| output.indices.is_some()).map(of_output);
    let widest = widest.try_fold(0.0, |widest: f64, half| Some(widest.max(half?)))?;
    let provenance = &result.provenance;
    let rows = study.design.rows_per_point() - u64::from(provenance.plain_rows);
    let runs = (rows * provenance.base_samples) as f64 * (widest / accuracy);
    (runs.is_finite() && runs < u64::MAX as f64).then_some(runs.ceil() as u64)
}
