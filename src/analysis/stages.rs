//! The change of estimates and intervals as a run grew, computed from its parts at the end.

use super::output_indices::{IntervalOptions, OutputIndices, output_indices};
use crate::correction::SurrogateEstimates;
use crate::effect::Layout;
use crate::estimate::MomentParts;

/// The indices of an output when the run had fewer base points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stage {
    /// Total number of base points.
    pub base_samples: u64,
    /// The indices at that stage.
    pub indices: OutputIndices,
}

/// Minimum number of parts of a replicate in a stage: fewer reveal almost nothing about its error.
const MIN_PARTS: usize = 4;

/// Returns the number of parts of a replicate in each stage but the last, in ascending order.
fn sizes_of_stages(replicates: &[&MomentParts]) -> Vec<usize> {
    let parts = replicates.iter().map(|replicate| replicate.parts().len()).min().unwrap_or(0);
    let mut sizes = Vec::new();
    // Down from the largest power of two below all points: prefixes of a net are nets.
    let mut size = parts.next_power_of_two() / 2;
    while size >= MIN_PARTS {
        sizes.push(size);
        size /= 2;
    }
    sizes.reverse();
    sizes
}

/// Returns the maximum number of base points of a replicate at each stage but the last.
pub(super) fn points_of_stages(replicates: &[&MomentParts]) -> Vec<u64> {
    let mut points = Vec::new();
    for size in sizes_of_stages(replicates) {
        points.push(replicates.iter().map(|replicate| replicate.prefix(size).points()).max().unwrap_or(0));
    }
    points
}

/// Returns the stages of a run at each half of the one after it, `last` at the end: every prefix of the parts of each
/// replicate is a run of its own. `surrogate` returns the surrogate estimates for a number of first base points of each
/// replicate. Stages without indices are left out.
pub(super) fn stages<'s>(
    replicates: &[&MomentParts],
    layout: &Layout,
    options: &IntervalOptions<'_>,
    last: &OutputIndices,
    surrogate: &dyn Fn(u64) -> Option<&'s SurrogateEstimates>,
) -> Vec<Stage> {
    let mut stages = Vec::new();
    for size in sizes_of_stages(replicates) {
        let prefix: Vec<MomentParts> = replicates.iter().map(|replicate| replicate.prefix(size)).collect();
        let base_samples = prefix.iter().map(MomentParts::points).sum();
        let longest = prefix.iter().map(MomentParts::points).max().unwrap_or(0);
        let options = IntervalOptions {
            points: options.points.map(|points| points.prefix(longest)),
            surrogate: surrogate(longest),
            draws: 0,
            ..*options
        };
        if let Ok(indices) = output_indices(&prefix.iter().collect::<Vec<_>>(), layout, &options) {
            stages.push(Stage { base_samples, indices });
        }
    }
    let base_samples = replicates.iter().map(|of| of.points()).sum();
    stages.push(Stage { base_samples, indices: last.clone() });
    stages
}
