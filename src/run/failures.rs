//! Where rows failed and why, in bounded size: reasons are counted, however many of them a model has.

use std::collections::BTreeMap;

use crate::binary::{Binary, Reader, binary_fields};
use crate::design::Design;
use crate::model::RowFailure;
use crate::model::shorten::masked;

/// Where a row stands in a design, however many base points that has. Places are ordered as rows are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Its replicate.
    pub replicate: u64,
    /// Its base point in the replicate.
    pub point: u64,
    /// Which of the base point's runs it is.
    pub run: u64,
}

impl Place {
    /// The row's number in `design`.
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
    pub first: Place,
}

impl Tally {
    /// Adds what happened in other rows.
    pub fn add(&mut self, other: Self) {
        self.count += other.count;
        self.first = self.first.min(other.first);
    }
}

binary_fields!(Tally { count, first });
binary_fields!(Place { replicate, point, run });

/// Most reasons that are told apart.
pub const MOST_REASONS: usize = 100;

/// What is said of rows whose reasons are not told apart.
const OTHERS: &str = "other reasons";

/// Why rows failed, and how often each.
///
/// More than [`MOST_REASONS`] reasons differ by numbers of their rows: every number in them then becomes `#`. If that leaves more, the
/// first ones in the order of letters are told apart. What is left does not depend on the order in which rows are counted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Failures {
    reasons: BTreeMap<RowFailure, Tally>,
    is_masked: bool,
    others: Option<Tally>,
}

impl Failures {
    /// Counts `tally` for `reason`.
    pub fn count(&mut self, reason: &RowFailure, tally: Tally) {
        let reason = if self.is_masked { without_numbers(reason) } else { reason.clone() };
        self.reasons.entry(reason).and_modify(|mine| mine.add(tally)).or_insert(tally);
        if self.reasons.len() > MOST_REASONS && !self.is_masked {
            self.mask();
        }
        // The first reasons in the order of their texts are kept: more rows can only move the others further back.
        while self.reasons.len() > MOST_REASONS
            && let Some((_, last)) = self.reasons.pop_last()
        {
            self.count_others(last);
        }
    }

    /// Adds what was counted over other rows.
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
        self.others = Some(self.others.map_or(tally, |mut mine| {
            mine.add(tally);
            mine
        }));
    }

    /// Every reason with its count, in the order of letters, and at last those that are not told apart.
    pub fn iter(&self) -> impl Iterator<Item = (RowFailure, Tally)> {
        let others = self.others.map(|tally| (RowFailure::new(OTHERS), tally));
        self.reasons.iter().map(|(reason, tally)| (reason.clone(), *tally)).chain(others)
    }

    /// The reason of the first row that failed.
    pub fn first(&self) -> Option<(RowFailure, Tally)> {
        self.iter().min_by_key(|(_, tally)| tally.first)
    }
}

/// The same on one line with every number as `#`; what was masked before stays what it is.
fn without_numbers(reason: &RowFailure) -> RowFailure {
    let line: String = reason.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    RowFailure::new(&masked(&line))
}

/// Two reasons that no row has, written among the others: numbers in reasons are masked; and so many rows have reasons that are not
/// told apart. An older program reads them as reasons.
const MASKED_MARK: &str = "\u{1}masked";
const OTHERS_MARK: &str = "\u{1}other reasons";

impl Binary for Failures {
    fn write(&self, out: &mut Vec<u8>) {
        let mut reasons = self.reasons.clone();
        if self.is_masked {
            let first = Place { replicate: 0, point: 0, run: 0 };
            reasons.insert(RowFailure::new(MASKED_MARK), Tally { count: 0, first });
        }
        reasons.extend(self.others.map(|tally| (RowFailure::new(OTHERS_MARK), tally)));
        reasons.write(out);
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let mut reasons: BTreeMap<RowFailure, Tally> = BTreeMap::read(from)?;
        let mark = RowFailure::new(MASKED_MARK);
        let is_masked = reasons.get(&mark).is_some_and(|tally| tally.count == 0);
        if is_masked {
            reasons.remove(&mark);
        }
        let others = if is_masked { reasons.remove(&RowFailure::new(OTHERS_MARK)) } else { None };
        if is_masked {
            return Some(Self { reasons, is_masked, others });
        }
        // Of a journal of before, which may have any number of them.
        let mut failures = Self::default();
        reasons.iter().for_each(|(reason, tally)| failures.count(reason, *tally));
        Some(failures)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn tally(point: u64) -> Tally {
        Tally { count: 1, first: Place { replicate: 0, point, run: 0 } }
    }

    fn counted(reasons: &[(u64, String)]) -> Failures {
        let mut failures = Failures::default();
        reasons.iter().for_each(|(point, reason)| failures.count(&RowFailure::new(reason), tally(*point)));
        failures
    }

    fn read_back(failures: &Failures) -> Failures {
        let mut bytes = Vec::new();
        failures.write(&mut bytes);
        Failures::read(&mut Reader { bytes: &bytes }).unwrap()
    }

    #[test]
    fn reasons_with_numbers_in_them_are_one() {
        let reasons = |count: u64| -> Vec<(u64, String)> {
            (0..count).map(|k| (k, format!("no root at t = {}.5, x = -{k}e-3", k * k))).collect()
        };
        let few = counted(&reasons(MOST_REASONS as u64));
        assert_eq!(few.iter().count(), MOST_REASONS);
        let many = counted(&reasons(100_000));
        let found: Vec<_> = many.iter().map(|(reason, tally)| (reason.to_string(), tally.count)).collect();
        assert_eq!(found, [("no root at t = #, x = #".to_owned(), 100_000)]);
        assert_eq!(many.first().unwrap().1.first.point, 0);
        for failures in [few, many] {
            assert_eq!(read_back(&failures), failures);
        }
    }

    #[test]
    fn of_more_words_than_that_the_first_are_told_apart() {
        let word =
            |k: u32| [k / 26 % 26, k % 26].map(|place| char::from(b'a' + place as u8)).iter().collect::<String>();
        let all = counted(&(0..300).rev().map(|k| (u64::from(k), word(k))).collect::<Vec<_>>());
        let found: Vec<_> = all.iter().collect();
        assert_eq!(found.len(), MOST_REASONS + 1);
        assert!(found[..MOST_REASONS].iter().enumerate().all(|(k, (reason, _))| reason.to_string() == word(k as u32)));
        assert_eq!(
            (found[100].0.to_string().as_str(), found[100].1.count, found[100].1.first.point),
            (OTHERS, 200, 100)
        );
        assert_eq!(read_back(&all), all);
    }

    proptest! {
        /// Whatever is counted where, and in which order it is merged, the same is left.
        #[test]
        fn the_order_does_not_count(
            reasons in prop::collection::vec("[ab\u{1}#-]{0,2}[0-9]{1,2}[cd]{0,3}", 0..400),
            parts in prop::collection::vec(0_usize..5, 400),
        ) {
            let reasons: Vec<(u64, String)> = (0..).zip(reasons).collect();
            let whole = counted(&reasons);
            let of_part = |part: usize| {
                counted(&reasons.iter().filter(|(k, _)| parts[*k as usize] == part).cloned().collect::<Vec<_>>())
            };
            for order in [[0, 1, 2, 3, 4], [4, 2, 0, 1, 3]] {
                let mut merged = Failures::default();
                order.iter().for_each(|part| merged.merge(&read_back(&of_part(*part))));
                prop_assert_eq!(&merged, &whole);
            }
        }
    }
}
