//! Runs to an accuracy of the indices, or within a number of runs, by the method with the least cost.
//!
//! Plain rows come first: a surrogate learns most from rows at points of their own, and gives the indices. Where it
//! explains too little for the rows that it would need, swaps of the same points measure what it leaves. If the study has
//! low-fidelity models, they are used, and each doubling is spent where it reduces the squared error most for its cost. The
//! squared errors of all parts then become proportional to their costs, the optimal allocation of Qian et al. (2018, eq.
//! 3.13) for errors that fall as those of random points do. Models inside the program continue without surrogates if
//! these do not reach the accuracy within a million runs.

use super::Runner;
use super::low_fidelity::sibling_path;
use crate::design::{Design, DesignSettings};
use crate::model::RunContext;
use crate::result::{AccuracyReason, AccuracyRecord, StopReason, StudyResult};
use crate::run::{RunError, Store};
use crate::study::{LowFidelity, Study, SurrogateChoice};
use crate::uncertainty::RULE_OF_THREE;

/// Base points of each replicate with which a run with swaps begins, the minimum to which surrogates are fitted.
const FIRST_POINTS: u64 = 4;

/// Maximum number of runs of a model inside the program for which surrogates are tried.
const MAX_CORRECTED_RUNS: u64 = 1 << 20;

/// Base samples with which a run without surrogates begins.
const FIRST_UNCORRECTED: u64 = 1 << 10;

/// One run of a search.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    /// Rows at points of their own, whose surrogate gives the indices.
    Plain,
    /// With swaps, surrogates and low-fidelity models.
    Corrected,
    /// Without surrogates.
    Uncorrected,
}

/// The outcome of a step.
struct RunOutcome {
    study: Study,
    result: StudyResult,
    reason: Option<StopReason>,
}

/// Runs `runner`'s study until it reaches the accuracy of its target, or has the runs of its plain rows.
pub(super) fn run_cheaply(runner: &Runner<'_>, context: &RunContext<'_>) -> Result<StudyResult, RunError> {
    let study = runner.study;
    let mut search = Search {
        runner,
        context,
        low_fidelity: if study.low_fidelities.is_empty() && study.target.accuracy.is_some() {
            study.subject.cheaper()
        } else {
            study.low_fidelities.clone()
        },
        plain: Store::new(study.model().as_ref()),
        swapped: Store::new(study.model().as_ref()),
        plain_runs: 0,
        earlier_runs: 0,
        reasons: Vec::new(),
    };
    let mut step = search.first_step();
    loop {
        let outcome = search.run(step)?;
        match search.next_step(step, &outcome)? {
            Some(next) => step = next,
            None => return Ok(search.recorded(outcome)),
        }
    }
}

struct Search<'a> {
    runner: &'a Runner<'a>,
    context: &'a RunContext<'a>,
    low_fidelity: Vec<LowFidelity>,
    /// Outputs of plain rows.
    plain: Store,
    /// Outputs of a design with swaps.
    swapped: Store,
    /// Plain rows that have been run.
    plain_runs: u64,
    /// Model runs of earlier steps that the current one does not use.
    earlier_runs: u64,
    reasons: Vec<AccuracyReason>,
}

