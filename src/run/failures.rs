//! Where rows failed and why, in bounded memory: the number of distinct reasons is limited.

use std::collections::BTreeMap;

use crate::design::Design;
use crate::model::RowFailure;
use apportion_base::text::masked;

/// The place of a row in a design, independent of the number of base points. Places are ordered as rows are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RowPosition {
    /// The replicate.
    pub replicate: u64,
    /// The base point in the replicate.
    pub point: u64,
    /// The run within the base point.
    pub run: u64,
}

impl RowPosition {
    /// Returns the row's number in `design`.
    pub fn row(self, design: &Design) -> u64 {
        (self.replicate * design.points_per_replicate() + self.point) * design.rows_per_point() + self.run
    }
}

/// How often something happened, and where first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    /// Number of rows.
    pub count: u64,
    /// The first of them.
    pub first: RowPosition,
}

impl Tally {
    /// Adds the count of other rows.
    pub fn add(&mut self, other: Self) {
        self.count += other.count;
        self.first = self.first.min(other.first);
    }
}

/// Maximum number of reasons that are counted separately.
const MAX_REASONS: usize = 100;

/// The reason shown for rows whose reasons are not counted separately.
const OTHERS: &str = "other reasons";

/// Why rows failed, with the count of each reason.
///
/// If there are more than [`MAX_REASONS`] reasons, every number in them becomes `#`. If there are still more, only the
/// first ones in alphabetical order are counted separately. The result does not depend on the order in which rows are
/// counted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Failures {
    reasons: BTreeMap<RowFailure, Tally>,
    is_masked: bool,
    others: Option<Tally>,
}

impl Failures {
    /// Adds `tally` to `reason`.
    pub fn count(&mut self, reason: &RowFailure, tally: Tally) {
        let reason = if self.is_masked { without_numbers(reason) } else { reason.clone() };
        self.reasons.entry(reason).and_modify(|mine| mine.add(tally)).or_insert(tally);
        if self.reasons.len() > MAX_REASONS && !self.is_masked {
            self.mask();
        }
        // The first reasons in alphabetical order are kept: more rows can only move the others further back.
        while self.reasons.len() > MAX_REASONS
            && let Some((_, last)) = self.reasons.pop_last()
        {
            self.count_others(last);
        }
    }

    /// Adds the counts of other rows.
    pub fn merge(&mut self, other: &Self) {
        if other.is_masked && !self.is_masked {
            self.mask();
        }
        for (reason, tally) in &other.reasons {
            self.count(reason, *tally);
        }
        if let Some(tally) = other.others {
            self.count_others(tally);
        }
    }

    fn mask(&mut self) {
        self.is_masked = true;
        for (reason, tally) in std::mem::take(&mut self.reasons) {
            self.count(&reason, tally);
        }
    }

    fn count_others(&mut self, tally: Tally) {
        self.others.get_or_insert(Tally { count: 0, ..tally }).add(tally);
    }

    /// Iterates over the reasons with their counts in alphabetical order; those not counted separately come last.
    pub fn iter(&self) -> impl Iterator<Item = (RowFailure, Tally)> {
        let others = self.others.map(|tally| (RowFailure::new(OTHERS), tally));
        self.reasons.iter().map(|(reason, tally)| (reason.clone(), *tally)).chain(others)
    }

    /// Returns the reason of the first row that failed.
    pub fn first(&self) -> Option<(RowFailure, Tally)> {
        self.iter().min_by_key(|(_, tally)| tally.first)
    }
}

/// Returns the same on one line with every number as `#`; a masked reason does not change.
fn without_numbers(reason: &RowFailure) -> RowFailure {
    let line: String = reason.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    RowFailure::new(&masked(&line))
}

#[cfg(test)]
#[path = "tests/failures.rs"]
mod tests;
