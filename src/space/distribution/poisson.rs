//! The Poisson distribution.

use std::iter::successors;
use std::sync::Arc;

use super::prelude::*;

/// Means outside are refused: the table of probabilities would be too long, or only 0 would ever occur.
const MEANS: (f64, f64) = (1e-300, 1e6);

/// The distribution of the number of random events.
#[derive(Clone, Debug, PartialEq)]
pub struct Poisson {
    mean: f64,
    table: Arc<Table>,
}

/// The probabilities of all numbers that are not negligible.
#[derive(Debug, PartialEq)]
struct Table {
    first: f64,
    /// P(X <= k) of each.
    below: Vec<f64>,
    /// P(X > k) of each.
    above: Vec<f64>,
    /// The index of the median.
    middle: usize,
}

impl Distribution {
    /// Returns the Poisson distribution with mean `mean`: 0, 1, 2 and so on.
    ///
    /// # Formula
    ///
    /// ```text
    /// P(X = k) = mean^k exp(-mean) / k!,   quantile(u) = the smallest k with P(X <= k) > u
    /// sd = sqrt(mean)
    /// ```
    ///
    /// # Errors
    ///
    /// If `mean` is outside [1e-300, 1e6]. Above, a normal distribution of this mean with its square root as the
    /// standard deviation differs by less than a thousandth of that.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let events = Distribution::poisson(2.0)?;
    /// // P(X = 0) = 0.1353..., P(X <= 1) = 0.4060...
    /// assert_eq!((events.quantile(0.1), events.quantile(0.2), events.quantile(0.5)), (0.0, 1.0, 2.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn poisson(mean: f64) -> Result<Self, DistributionError> {
        within("mean", finite("mean", mean)?, MEANS)?;
        Self::Poisson(Poisson { mean, table: Arc::new(Table::new(mean)) }).finite()
    }
}

impl Poisson {
    /// Maximum number of levels that are treated separately when a distribution is drawn or screened.
    const MAX_LEVELS: usize = 1024;
    /// Levels that together are rarer than this on either side are not among them.
    const RARE: f64 = 1e-3;

    /// Returns the numbers that occur, except the rare ones, each with a `u` at which it is the quantile; `None` if
    /// there are more than 1024.
    pub fn levels(&self) -> Option<Vec<(f64, f64)>> {
        let (rare, table) = (Self::RARE, &self.table);
        let (first, last) = (table.place(rare, 1.0 - rare), table.place(1.0 - rare, rare));
        if last - first >= Self::MAX_LEVELS {
            return None;
        }
        let mut levels = Vec::with_capacity(last - first + 1);
        for place in first..=last {
            let low = if place == 0 { 0.0 } else { table.below[place - 1] };
            levels.push((table.first + place as f64, low + (table.below[place] - low) / 2.0));
        }
        Some(levels)
    }
}

impl Table {
    fn new(mean: f64) -> Self {
        const MIN_RATIO: f64 = 1e-300;
        let mode = mean.floor();
        // Up and down from the most probable number, whose own probability follows from the sum.
        let down = successors(Some((1.0, mode)), |(ratio, k)| (*k > 0.0).then_some((ratio * (k / mean), k - 1.0)));
        let up = successors(Some((1.0, mode)), |(ratio, k)| Some((ratio * (mean / (k + 1.0)), k + 1.0)));
        let mut falling: Vec<(f64, f64)> = down.take_while(|(ratio, _)| *ratio >= MIN_RATIO).collect();
        let first = falling[falling.len() - 1].1;
        falling.reverse();
        let rising = up.skip(1).take_while(|(ratio, _)| *ratio >= MIN_RATIO);
        let probabilities: Vec<f64> = falling.into_iter().chain(rising).map(|(ratio, _)| ratio).collect();
        // From the small ones on either side.
        let below = running_sums(probabilities.iter());
        let from: Vec<f64> = running_sums(probabilities.iter().rev()).into_iter().rev().collect();
        let total = below[below.len() - 1];
        let middle = below.partition_point(|sum| *sum < 0.5 * total);
        let above = from.iter().skip(1).chain([&0.0]).map(|sum| sum / total).collect();
        let below = below.iter().map(|sum| sum / total).collect();
        Self { first, below, above, middle }
    }

    /// Returns the index of the quantile at `u`, `v` being 1 - u.
    fn place(&self, u: f64, v: f64) -> usize {
        let place = if u < v {
            self.below.partition_point(|below| *below <= u).min(self.middle)
        } else {
            self.above.partition_point(|above| *above >= v).max(self.middle)
        };
        place.min(self.below.len() - 1)
    }
}

/// Returns the sum of the first probability, of the first two, and so on.
fn running_sums<'a>(probabilities: impl Iterator<Item = &'a f64>) -> Vec<f64> {
    let mut sum = 0.0;
    probabilities
        .map(|probability| {
            sum += probability;
            sum
        })
        .collect()
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "poisson",
    summary: "Numbers of random events.",
    key_sets: &[keys(&["mean"])],
    build: |given| Distribution::poisson(given.number("mean")?),
    ..PLAIN
}];

impl Family for Poisson {
    fn at(&self, u: f64, v: f64) -> f64 {
        if u <= 0.0 || v <= 0.0 {
            return if u <= 0.0 { 0.0 } else { f64::INFINITY };
        }
        self.table.first + self.table.place(u, v) as f64
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let Table { first, below, above, .. } = &*self.table;
        let count = (x.floor() - first + 1.0).clamp(0.0, below.len() as f64) as usize;
        count.checked_sub(1).map_or((0.0, 1.0), |place| (below[place], above[place]))
    }

    fn moments(&self) -> (f64, f64) {
        (self.mean, self.mean.sqrt())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("mean", self.mean.into())]
    }
}
