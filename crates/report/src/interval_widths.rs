//! The precision of the indices of a result.

use apportion::result::{OutputResult, StudyResult};

use super::format::printed_half_width;

/// Half width from which an interval says nothing of a share of the variance: it may be as long as the whole range.
pub const WIDE: f64 = 0.5;

/// Returns the largest half width of any first-order or total index of a result at its end, those of several outputs
/// together included; `None` without intervals.
pub fn widest_interval(result: &StudyResult) -> Option<f64> {
    let together = result.aggregate.iter().filter_map(|aggregate| aggregate.indices.as_ref());
    let together = together.chain(result.series.iter().filter_map(|series| series.indices.as_ref())).flatten();
    let together = together.flat_map(|index| [index.first_order, index.total]).filter_map(printed_half_width);
    let widest = result.outputs.iter().filter_map(widest_of).reduce(f64::max)?;
    Some(together.fold(widest, f64::max))
}

/// Returns the same for an output, not less than any half width in its table: that of the longer side, rounded.
pub fn widest_of(output: &OutputResult) -> Option<f64> {
    let widest = output.convergence.last()?.largest_half_width?;
    let indices = output.indices.iter().flatten();
    let all = indices.flat_map(|index| [index.effect.first_order, index.effect.total]);
    Some(all.filter_map(printed_half_width).fold(widest, f64::max))
}

/// Names the indices that these half widths include: not second order, and not the mean over the noise.
pub fn indices_measured(outputs: &[OutputResult]) -> &'static str {
    let pairs = outputs.iter().any(|output| output.second_order.is_some());
    let noise = outputs.iter().any(|output| output.noise.is_some());
    match (pairs, noise) {
        (false, false) => "every index",
        (true, false) => "every first-order and total index",
        (false, true) => "every index of the values",
        (true, true) => "every first-order and total index of the values",
    }
}
