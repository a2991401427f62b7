//! Parts of a design, for several machines.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use thiserror::Error;

use crate::design::Design;

/// Maximum number of parts.
const MAX_SHARDS: u64 = 1_000_000;

/// One of several parts of a design, as equal as possible: consecutive base points with all of their rows.
///
/// ```
/// use apportion::Shard;
///
/// let shard: Shard = "3/8".parse()?;
/// assert_eq!((shard.number(), shard.count()), (3, 8));
/// # Ok::<(), apportion::ShardError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    count: u64,
}

/// The error for a text that is not a valid part `k/n`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected a shard such as 3/8, the third of eight (1/8 to 8/8; at most {MAX_SHARDS} shards), not {text:?}")]
pub struct ShardError {
    text: String,
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let parsed = text.split_once('/').and_then(|(number, count)| Some((number.parse().ok()?, count.parse().ok()?)));
        match parsed {
            Some((number, count)) if (1..=count).contains(&number) && count <= MAX_SHARDS => Ok(Self { number, count }),
            _ => Err(ShardError { text: text.to_owned() }),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl Shard {
    /// Returns its number, from 1.
    pub fn number(self) -> u64 {
        self.number
    }

    /// Returns the number of parts.
    pub fn count(self) -> u64 {
        self.count
    }

    /// Returns its rows of `design`, as (replicate, rows in it); none if there are more parts than base points.
    pub fn rows(self, design: &Design) -> Vec<(u64, Range<u64>)> {
        let (all, per_replicate) = (design.settings().base_samples, design.points_per_replicate());
        let points = quotient(self.number - 1, all, self.count)..quotient(self.number, all, self.count);
        (points.start / per_replicate..points.end.div_ceil(per_replicate))
            .filter_map(|replicate| {
                let first = replicate * per_replicate;
                let part = points.start.max(first) - first..points.end.min(first + per_replicate) - first;
                let rows = part.start * design.rows_per_point()..part.end * design.rows_per_point();
                (!rows.is_empty()).then_some((replicate, rows))
            })
            .collect()
    }
}

/// Computes `a * b / divisor` without overflow.
pub(super) fn quotient(a: u64, b: u64, divisor: u64) -> u64 {
    (u128::from(a) * u128::from(b) / u128::from(divisor)) as u64
}

#[cfg(test)]
#[path = "tests/shard.rs"]
mod tests;
