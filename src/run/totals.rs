//! What a run leaves behind: constant in size, merged in a fixed tree.

use std::collections::BTreeMap;

use crate::estimate::Moments;
use crate::model::{Effort, RowFailure};

/// How often something happened, and where first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    /// Number of rows.
    pub count: u64,
    /// Lowest row number of the design among them.
    pub first_row: u64,
}

/// Totals of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputTotals {
    /// Moments of the base points whose rows all have a value: an incomplete base point is left out whole, so that
    /// every index is estimated from the same points.
    pub moments: Moments,
    /// Rows without a value.
    pub runs_failed: u64,
    /// Why, and how often each.
    pub failures: BTreeMap<RowFailure, Tally>,
}

/// Totals of some rows of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Totals {
    /// Rows evaluated.
    pub runs: u64,
    /// Rows that failed in at least one output.
    pub failed_runs: u64,
    /// One entry per output of the model.
    pub outputs: Vec<OutputTotals>,
    /// How many rows raised each validity flag of the model.
    pub flags: Vec<u64>,
    /// What a model with a ladder of fidelities spent.
    pub effort: Effort,
}

impl Totals {
    /// Adds other rows of the same design.
    pub fn merge(&mut self, other: &Self) {
        self.runs += other.runs;
        self.failed_runs += other.failed_runs;
        self.effort.merge(&other.effort);
        for (mine, theirs) in self.flags.iter_mut().zip(&other.flags) {
            *mine += theirs;
        }
        for (mine, theirs) in self.outputs.iter_mut().zip(&other.outputs) {
            mine.moments.merge(&theirs.moments);
            mine.runs_failed += theirs.runs_failed;
            for (failure, tally) in &theirs.failures {
                mine.count(failure.clone(), *tally);
            }
        }
    }
}

impl OutputTotals {
    /// Adds `tally` to the count of `failure`.
    pub fn count(&mut self, failure: RowFailure, tally: Tally) {
        self.failures
            .entry(failure)
            .and_modify(|mine| {
                mine.count += tally.count;
                mine.first_row = mine.first_row.min(tally.first_row);
            })
            .or_insert(tally);
    }
}