impl Search<'_> {
    fn first_step(&mut self) -> Step {
        let study = self.runner.study;
        let settings = study.design.settings();
        if study.design.is_plain() {
            return Step::Plain;
        }
        if study.analysis.takes_surrogates(settings.sampler, settings.replicates, &study.space) {
            return Step::Corrected;
        }
        self.reasons.push(AccuracyReason::NoSurrogates);
        Step::Uncorrected
    }

    /// Returns the step after one with this outcome; `None` if its result is final.
    fn next_step(&mut self, step: Step, outcome: &RunOutcome) -> Result<Option<Step>, RunError> {
        let study = self.runner.study;
        let runs = outcome.result.provenance.model_runs;
        let next = match (step, &outcome.reason) {
            (Step::Plain, None) if self.is_complete(runs) => return Ok(None),
            (Step::Plain, None) => {
                let explained = smallest_explained(&outcome.result).clamp(0.0, 1.0);
                self.reasons.push(AccuracyReason::Swaps { runs, explained });
                self.plain_runs = runs;
                let DesignSettings { sampler, replicates, .. } = *study.design.settings();
                let takes_surrogates = study.analysis.takes_surrogates(sampler, replicates, &study.space);
                if takes_surrogates { Step::Corrected } else { Step::Uncorrected }
            }
            (Step::Plain, Some(StopReason::TargetMet { .. })) => {
                self.reasons.push(AccuracyReason::PlainRows { runs });
                return Ok(None);
            }
            (Step::Corrected, Some(StopReason::MaxRuns { .. })) if study.target.max_runs != self.max_runs() => {
                self.reasons.push(AccuracyReason::PlainIndices { runs: MAX_CORRECTED_RUNS });
                self.earlier_runs += runs;
                Step::Uncorrected
            }
            _ => return Ok(None),
        };
        if step == Step::Plain {
            let design = self.study(next)?.design;
            self.earlier_runs += self.unshared(&design);
            self.share(
                &outcome.study.design.with_points(runs / 2 / design.settings().replicates).map_err(RunError::Design)?,
                &design,
            );
        }
        Ok(Some(next))
    }

    /// Returns whether these are all runs of a study with a number of them.
    fn is_complete(&self, runs: u64) -> bool {
        self.runner.study.target.accuracy.is_none() && runs == self.runner.study.design.rows()
    }

    /// Returns the number of plain rows that are not rows of `design`.
    fn unshared(&self, design: &Design) -> u64 {
        if self.runner.study.target.accuracy.is_some() {
            // The run grows, and soon has them all.
            return 0;
        }
        self.plain_runs.saturating_sub(2 * design.settings().base_samples)
    }

    /// Copies the outputs of the `plain` rows to the rows A and B of `design`.
    fn share(&self, plain: &Design, design: &Design) {
        for replicate in 0..plain.settings().replicates {
            for point in 0..plain.points_per_replicate() {
                if let Some(block) = self.plain.block(replicate, 2 * point..2 * point + 2) {
                    self.swapped.insert(crate::run::RowBlock { first: point * design.rows_per_point(), ..block });
                }
            }
        }
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
        let mut variant = study.clone();
        let settings = study.design.settings();
        let is_within = |design: &Design, most: Option<u64>| most.is_none_or(|most| design.rows() <= most);
        let (points, surrogate) = match step {
            Step::Plain => {
                variant.target.max_runs = study.target.accuracy.and(self.max_runs());
                return Ok(variant);
            }
            Step::Corrected => (FIRST_POINTS, study.analysis.surrogate),
            Step::Uncorrected => ((FIRST_UNCORRECTED / settings.replicates.max(1)).max(2), SurrogateChoice::Off),
        };
        variant.analysis.surrogate = surrogate;
        variant.low_fidelities = if step == Step::Corrected { self.low_fidelity.clone() } else { Vec::new() };
        if study.target.accuracy.is_none() {
            // As many runs as the plain rows leave.
            let most = study.design.rows();
            let with = |points| study.with_swaps(points * settings.replicates).map_err(RunError::Design);
            variant.design = with(2)?;
            while let Ok(longer) = with(2 * variant.design.points_per_replicate())
                && longer.rows() + self.unshared(&longer) <= most
            {
                variant.design = longer;
            }
            return Ok(variant);
        }
        variant.design = study.with_swaps(points * settings.replicates).map_err(RunError::Design)?;
        let max_runs = if step == Step::Uncorrected { study.target.max_runs } else { self.max_runs() };
        // Nothing is known to an accuracy with fewer values of a factor.
        while variant.design.distinct_values() < study.needed_values()
            && let Ok(longer) = variant.design.with_points(2 * variant.design.points_per_replicate())
            && is_within(&longer, max_runs)
        {
            variant.design = longer;
        }
        variant.target.max_runs = max_runs;
        Ok(variant)
    }

    fn run(&self, step: Step) -> Result<RunOutcome, RunError> {
        let study = self.study(step)?;
        let store = match step {
            Step::Plain => Some(&self.plain),
            Step::Corrected => Some(&self.swapped),
            Step::Uncorrected => None,
        };
        // The rows of the study itself are in its journal.
        let is_of_study = self.runner.study.design.is_plain() == (step == Step::Plain);
        let path = self.runner.journal.as_ref();
        let journal = path.map(|path| if is_of_study { path.clone() } else { sibling_path(path, "swaps") });
        let is_fixed = is_of_study && study.target.accuracy.is_none();
        let resume = if is_fixed { self.runner.resume } else { self.runner.resume.of_part() };
        let part = Runner { study: &study, journal, resume, store, ..self.runner.clone() };
        let (result, reason) = part.analyse(self.context, part.open(None, self.context.messages())?)?;
        drop(part);
        Ok(RunOutcome { study, result, reason })
    }

    /// Returns the result of the last step, with the record of the search.
    fn recorded(self, RunOutcome { study, mut result, .. }: RunOutcome) -> StudyResult {
        let Some(accuracy) = study.target.accuracy else { return result };
        let provenance = &result.provenance;
        result.spending = Some(AccuracyRecord {
            accuracy,
            excluded_region: RULE_OF_THREE / (2 * provenance.base_samples) as f64,
            runs: self.earlier_runs + result.provenance.model_runs,
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
