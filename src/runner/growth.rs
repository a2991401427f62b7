//! The growth of a run, and its stopping rules.

use std::sync::Arc;

use super::low_fidelity::LowFidelityRun;
use crate::analysis::{IntervalOptions, PlainOutputs, output_indices};
use crate::analysis::{enough_base_samples, interval_options, is_doubted, rare_levels, surrogates};
use crate::correction::{ErrorShares, SurrogateEstimates};
use crate::estimate::{CentralMoments, MomentParts, PointOutputs, Undefined};
use crate::result::StopReason;
use crate::run::{GrowingRun, Progress, RunError};
use crate::study::{Study, Target};
use crate::uncertainty::{IntervalMethod, KeptPoints};
use apportion_base::clock::Instant;

/// Base samples below which missing intervals predict nothing about those of more runs: an output that is 0 except
/// rarely may not vary in a net of few points.
const MIN_BASE_SAMPLES: u64 = 1 << 12;

/// The same where too many runs fail for there to be indices: fewer runs show the share of failures.
const MIN_BASE_SAMPLES_OF_FAILURES: u64 = 1 << 8;

/// Why a run that grew stopped, and what is known of its surrogates.
#[derive(Default)]
pub(super) struct Grown {
    pub reason: Option<StopReason>,
    /// Those of every output, of a run with swaps.
    pub surrogates: Option<Vec<Option<SurrogateEstimates>>>,
    pub plain: Option<Arc<PlainOutputs>>,
}

impl Grown {
    fn stopped(reason: StopReason, surrogates: Vec<Option<SurrogateEstimates>>) -> Self {
        Self { reason: Some(reason), surrogates: Some(surrogates), plain: None }
    }
}

/// Maximum number of base samples to which a run grows for the rare levels of factors.
const MAX_FOR_RARE_LEVELS: f64 = (1 << 14) as f64;

/// Half width of plain indices below which they can contradict corrected ones.
const MAX_PLAIN_HALF_WIDTH: f64 = 0.5;

/// A run of a study, with those of its low-fidelity models.
pub(super) struct Growth<'a> {
    pub study: &'a Study,
    pub run: GrowingRun<'a>,
    pub low_fidelity: Vec<LowFidelityRun<'a>>,
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
}

