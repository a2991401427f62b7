//! When a run that grows has enough.

use super::low_fidelity::LowRun;
use crate::analysis::{StopReason, Stopped, interval_options, surrogates};
use crate::design::Design;
use crate::estimate::{MomentParts, PointOutputs, Undefined};
use crate::run::GrowingRun;
use crate::study::{Study, Target};
use crate::uncertainty::{IntervalMethod, IntervalOptions, KeptPoints, SurrogateEstimates, output_indices};

/// Base samples below which missing intervals say nothing of those of more runs: an output that is rarely anything but 0 may not vary
/// in a net of few points.
const FEW_BASE_SAMPLES: u64 = 1 << 12;

/// The same where so many runs fail that there will be no indices: how many do is known much sooner.
const FEW_BASE_SAMPLES_OF_FAILURES: u64 = 1 << 8;

/// How well the indices are known at some stage of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stage {
    /// Largest half width of the indices of all outputs; `None` if some are missing.
    pub widest: Option<f64>,
    /// Of the output that it belongs to, the squared errors that come from the rows of the model, and those that come from the
    /// runs of a cheaper model.
    pub squared_errors: [f64; 2],
    /// What surrogates and cheaper models made of every output.
    pub surrogates: Vec<Option<SurrogateEstimates>>,
}

/// The stage that `run` has reached with the help of `lows`. An output that does not vary has no indices and waits for none.
pub(super) fn stage(study: &Study, run: &GrowingRun<'_>, lows: &[LowRun<'_>]) -> Stage {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, options) = (study.layout(), interval_options(study));
    let mut all = Stage { widest: None, squared_errors: [0.0; 2], surrogates: Vec::new() };
    let Ok(design) = run.design().with_points(run.points_per_replicate()) else { return all };
    let lows: Vec<_> = lows.iter().map(LowRun::totals).collect();
    let mut is_known = true;
    all.surrogates = surrogates(study, &design, run.totals(), &lows);
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].point_outputs).collect();
        let surrogate = all.surrogates.get(number).and_then(Option::as_ref);
        let points = KeptPoints::all(&design, &kept);
        let options = IntervalOptions { points, surrogate, ranks: false, ..options };
        match output_indices(&parts, &layout, &options).map(|indices| indices.largest_half_width()) {
            Ok(Some(widest)) if all.widest.is_none_or(|before| widest > before) => {
                all.widest = Some(widest);
                all.squared_errors = surrogate.map_or([1.0, 0.0], |surrogate| surrogate.squared_errors());
            }
            Ok(Some(_)) | Err(Undefined::ZeroVariance) => (),
            Ok(None) | Err(_) => is_known = false,
        }
    }
    all.widest = all.widest.filter(|_| is_known);
    all
}

/// Why the run should not be doubled once more; `None` if it should.
pub(super) fn reason_to_stop(
    study: &Study,
    run: &GrowingRun<'_>,
    longest: &Design,
    widest: Option<f64>,
) -> Option<Stopped> {
    let Target { half_width, budget, max_runs, .. } = study.target;
    let next = run.points_per_replicate() * 2;
    let replicates = longest.settings().replicates;
    let runs = u128::from(next) * u128::from(replicates) * u128::from(longest.rows_per_point());
    let seconds = 2.0 * run.elapsed().as_secs_f64();
    let base_samples = run.points_per_replicate() * replicates;
    // Whatever the points, one replicate has no spread.
    let has_none =
        replicates < 2 && matches!(study.analysis.intervals, IntervalMethod::Nets | IntervalMethod::Replicates);
    let has_too_few = base_samples >= FEW_BASE_SAMPLES_OF_FAILURES && fails_too_often(study, run);
    let reason = match (half_width, widest) {
        (Some(_), _) if has_too_few => StopReason::NoIntervals { base_samples },
        (Some(target), Some(widest)) if widest <= target => StopReason::TargetMet { widest, target },
        (Some(_), None) if has_none || base_samples >= FEW_BASE_SAMPLES => StopReason::NoIntervals { base_samples },
        _ if next > longest.points_per_replicate() => StopReason::EndOfSequence,
        _ if run.room_for(next).is_err() => StopReason::Memory,
        _ => match (max_runs, budget) {
            (Some(most), _) if runs > u128::from(most) => StopReason::MaxRuns { runs, most },
            (_, Some(budget)) if seconds > budget => StopReason::Budget { seconds, budget },
            _ => return None,
        },
    };
    let target_met = half_width.map(|_| matches!(reason, StopReason::TargetMet { .. }));
    Some(Stopped { reason, target_met })
}

/// Whether more runs failed than an output with indices may have.
fn fails_too_often(study: &Study, run: &GrowingRun<'_>) -> bool {
    let rows = run.points_per_replicate() * run.design().rows_per_point() * run.totals().len() as u64;
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    (0..outputs).any(|number| {
        let failed: u64 = run.totals().iter().map(|totals| totals.outputs[number].runs_failed).sum();
        failed as f64 / rows as f64 > study.analysis.max_failed
    })
}
