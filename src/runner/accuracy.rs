//! Runs to a given accuracy of the indices, by the method with the least cost.
//!
//! A run begins with a small trial. If the study has low-fidelity models, they are used, and each doubling is spent
//! where it reduces the squared error most for its cost. The squared errors of all parts then become proportional to
//! their costs, the optimal allocation of Qian et al. (2018, eq. 3.13) for errors that fall as those of random points
//! do. Otherwise, a split design is tried first, by far the cheapest one where polynomials explain the model. Models
//! inside the program continue without surrogates if these do not reach the accuracy within a million runs.

use super::Runner;
use super::low_fidelity::sibling_path;
use crate::design::{Design, DesignSettings, MAX_PLAIN_ROWS, Rows};
use crate::model::RunContext;
use crate::result::{AccuracyReason, AccuracyRecord, StopReason, StudyResult};
use crate::run::{RunError, Store};
use crate::study::{LowFidelity, Study, SurrogateChoice};
use crate::uncertainty::{RULE_OF_THREE, largest_half_width};

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

/// One run of a search.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    /// A few runs of the split design, to see whether polynomials explain the model.
    Trial,
    /// With plain rows.
    Split,
    /// With surrogates and low-fidelity models, all runs at base points.
    Fitted,
    /// Without surrogates.
    Plain,
}

/// The outcome of a step.
struct RunOutcome {
    study: Study,
    result: StudyResult,
    reason: Option<StopReason>,
}

/// Runs `runner`'s study until it reaches the accuracy of its target.
pub(super) fn run_accurately(runner: &Runner<'_>, context: &RunContext<'_>) -> Result<StudyResult, RunError> {
    let study = runner.study;
    let mut search = AccuracySearch {
        runner,
        context,
        low_fidelity: if study.low_fidelities.is_empty() {
            study.subject.cheaper()
        } else {
            study.low_fidelities.clone()
        },
        split: Store::new(study.model().as_ref()),
        unsplit: Store::new(study.model().as_ref()),
        earlier_runs: 0,
        reasons: Vec::new(),
    };
    let mut step = search.first_step()?;
    loop {
        let outcome = search.run(step)?;
        match search.next_step(step, &outcome) {
            Some(next) => step = next,
            None => return Ok(search.recorded(outcome)),
        }
    }
}

struct AccuracySearch<'a> {
    runner: &'a Runner<'a>,
    context: &'a RunContext<'a>,
    low_fidelity: Vec<LowFidelity>,
    /// Outputs of a design with plain rows.
    split: Store,
    /// Outputs of a design without them.
    unsplit: Store,
    /// Model runs of earlier steps that the current one does not use.
    earlier_runs: u64,
    reasons: Vec<AccuracyReason>,
}

