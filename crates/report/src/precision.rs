//! How precise indices are: the half widths of their intervals.

use apportion::result::{OutputResult, StopReason, StoppingRecord};

use super::format::{PrintedEstimate, grouped, two_digits};
use super::output_view::{OutputView, effects};

/// States the precision of the indices, and the number of runs.
pub(super) fn precision_sentence(view: &OutputView<'_>) -> String {
    let widest = widest_interval(view);
    let target = target(view.result.stopping.as_ref());
    let runs = grouped(view.result.provenance.model_runs);
    match widest {
        None => format!("The study took {runs} model runs; the error of the indices is unknown{target}."),
        Some(widest) if widest < WIDE => {
            let which = indices_measured(view.all_outputs());
            format!("After {runs} model runs {which} is known to ± {} or better{target}.", two_digits(widest))
        }
        Some(_) => format!("After {runs} model runs the intervals are too wide to determine the indices{target}."),
    }
}

/// States whether the target is met, or what the precision does not show.
fn target(stopping: Option<&StoppingRecord>) -> String {
    let Some(StoppingRecord { target_met: Some(is_met), target_half_width, reason, .. }) = stopping else {
        return String::new();
    };
    match (is_met, reason, target_half_width) {
        (true, ..) => "; the target is met".to_owned(),
        (false, StopReason::RareLevels { .. }, _) => {
            ", but a level of a factor is in too few rows to rely on it".to_owned()
        }
        (false, _, Some(target)) => format!("; the target of {target} is not met"),
        (false, ..) => "; the target is not met".to_owned(),
    }
}

/// Half width from which an interval says nothing of a share of the variance: it may be as long as the whole range.
pub(super) const WIDE: f64 = 0.5;

/// Returns the largest half width of any first-order or total index at the end of the run, those of several outputs
/// together included; `None` without intervals.
pub(super) fn widest_interval(view: &OutputView<'_>) -> Option<f64> {
    let widest = view.all_outputs().filter_map(widest_of).reduce(f64::max)?;
    let series = view.series.iter().flat_map(|series| series.indices.iter().flatten());
    let together = view.together_indices().iter().chain(series);
    let together = together.flat_map(|index| [index.effect.first_order, index.effect.total]);
    Some(together.filter_map(|index| PrintedEstimate::new(index).half_width()).fold(widest, f64::max))
}

/// Returns the same for an output, not less than any half width in its table: that of the longer side, rounded.
pub(super) fn widest_of(output: &OutputResult) -> Option<f64> {
    let widest = output.largest_half_width()?;
    let indices = effects(output).flat_map(|(_, effect)| [effect.first_order, effect.total]);
    Some(indices.filter_map(|index| PrintedEstimate::new(index).half_width()).fold(widest, f64::max))
}

/// Names the indices that these half widths include: not second order, and not the mean over the noise.
pub(super) fn indices_measured<'a>(outputs: impl IntoIterator<Item = &'a OutputResult>) -> &'static str {
    let (mut pairs, mut noise) = (false, false);
    for output in outputs {
        pairs |= output.second_order.is_some();
        noise |= output.noise.is_some();
    }
    match (pairs, noise) {
        (false, false) => "every index",
        (true, false) => "every first-order and total index",
        (false, true) => "every index of the values",
        (true, true) => "every first-order and total index of the values",
    }
}
