//! The growth of a run, and its stopping rules.

use super::Runner;
use super::low_fidelity::LowRun;
use crate::analysis::{
    IntervalOptions, enough_base_samples, interval_options, output_indices, rare_levels, surrogates,
};
use crate::correction::SurrogateEstimates;
use crate::design::Design;
use crate::estimate::{MomentParts, PointOutputs, Undefined};
use crate::result::StopReason;
use crate::run::{GrowingRun, Progress, RunError};
use crate::study::{Study, Target};
use crate::uncertainty::{IntervalMethod, KeptPoints};
use apportion_base::clock::Instant;

/// Base samples below which missing intervals predict nothing about those of more runs: an output that is 0 except
/// rarely may not vary in a net of few points.
const MIN_BASE_SAMPLES: u64 = 1 << 12;

/// The same where too many runs fail for there to be indices: the share of failures is known much sooner.
const MIN_BASE_SAMPLES_OF_FAILURES: u64 = 1 << 8;

/// Why a growing run stopped, and the surrogate estimates of every output.
pub(super) type Grown = (StopReason, Vec<Option<SurrogateEstimates>>);

/// Maximum number of base samples to which a run grows for the rare levels of factors.
const MAX_FOR_RARE_LEVELS: f64 = (1 << 14) as f64;

/// Half width of plain indices below which they can contradict corrected ones.
const MAX_PLAIN_HALF_WIDTH: f64 = 0.5;

/// Share of the squared error below which low-fidelity models need not go.
const ENOUGH: f64 = 1.0 / 16.0;

impl Runner<'_> {
    /// Starts the first runs of low-fidelity models. One that is no cheaper is dropped in a run that grows.
    pub(super) fn begin_lows(&self, run: &GrowingRun<'_>, lows: &mut Vec<LowRun<'_>>) -> Result<(), RunError> {
        let seconds = run.elapsed().as_secs_f64();
        for low in lows.iter_mut() {
            low.follow(run.points_per_replicate())?;
        }
        if self.study.target.accuracy.is_some() {
            lows.retain(|low| low.is_cheaper(seconds));
        }
        lows.iter_mut().try_for_each(|low| low.begin(seconds))
    }

    /// Doubles the run, or the own runs of a low-fidelity model, until there is a reason to stop; returns the reason
    /// and the surrogate estimates of the outputs at that stage.
    pub(super) fn grow(
        &self,
        run: &mut GrowingRun<'_>,
        lows: &mut Vec<LowRun<'_>>,
        on_progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Grown, RunError> {
        let longest = run.design();
        let is_met = |reason: &StopReason| matches!(reason, StopReason::TargetMet { .. });
        let mut seconds = run.elapsed().as_secs_f64() - lows.iter().flat_map(LowRun::seconds).sum::<f64>();
        if self.study.target.accuracy.is_some() && !lows.is_empty() {
            // If the first runs suffice, low-fidelity models need not run.
            let first = run.install(|| stage(self.study, run, &[]));
            if let Some(stopped) = reason_to_stop(self.study, run, longest, &first).filter(is_met) {
                lows.clear();
                return Ok((stopped, first.surrogates));
            }
            self.begin_lows(run, lows)?;
            let best = run.install(|| best_low(self.study, run, lows, seconds));
            *lows = best.map(|best| lows.swap_remove(best)).into_iter().collect();
        }
        loop {
            let reached = run.install(|| stage(self.study, run, lows));
            let stopped = reason_to_stop(self.study, run, longest, &reached);
            let [own, of_low] = reached.squared_errors;
            if let ([low], false) = (&mut lows[..], stopped.as_ref().is_some_and(is_met)) {
                let [shared, cost] = low.seconds();
                let pays = of_low * (seconds + shared) > own * cost && of_low > ENOUGH * own;
                if let Some(points) = low.doubled().filter(|_| pays) {
                    low.grow_own(points)?;
                    continue;
                }
            }
            if let Some(stopped) = stopped {
                return Ok((stopped, reached.surrogates));
            }
            let start = Instant::now();
            run.grow_to(run.points_per_replicate() * 2, on_progress)?;
            seconds += start.elapsed().as_secs_f64();
            lows.iter_mut().try_for_each(|low| low.follow(run.points_per_replicate()))?;
        }
    }
}

