//! When a run that grows has enough.

use crate::analysis::{StopReason, Stopped, interval_options, surrogate};
use crate::design::{Design, MAX_POINTS};
use crate::estimate::{MomentParts, PointOutputs};
use crate::run::GrowingRun;
use crate::study::{Study, Target};
use crate::uncertainty::{IntervalOptions, KeptPoints, output_indices};

/// The longest design that a run of `design` can grow into.
pub(super) fn longest(design: &Design) -> Design {
    let mut points = MAX_POINTS;
    loop {
        match design.with_points(points) {
            Ok(longest) => return longest,
            Err(_) if points > design.points_per_replicate() => points /= 2,
            Err(_) => return design.clone(),
        }
    }
}

/// Why the run should not be doubled once more; `None` if it should.
pub(super) fn reason_to_stop(study: &Study, run: &GrowingRun<'_>, longest: &Design) -> Option<Stopped> {
    let Target { half_width, budget, max_runs } = study.target;
    let widest = widest(study, run);
    let met = half_width.map(|target| widest.is_some_and(|widest| widest <= target));
    let next = run.points_per_replicate() * 2;
    let runs = u128::from(next) * u128::from(longest.settings().replicates) * u128::from(longest.rows_per_point());
    let seconds = 2.0 * run.elapsed().as_secs_f64();
    let reason = match (half_width, widest) {
        (Some(target), Some(widest)) if widest <= target => StopReason::TargetMet { widest, target },
        (Some(_), None) => StopReason::NoIntervals,
        _ if next > longest.points_per_replicate() => StopReason::EndOfSequence,
        _ if run.room_for(next).is_err() => StopReason::Memory,
        _ => match (max_runs, budget) {
            (Some(most), _) if runs > u128::from(most) => StopReason::MaxRuns { runs, most },
            (_, Some(budget)) if seconds > budget => StopReason::Budget { seconds, budget },
            _ => return None,
        },
    };
    Some(Stopped { reason, target_met: met })
}

/// Largest half width of the indices of all outputs; `None` if some are missing. An output that does not vary has no
/// indices and waits for none.
fn widest(study: &Study, run: &GrowingRun<'_>) -> Option<f64> {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, options) = (study.layout(), interval_options(study));
    let design = run.design();
    let mut widest = None;
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].point_outputs).collect();
        let surrogate = surrogate(study, design, &kept);
        let points = KeptPoints::all(design, &kept);
        let options = IntervalOptions { points, surrogate: surrogate.as_ref(), ..options };
        match output_indices(&parts, &layout, &options) {
            Ok(indices) => widest = Some(indices.largest_half_width()?.max(widest.unwrap_or(0.0))),
            Err(crate::estimate::Undefined::ZeroVariance) => (),
            Err(_) => return None,
        }
    }
    widest
}