impl AccuracySearch<'_> {
    fn first_step(&mut self) -> Result<Step, RunError> {
        let study = self.runner.study;
        let DesignSettings { sampler, replicates, .. } = *study.design.settings();
        if !study.analysis.takes_surrogates(sampler, replicates, &study.space) {
            self.reasons.push(AccuracyReason::NoSurrogates);
            return Ok(Step::Plain);
        }
        if !self.low_fidelity.is_empty() {
            return Ok(Step::Fitted);
        }
        let trial_runs = self.study(Step::Trial)?.design.rows();
        Ok(if self.max_runs().is_some_and(|max_runs| trial_runs > max_runs) { Step::Fitted } else { Step::Trial })
    }

    /// Returns the step after one with this outcome; `None` if its result is final.
    fn next_step(&mut self, step: Step, outcome: &RunOutcome) -> Option<Step> {
        let runs = outcome.result.provenance.model_runs;
        let next = match (step, &outcome.reason) {
            (Step::Trial, Some(StopReason::TargetMet { .. })) => {
                self.reasons.push(AccuracyReason::TrialEnough { runs });
                return None;
            }
            (Step::Trial, _) => {
                let explained = smallest_explained(&outcome.result).clamp(0.0, 1.0);
                if explained >= SMOOTH {
                    self.reasons.push(AccuracyReason::PlainRows { runs, explained });
                    // Its runs are among those of the next step.
                    return Some(Step::Split);
                }
                self.reasons.push(AccuracyReason::NoPlainRows { runs, explained });
                Step::Fitted
            }
            (Step::Split | Step::Fitted, Some(StopReason::MaxRuns { .. }))
                if self.runner.study.target.max_runs != self.max_runs() =>
            {
                self.reasons.push(AccuracyReason::PlainIndices { runs: MAX_CORRECTED_RUNS });
                Step::Plain
            }
            _ => return None,
        };
        self.earlier_runs += runs;
        Some(next)
    }

    /// Returns the maximum number of runs with surrogates.
    fn max_runs(&self) -> Option<u64> {
        let study = self.runner.study;
        let is_quick = study.model().concurrency().is_none();
        study.target.max_runs.into_iter().chain(is_quick.then_some(MAX_CORRECTED_RUNS)).min()
    }

    /// Returns the study that a step runs.
    fn study(&self, step: Step) -> Result<Study, RunError> {
        let study = self.runner.study;
        let settings = study.design.settings();
        let (points, plain_rows, surrogate) = match step {
            Step::Trial | Step::Split => {
                let rows = study.design.rows_per_point() - u64::from(study.design.plain_rows());
                (SPLIT_POINTS, (rows * PLAIN_ROWS).min(MAX_PLAIN_ROWS.into()) as u32, SurrogateChoice::On)
            }
            Step::Fitted => (TRIAL_POINTS, 0, study.analysis.surrogate),
            Step::Plain => ((FIRST_PLAIN / settings.replicates.max(1)).max(2), 0, SurrogateChoice::Off),
        };
        let base_samples = points.saturating_mul(settings.replicates);
        let settings = DesignSettings { base_samples, ..settings.clone() };
        let rows = Rows { plain_rows, ..study.design.requested().clone() };
        let max_runs = if step == Step::Plain { study.target.max_runs } else { self.max_runs() };
        let mut variant = study.clone();
        variant.design = Design::new(settings, study.design.factors(), rows).map_err(RunError::Design)?;
        // Nothing is known to an accuracy with fewer values of a factor.
        while variant.design.distinct_values() < study.needed_values()
            && let Ok(longer) = variant.design.with_points(2 * variant.design.points_per_replicate())
            && max_runs.is_none_or(|max_runs| longer.rows() <= max_runs)
        {
            variant.design = longer;
        }
        variant.analysis.surrogate = surrogate;
        variant.low_fidelities = if step == Step::Fitted { self.low_fidelity.clone() } else { Vec::new() };
        variant.target.max_runs = if step == Step::Trial { Some(variant.design.rows()) } else { max_runs };
        Ok(variant)
    }

    fn run(&self, step: Step) -> Result<RunOutcome, RunError> {
        let study = self.study(step)?;
        let (kind, store) = match step {
            Step::Trial | Step::Split => (Some("split"), Some(&self.split)),
            Step::Fitted => (None, Some(&self.unsplit)),
            Step::Plain => (None, None),
        };
        let path = self.runner.journal.as_ref();
        let journal = path.map(|path| kind.map_or_else(|| path.clone(), |kind| sibling_path(path, kind)));
        let resume = self.runner.resume.of_part();
        let part = Runner { study: &study, journal, resume, store: self.runner.store.or(store), ..self.runner.clone() };
        let (result, reason) = part.analyse(self.context, part.open(None, self.context.messages())?)?;
        drop(part);
        Ok(RunOutcome { study, result, reason })
    }

    /// Returns the result of the last step, with the record of the search.
    fn recorded(self, RunOutcome { study, mut result, .. }: RunOutcome) -> StudyResult {
        let accuracy = study.target.accuracy.unwrap_or_default();
        let provenance = &result.provenance;
        result.spending = Some(AccuracyRecord {
            accuracy,
            excluded_region: RULE_OF_THREE / (provenance.base_samples * (2 + u64::from(provenance.plain_rows))) as f64,
            runs: self.earlier_runs + result.provenance.model_runs,
            plain_runs: plain_runs(&study, &result, accuracy),
            reasons: self.reasons,
            surrogate: study.analysis.surrogate,
            stated_low_fidelity: self.runner.study.low_fidelities.len(),
        });
        if let Some(stopping) = &mut result.stopping {
            // The limit of the study, not that of the step.
            stopping.max_runs = self.runner.study.target.max_runs;
        }
        result
    }
}

/// Returns the smallest share of the variance of an output that surrogates explain.
fn smallest_explained(result: &StudyResult) -> f64 {
    let surrogates = result.outputs.iter().map(|output| output.surrogate.as_ref());
    surrogates.map(|surrogate| surrogate.map_or(0.0, |used| used.explained)).fold(1.0, f64::min)
}

/// Computes [`AccuracyRecord::plain_runs`].
fn plain_runs(study: &Study, result: &StudyResult, accuracy: f64) -> Option<u64> {
    let mut widest: f64 = 0.0;
    for output in result.outputs.iter().filter(|output| output.indices.is_some()) {
        let half_width = match &output.surrogate {
            None => output.largest_half_width(),
            Some(used) => largest_half_width(
                used.plain.iter().flat_map(|plain| [plain.effect.first_order, plain.effect.total]).flatten(),
            ),
        };
        widest = widest.max(half_width?);
    }
    let provenance = &result.provenance;
    let rows = study.design.rows_per_point() - u64::from(provenance.plain_rows);
    let runs = (rows * provenance.base_samples) as f64 * (widest / accuracy);
    (runs.is_finite() && runs < u64::MAX as f64).then_some(runs.ceil() as u64)
}
