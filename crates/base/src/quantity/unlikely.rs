//! Detection of unlikely values: codes for missing ones, and errors.

use serde::{Deserialize, Serialize};

use super::is_same;

/// Numbers that programs write for missing values; the last two are NetCDF's fill values (single, double).
const CODES: [f64; 12] =
    [-999.0, 999.0, -9999.0, 9999.0, -99999.0, 99999.0, -999999.0, 999999.0, 1e20, -1e20, 9.96921e36, DOUBLE_FILL];
const DOUBLE_FILL: f64 = 9.969_209_968_386_869e36;

/// Distance of an extreme value from all others, in their range, above which it is unlikely by itself.
const FAR: f64 = 1e3;

/// Minimum number of different values of the others: fewer are steps, of which one may be large.
const MIN_VALUES: usize = 10;

/// Smallest number of times that a value recurs among values that differ, and the part of the values that it is, from
/// which it may be a code.
const MIN_COUNT: usize = 5;
const MIN_SHARE: f64 = 0.002;

/// Distance from the range of the others, in its width, up to which a value may be the limit at which outputs are cut.
const CUT: f64 = 0.02;

/// A value that may not come from the model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Unlikely {
    /// The value.
    pub value: f64,
    /// How often it occurs.
    pub count: usize,
    /// Index of its first occurrence, from 0.
    pub first: usize,
    /// Number of finite values.
    pub of: usize,
    /// The smallest and the largest of the others.
    pub others: (f64, f64),
}

impl Unlikely {
    /// Returns the smallest or largest of the finite `values`, if it is such a code and stands out or is repeated
    /// among values that differ, or if it is far from all others.
    pub fn find(values: &[f64]) -> Option<Self> {
        Self::extreme(&finite_in_order(values), &|value| first_of(values, value))
    }

    /// Returns the same of `values` of independent rows; or any value that occurs many times among values that all differ,
    /// unless it is a limit of their range.
    pub fn find_in_rows(values: &[f64]) -> Option<Self> {
        Self::find_in_sorted_rows(&finite_in_order(values), &|value| first_of(values, value))
    }

    /// Returns the same, given the finite values in rising order, and where each occurs first.
    pub fn find_in_sorted_rows(sorted: &[f64], first: &dyn Fn(f64) -> Option<usize>) -> Option<Self> {
        Self::extreme(sorted, first).or_else(|| Self::repeated(sorted, first))
    }

    /// Returns the smallest or largest value, if it is a code or far from all others.
    fn extreme(sorted: &[f64], first: &dyn Fn(f64) -> Option<usize>) -> Option<Self> {
        let of = sorted.len();
        let lowest = sorted.partition_point(|value| *value <= sorted[0]);
        let highest = sorted.partition_point(|value| *value < sorted[of - 1]);
        let ends = [(*sorted.first()?, &sorted[lowest..]), (*sorted.last()?, &sorted[..highest])];
        ends.into_iter().find_map(|(value, rest)| {
            let others = (*rest.first()?, *rest.last()?);
            let width = others.1 - others.0;
            let gap = (value - others.0).abs().min((value - others.1).abs());
            let is_code = CODES.iter().any(|code| is_same(*code, value));
            if !(is_code || gap > FAR * width) {
                return None;
            }
            let distinct = rest.chunk_by(|a, b| a == b).count();
            let count = of - rest.len();
            let stands_out = gap > width || count > 1 && 2 * distinct > rest.len();
            let is_unlikely = distinct >= MIN_VALUES && 2 * count <= of && stands_out;
            if is_unlikely { Some(Self { value, count, first: first(value)?, of, others }) } else { None }
        })
    }

    /// Returns the value that alone occurs many times.
    fn repeated(sorted: &[f64], first: &dyn Fn(f64) -> Option<usize>) -> Option<Self> {
        let runs = sorted.chunk_by(|a, b| a == b);
        let longest = runs.clone().max_by_key(|run| run.len())?;
        let (value, count, of, distinct) = (longest[0], longest.len(), sorted.len(), runs.count());
        let (lowest, highest) = (sorted[0], sorted[of - 1]);
        let is_many = count >= MIN_COUNT.max((MIN_SHARE * of as f64) as usize) && 2 * count <= of;
        let all_differ = distinct >= MIN_VALUES && distinct - 1 == of - count;
        if !(is_many && all_differ) {
            return None;
        }
        let low = if value == lowest { sorted[count] } else { lowest };
        let high = if value == highest { sorted[of - count - 1] } else { highest };
        let is_limit = (-0.0..=CUT * (high - low)).contains(&(low - value).max(value - high));
        if is_limit { None } else { Some(Self { value, count, first: first(value)?, of, others: (low, high) }) }
    }

    /// Describes it in a table; `row` is the row of its first occurrence, from 1.
    pub fn in_table(&self, row: usize) -> String {
        format!("{}, read it as one", self.words("row", row))
    }

    /// Describes it in runs; `run` is the number of the run of its first occurrence, from 1.
    pub fn in_runs(&self, run: usize) -> String {
        format!("{}, let the model report a failed run there", self.words("run", run))
    }

    fn words(&self, what: &str, first: usize) -> String {
        let Self { value, count, of, others: (low, high), .. } = self;
        format!(
            "the value {value:?} occurs in {count} of {of} {what}s (the first is {what} {first}), and all others lie between \
             {low:?} and {high:?}: if it marks a missing value"
        )
    }
}

fn finite_in_order(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

fn first_of(values: &[f64], value: f64) -> Option<usize> {
    values.iter().position(|other| *other == value)
}

#[cfg(test)]
#[path = "tests/unlikely.rs"]
mod tests;