/// Returns the index in `lows` of the model with the least expected cost for an accuracy, given that the rows so far
/// took `seconds`; `None` if none is better than surrogates alone.
fn best_low(study: &Study, run: &GrowingRun<'_>, lows: &[LowRun<'_>], seconds: f64) -> Option<usize> {
    let alone = stage(study, run, &[]).squared_errors[0] * seconds;
    let of_low = |low: &LowRun<'_>| {
        let [own, of_low] = stage(study, run, std::slice::from_ref(low)).squared_errors;
        let [shared, cost] = low.seconds();
        ((own * (seconds + shared)).sqrt() + (of_low * cost).sqrt()).powi(2)
    };
    let all = lows.iter().map(of_low).enumerate().filter(|(_, cost)| *cost < alone);
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// The accuracy of the indices at a stage of a run.
#[derive(Debug, Clone, PartialEq)]
struct Stage {
    /// Largest half width of the indices of all outputs; `None` if some are missing.
    widest: Option<f64>,
    /// Whether plain indices are accurate enough to contradict corrected ones.
    is_checked: bool,
    /// Squared errors of the output with this half width: due to the model's rows, and to a low-fidelity model's runs.
    squared_errors: [f64; 2],
    /// The surrogate estimates of every output.
    surrogates: Vec<Option<SurrogateEstimates>>,
}

/// Computes the stage that `run` has reached with `lows`. Outputs that do not vary have no indices and are ignored.
fn stage(study: &Study, run: &GrowingRun<'_>, lows: &[LowRun<'_>]) -> Stage {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, options) = (study.layout(), interval_options(study));
    let mut all = Stage { widest: None, is_checked: true, squared_errors: [0.0; 2], surrogates: Vec::new() };
    let Ok(design) = run.design().with_points(run.points_per_replicate()) else { return all };
    let lows: Vec<_> = lows.iter().map(LowRun::totals).collect();
    let (mut is_known, correlations) = (true, &design.column_correlations());
    all.surrogates = surrogates(study, &design, run.totals(), &lows, &[]);
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].point_outputs).collect();
        let surrogate = all.surrogates.get(number).and_then(Option::as_ref);
        let points = KeptPoints::all(&design, &kept);
        let options = IntervalOptions { points, correlations, surrogate, ranks: false, ..options };
        let found = output_indices(&parts, &layout, &options);
        if let Some(indices) = found.as_ref().ok().filter(|indices| indices.surrogate.is_some()) {
            all.is_checked &= indices.plain_half_width().is_some_and(|half| half <= MAX_PLAIN_HALF_WIDTH);
        }
        match found.map(|indices| indices.largest_half_width()) {
            Ok(Some(widest)) if all.widest.is_none_or(|before| widest > before) => {
                all.widest = Some(widest);
                all.squared_errors = surrogate.map_or([1.0, 0.0], |surrogate| {
                    let shares = surrogate.squared_errors();
                    [shares.model, shares.low_fidelity]
                });
            }
            Ok(Some(_)) | Err(Undefined::ZeroVariance) => (),
            Ok(None) | Err(_) => is_known = false,
        }
    }
    all.widest = all.widest.filter(|_| is_known);
    all
}

/// Returns why the run should stop; `None` if it should be doubled again.
fn reason_to_stop(study: &Study, run: &GrowingRun<'_>, longest: &Design, stage: &Stage) -> Option<StopReason> {
    let widest = stage.widest;
    let Target { accuracy, max_time, max_runs } = study.target;
    let next = run.points_per_replicate() * 2;
    let replicates = longest.settings().replicates;
    let runs = u128::from(next) * u128::from(replicates) * u128::from(longest.rows_per_point());
    let seconds = 2.0 * run.elapsed().as_secs_f64();
    let base_samples = run.points_per_replicate() * replicates;
    // With one replicate there is no spread for any points.
    let has_none =
        replicates < 2 && matches!(study.analysis.intervals, IntervalMethod::Nets | IntervalMethod::Replicates);
    let has_too_few = base_samples >= MIN_BASE_SAMPLES_OF_FAILURES && fails_too_often(study, run);
    let is_met = stage.is_checked && accuracy.zip(widest).is_some_and(|(target, widest)| widest <= target);
    let design = is_met.then(|| longest.with_points(run.points_per_replicate()).ok()).flatten();
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

/// Returns whether more runs failed than an output with indices may have.
fn fails_too_often(study: &Study, run: &GrowingRun<'_>) -> bool {
    let rows = run.points_per_replicate() * run.design().rows_per_point() * run.totals().len() as u64;
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    (0..outputs).any(|number| {
        let failed: u64 = run.totals().iter().map(|totals| totals.outputs[number].runs_failed).sum();
        failed as f64 / rows as f64 > study.analysis.max_failed
    })
}
