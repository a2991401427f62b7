//! Sweeps: their record, their document and their charts.

mod document;
mod record;

use apportion::sweep::Sweep;
pub use document::sweep_document;
pub use record::{SweepFile, SweepProvenance, build_sweep};

use crate::document::grouped_by_key;

/// Returns for each output and reason the number of points of the sweep without a value, over all curves.
fn gap_lines(sweep: &Sweep) -> Vec<String> {
    let gaps = sweep.outputs.iter().flat_map(|output| output.gaps.iter().map(|gap| ((&output.name, &gap.reason), gap)));
    let points = sweep.values.len();
    let groups = grouped_by_key(gaps).into_iter();
    groups
        .map(|((name, reason), gaps)| {
            format!("{name} at {} of {points} points of {}: {reason}", gaps.len(), sweep.factor)
        })
        .collect()
}
