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
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn tally(point: u64) -> Tally {
        Tally { count: 1, first: RowPosition { replicate: 0, point, run: 0 } }
    }

    fn counted(reasons: &[(u64, String)]) -> Failures {
        let mut failures = Failures::default();
        reasons.iter().for_each(|(point, reason)| failures.count(&RowFailure::new(reason), tally(*point)));
        failures
    }

    #[test]
    fn reasons_with_numbers_in_them_are_one() {
        let reasons = |count: u64| -> Vec<(u64, String)> {
            (0..count).map(|k| (k, format!("no root at t = {}.5, x = -{k}e-3", k * k))).collect()
        };
        let few = counted(&reasons(MAX_REASONS as u64));
        assert_eq!(few.iter().count(), MAX_REASONS);
        let many = counted(&reasons(100_000));
        let listed: Vec<_> = many.iter().map(|(reason, tally)| (reason.to_string(), tally.count)).collect();
        assert_eq!(listed, [("no root at t = #, x = #".to_owned(), 100_000)]);
        assert_eq!(many.first().unwrap().1.first.point, 0);
    }

    #[test]
    fn only_the_first_reasons_are_counted_separately() {
        let word =
            |k: u32| [k / 26 % 26, k % 26].map(|place| char::from(b'a' + place as u8)).iter().collect::<String>();
        let all = counted(&(0..300).rev().map(|k| (u64::from(k), word(k))).collect::<Vec<_>>());
        let listed: Vec<_> = all.iter().collect();
        assert_eq!(listed.len(), MAX_REASONS + 1);
        assert!(listed[..MAX_REASONS].iter().enumerate().all(|(k, (reason, _))| reason.to_string() == word(k as u32)));
        assert_eq!(
            (listed[100].0.to_string().as_str(), listed[100].1.count, listed[100].1.first.point),
            (OTHERS, 200, 100)
        );
    }

    proptest! {
        /// The result does not depend on where failures are counted, or on the order of merging.
        #[test]
        fn the_order_does_not_count(
            reasons in prop::collection::vec("[ab\u{1}#-]{0,2}[0-9]{1,2}[cd]{0,3}", 0..400),
            parts in prop::collection::vec(0_usize..5, 400),
        ) {
            let reasons: Vec<(u64, String)> = (0..).zip(reasons).collect();
            let all = counted(&reasons);
            let of_part = |part: usize| {
                counted(&reasons.iter().filter(|(k, _)| parts[*k as usize] == part).cloned().collect::<Vec<_>>())
            };
            for order in [[0, 1, 2, 3, 4], [4, 2, 0, 1, 3]] {
                let mut merged = Failures::default();
                order.iter().for_each(|part| merged.merge(&of_part(*part)));
                prop_assert_eq!(&merged, &all);
            }
        }
    }
}
