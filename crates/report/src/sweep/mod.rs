//! Sweeps: their record, their document and their charts.

mod charts;
mod document;
mod record;

use apportion::sweep::Sweep;
pub use document::sweep_document;
pub use record::{SweepFile, SweepProvenance, build_sweep};

/// Returns for each output and reason the number of points of the sweep without a value, over all curves.
fn gap_lines(sweep: &Sweep) -> Vec<String> {
    let mut counts: Vec<(&str, &str, usize)> = Vec::new();
    for output in &sweep.outputs {
        for gap in &output.gaps {
            match counts.iter_mut().find(|(name, reason, _)| *name == output.name && *reason == gap.reason) {
                Some((_, _, count)) => *count += 1,
                None => counts.push((&output.name, &gap.reason, 1)),
            }
        }
    }
    let points = sweep.values.len();
    let line = |(name, reason, count): (&str, &str, usize)| {
        format!("{name} at {count} of {points} points of {}: {reason}", sweep.factor)
    };
    counts.into_iter().map(line).collect()
}