impl Growth<'_> {
    /// Runs the model and its low-fidelity models.
    pub fn run_all(&mut self) -> Result<Grown, RunError> {
        let target = &self.study.target;
        if self.study.design.is_plain() {
            return self.grow_plain();
        }
        self.run.grow_to(self.study.design.points_per_replicate(), self.on_progress)?;
        if target.accuracy.is_none() {
            self.begin_low_fidelity()?;
        }
        if target.grows() { self.grow() } else { Ok(Grown::default()) }
    }

    /// Starts the first runs of low-fidelity models. One that is no cheaper is dropped in a run that grows.
    fn begin_low_fidelity(&mut self) -> Result<(), RunError> {
        let seconds = self.run.elapsed().as_secs_f64();
        self.follow()?;
        if self.study.target.accuracy.is_some() {
            self.low_fidelity.retain(|low| low.is_cheaper(seconds));
        }
        self.low_fidelity.iter_mut().try_for_each(|low| low.begin(seconds))
    }

    /// Evaluates the rows of the model with the low-fidelity models.
    fn follow(&mut self) -> Result<(), RunError> {
        let points = self.run.points_per_replicate();
        self.low_fidelity.iter_mut().try_for_each(|low| low.shared.grow_to(points))
    }

    /// Doubles the run, or the independent runs of a low-fidelity model, until there is a reason to stop; returns the
    /// reason and the surrogate estimates of the outputs at that stage.
    fn grow(&mut self) -> Result<Grown, RunError> {
        let low_seconds: f64 = self.low_fidelity.iter().map(LowFidelityRun::seconds).sum();
        let mut seconds = self.run.elapsed().as_secs_f64() - low_seconds;
        if self.study.target.accuracy.is_some() && !self.low_fidelity.is_empty() {
            // If the first runs suffice, low-fidelity models need not run.
            let first = self.run.install(|| self.stage(&[]));
            if let Some(stopped) = self.reason_to_stop(&first).filter(meets_target) {
                self.low_fidelity.clear();
                return Ok(Grown::stopped(stopped, first.surrogates));
            }
            self.begin_low_fidelity()?;
            let best = self.run.install(|| self.best_low_fidelity(seconds));
            self.low_fidelity = best.map(|best| self.low_fidelity.swap_remove(best)).into_iter().collect();
        }
        loop {
            let stage = self.run.install(|| self.stage(&self.low_fidelity));
            let stopped = self.reason_to_stop(&stage);
            if let [low] = &mut self.low_fidelity[..]
                && !stopped.as_ref().is_some_and(meets_target)
                && let Some(points) = low.next_points(stage.squared_errors, seconds)
            {
                low.grow_independent(points)?;
                continue;
            }
            if let Some(stopped) = stopped {
                return Ok(Grown::stopped(stopped, stage.surrogates));
            }
            let start = Instant::now();
            self.run.grow_to(self.run.points_per_replicate() * 2, self.on_progress)?;
            seconds += start.elapsed().as_secs_f64();
            self.follow()?;
        }
    }

    /// Returns the index of the low-fidelity model with the least expected cost for an accuracy, given that the rows so
    /// far took `seconds`; `None` if none is better than surrogates alone.
    fn best_low_fidelity(&self, seconds: f64) -> Option<usize> {
        let mut least_cost = self.stage(&[]).squared_errors.model * seconds;
        let mut best = None;
        for (index, low) in self.low_fidelity.iter().enumerate() {
            let errors = self.stage(std::slice::from_ref(low)).squared_errors;
            let cost = low.expected_cost(errors, seconds);
            if cost < least_cost {
                (best, least_cost) = (Some(index), cost);
            }
        }
        best
    }

    /// Computes the stage that the run has reached. Outputs that do not vary have no indices and are ignored.
    fn stage(&self, low_fidelity: &[LowFidelityRun<'_>]) -> Stage {
        let Self { study, run, .. } = self;
        let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
        let (layout, options) = (study.layout(), interval_options(study));
        let squared_errors = ErrorShares::default();
        let mut all =
            Stage { widest: None, is_checked: true, is_doubted: false, squared_errors, surrogates: Vec::new() };
        let Ok(design) = run.design().with_points(run.points_per_replicate()) else { return all };
        let low_fidelity: Vec<_> = low_fidelity.iter().map(LowFidelityRun::totals).collect();
        let (mut has_all, model) = (true, study.model());
        all.surrogates = surrogates(study, &design, run.totals(), &low_fidelity, &[]);
        for number in 0..outputs {
            let parts: Vec<&MomentParts> = run.totals().iter().map(|t| &t.outputs[number].moments).collect();
            let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].point_outputs).collect();
            let surrogate = all.surrogates.get(number).and_then(Option::as_ref);
            let points = KeptPoints::all(&design, &kept);
            let unread = study.unread(model.as_ref(), number);
            let options = IntervalOptions { points, unread: &unread, surrogate, draws: 0, ..options };
            let indices = output_indices(&parts, &layout, &options);
            if let Some(indices) = indices.as_ref().ok().filter(|indices| indices.surrogate.is_some()) {
                all.is_checked &= indices.plain_half_width().is_some_and(|half| half <= MAX_PLAIN_HALF_WIDTH);
            }
            if let Ok(indices) = &indices {
                let mut values = CentralMoments::default();
                run.totals().iter().for_each(|totals| values.merge(&totals.outputs[number].values));
                all.is_doubted |= is_doubted(study, indices, &values);
            }
            match indices.map(|indices| indices.largest_half_width()) {
                Ok(Some(widest)) if all.widest.is_none_or(|before| widest > before) => {
                    all.widest = Some(widest);
                    let plain = ErrorShares { model: 1.0, low_fidelity: 0.0 };
                    all.squared_errors = surrogate.map_or(plain, SurrogateEstimates::squared_errors);
                }
                Ok(Some(_)) | Err(Undefined::ZeroVariance) => (),
                Ok(None) | Err(_) => has_all = false,
            }
        }
        all.widest = all.widest.filter(|_| has_all);
        all
    }

    /// Returns why the run should stop; `None` if it should be doubled again.
    fn reason_to_stop(&self, stage: &Stage) -> Option<StopReason> {
        let Self { study, run, .. } = self;
        let (longest, widest) = (run.design(), stage.widest);
        let Target { accuracy, max_time, max_runs, .. } = study.target;
        let next = run.points_per_replicate() * 2;
        let replicates = longest.settings().replicates;
        let runs = u128::from(next) * u128::from(replicates) * u128::from(longest.rows_per_point());
        let seconds = 2.0 * run.elapsed().as_secs_f64();
        let base_samples = run.points_per_replicate() * replicates;
        // With one replicate there is no spread for any points.
        let has_none =
            replicates < 2 && matches!(study.analysis.intervals, IntervalMethod::Nets | IntervalMethod::Replicates);
        let has_too_few = base_samples >= MIN_BASE_SAMPLES_OF_FAILURES && fails_too_often(self);
        let is_reached = accuracy.zip(widest).is_some_and(|(target, widest)| widest <= target);
        let design = longest.with_points(run.points_per_replicate()).ok().filter(|design| {
            is_reached && stage.is_checked && !stage.is_doubted && design.distinct_values() >= study.needed_values()
        });
        let is_met = design.is_some();
        let rare = design.map_or_else(Vec::new, |design| rare_levels(&study.space, &design));
        Some(match (accuracy, widest) {
            (Some(_), _) if has_too_few => StopReason::NoIntervals { base_samples },
            (Some(target), Some(widest)) if is_met && rare.is_empty() => StopReason::TargetMet { widest, target },
            (Some(_), Some(widest)) if enough_base_samples(&rare) > MAX_FOR_RARE_LEVELS => {
                StopReason::RareLevels { widest, base_samples: enough_base_samples(&rare) }
            }
            (Some(_), None) if has_none || base_samples >= MIN_BASE_SAMPLES => StopReason::NoIntervals { base_samples },
            _ if next > longest.points_per_replicate() => StopReason::EndOfSequence,
            _ if run.room_for(next).is_err() => StopReason::Memory,
            _ => match (max_runs, max_time) {
                (Some(most), _) if runs > u128::from(most) => {
                    StopReason::MaxRuns { runs: u64::try_from(runs).unwrap_or(u64::MAX), most }
                }
                (_, Some(budget)) if seconds > budget => StopReason::Budget { seconds, budget },
                _ => return None,
            },
        })
    }
}

/// Returns whether more runs failed than an output with indices may have.
pub(super) fn fails_too_often(Growth { study, run, .. }: &Growth<'_>) -> bool {
    let rows = run.points_per_replicate() * run.design().rows_per_point() * run.totals().len() as u64;
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    (0..outputs).any(|number| {
        let failed: u64 = run.totals().iter().map(|totals| totals.outputs[number].runs_failed).sum();
        failed as f64 / rows as f64 > study.analysis.max_failed
    })
}

fn meets_target(reason: &StopReason) -> bool {
    matches!(reason, StopReason::TargetMet { .. })
}

/// The accuracy of the indices at a stage of a run.
#[derive(Debug, Clone, PartialEq)]
struct Stage {
    /// Largest half width of the indices of all outputs; `None` if some are missing.
    widest: Option<f64>,
    /// Whether plain indices are accurate enough to contradict corrected ones.
    is_checked: bool,
    /// Whether indices may be wrong by more than their intervals say.
    is_doubted: bool,
    /// Squared errors of the output with this half width.
    squared_errors: ErrorShares,
    /// The surrogate estimates of every output.
    surrogates: Vec<Option<SurrogateEstimates>>,
}
