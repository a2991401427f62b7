//! The totals of a run: constant in size unless outputs are kept, merged in a fixed tree.

use super::failures::{Failures, RowPosition};
use crate::estimate::{CentralMoments, MomentParts, PointOutputs};
use crate::model::{Counts, Model, RowFailure};

/// Base points of a design, over all replicates, whose outputs are kept in [`OutputTotals::sample`], unless there are very
/// many outputs.
pub(crate) const SAMPLE: u64 = 1 << 15;

/// Number of outputs above which fewer base points are kept of each, and their smallest number.
const WELL_SAMPLED_OUTPUTS: u64 = 64;
const SMALLEST_SAMPLE: u64 = 1 << 11;

/// Returns the number of base points of each replicate, at least one, that are kept of each of `outputs` outputs.
pub(super) fn sampled_points(outputs: usize, replicates: u64) -> u64 {
    let points = SAMPLE * WELL_SAMPLED_OUTPUTS / (outputs as u64).max(WELL_SAMPLED_OUTPUTS);
    (points.max(SMALLEST_SAMPLE) / replicates).max(1)
}

/// Totals of one output.
#[derive(Debug, Clone, Default)]
pub struct OutputTotals {
    /// The moments for the indices, each over every base point at which the rows that it needs have a value.
    pub moments: MomentParts,
    /// Moments of every value of the rows A and B.
    pub values: CentralMoments,
    /// Outputs of the rows A and B of the first [`SAMPLE`]/replicates base points of each replicate (fewer of very many outputs), in
    /// the order of the points: A, B, A, B, ...; NaN where a run failed.
    pub sample: Vec<f64>,
    /// The outputs of every run, if they are kept.
    pub point_outputs: PointOutputs,
    /// Rows without a value.
    pub runs_failed: u64,
    /// Why, with the count of each reason.
    pub failures: Failures,
}

/// Totals of some rows of a design.
#[derive(Debug, Clone)]
pub struct Totals {
    /// Rows evaluated.
    pub runs: u64,
    /// Rows that failed in at least one output.
    pub failed_runs: u64,
    /// One entry per output of the model.
    pub outputs: Vec<OutputTotals>,
    /// How many rows raised each validity flag of the model.
    pub flags: Vec<u64>,
    /// The model's counters.
    pub counts: Counts,
}

impl Totals {
    /// Returns the totals of no rows through `model`.
    pub fn none(model: &dyn Model) -> Self {
        Self {
            runs: 0,
            failed_runs: 0,
            outputs: vec![OutputTotals::default(); model.outputs().len()],
            flags: vec![0; model.flags().len()],
            counts: Counts::new(model.counters()),
        }
    }

    /// Returns the first row that failed, and why.
    pub(super) fn first_failure(&self) -> Option<(RowPosition, RowFailure)> {
        let failures = self.outputs.iter().filter_map(|output| output.failures.first());
        let (reason, tally) = failures.min_by_key(|(_, tally)| tally.first)?;
        Some((tally.first, reason))
    }

    /// Adds the rows that follow in the same replicate.
    pub fn merge(&mut self, other: Self) {
        self.add_counts(&other);
        for (mine, theirs) in self.outputs.iter_mut().zip(other.outputs) {
            mine.moments.append(theirs.moments);
            mine.sample.extend(theirs.sample);
            mine.point_outputs.append(theirs.point_outputs);
        }
    }

    /// Adds the counts over the rows of another replicate: everything but moments, samples and kept outputs, which
    /// belong to their replicate.
    pub fn add_counts(&mut self, other: &Self) {
        self.runs += other.runs;
        self.failed_runs += other.failed_runs;
        self.counts.merge(&other.counts);
        for (mine, theirs) in self.flags.iter_mut().zip(&other.flags) {
            *mine += theirs;
        }
        for (mine, theirs) in self.outputs.iter_mut().zip(&other.outputs) {
            mine.values.merge(&theirs.values);
            mine.runs_failed += theirs.runs_failed;
            mine.failures.merge(&theirs.failures);
        }
    }
}
