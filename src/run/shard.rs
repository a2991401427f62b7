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
    of: u64,
}

/// The error for a text that is not a valid part `k/n`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected a shard such as 3/8, the third of eight (1/8 to 8/8; at most {MAX_SHARDS} shards), not {found:?}")]
pub struct ShardError {
    found: String,
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let parsed = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parsed {
            Some((number, of)) if (1..=of).contains(&number) && of <= MAX_SHARDS => Ok(Self { number, of }),
            _ => Err(ShardError { found: text.to_owned() }),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Shard {
    /// Returns its number, from 1.
    pub fn number(self) -> u64 {
        self.number
    }

    /// Returns the number of parts.
    pub fn count(self) -> u64 {
        self.of
    }

    /// Returns its rows of `design`, as (replicate, rows in it); none if there are more parts than base points.
    pub fn rows(self, design: &Design) -> Vec<(u64, Range<u64>)> {
        let (all, per_replicate) = (design.settings().base_samples, design.points_per_replicate());
        let bound = |part: u64| (u128::from(part) * u128::from(all) / u128::from(self.of)) as u64;
        let points = bound(self.number - 1)..bound(self.number);
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

#[cfg(test)]
mod tests;
