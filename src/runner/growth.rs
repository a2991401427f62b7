//! When a run that grows has enough.

use crate::design::{Design, MAX_POINTS};
use crate::estimate::{MomentParts, PointOutputs};
use crate::report::{StoppingRecord, judgement};
use crate::run::GrowingRun;
use crate::study::{Stopping, Study};
use crate::uncertainty::{Judgement, KeptPoints, output_indices};

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
pub(super) fn reason_to_stop(study: &Study, run: &GrowingRun<'_>, longest: &Design) -> Option<StoppingRecord> {
    let Stopping { half_width, budget, max_runs } = study.stopping;
    let widest = widest(study, run);
    let met = half_width.map(|target| widest.is_some_and(|widest| widest <= target));
    let end = |reason: String| StoppingRecord {
        reason,
        target_met: met,
        target_half_width: half_width,
        budget_seconds: budget,
        max_runs,
    };
    if let (Some(true), Some(target), Some(widest)) = (met, half_width, widest) {
        return Some(end(format!("every half width is {widest:.2e} or less: the target of {target} is met")));
    }
    if half_width.is_some() && widest.is_none() {
        return Some(end("there are indices or intervals missing: no number of runs would meet the target".to_owned()));
    }
    let next = run.points_per_replicate() * 2;
    let runs = u128::from(next) * u128::from(longest.settings().replicates) * u128::from(longest.rows_per_point());
    if next > longest.points_per_replicate() {
        return Some(end("the sequence of points has come to its end".to_owned()));
    }
    if run.room_for(next).is_err() {
        return Some(end(
            "the outputs of twice the runs would not fit: these intervals need all of them at once".to_owned()
        ));
    }
    if let Some(most) = max_runs.filter(|most| runs > u128::from(*most)) {
        return Some(end(format!("twice the runs would be {runs}, more than max_runs = {most}")));
    }
    let elapsed = run.elapsed().as_secs_f64();
    if let Some(budget) = budget.filter(|budget| 2.0 * elapsed > *budget) {
        return Some(end(format!(
            "twice the runs would take some {:.1} s, more than the budget of {budget} s",
            2.0 * elapsed
        )));
    }
    None
}

/// Largest half width of the indices of all outputs; `None` if some are missing. An output that does not vary has no
/// indices and waits for none.
fn widest(study: &Study, run: &GrowingRun<'_>) -> Option<f64> {
    let outputs = run.totals().first().map_or(0, |totals| totals.outputs.len());
    let (layout, judgement) = (study.layout(), judgement(study));
    let design = run.design();
    let mut widest = None;
    for number in 0..outputs {
        let parts: Vec<MomentParts> = run.totals().iter().map(|t| t.outputs[number].moments.clone()).collect();
        let kept: Vec<&PointOutputs> = run.totals().iter().map(|t| &t.outputs[number].kept).collect();
        let judgement = Judgement { points: KeptPoints::all(design, &kept), ..judgement };
        match output_indices(&parts, &layout, &judgement) {
            Ok(indices) => widest = Some(indices.largest_half_width()?.max(widest.unwrap_or(0.0))),
            Err(crate::estimate::Undefined::ZeroVariance) => (),
            Err(_) => return None,
        }
    }
    widest
}
