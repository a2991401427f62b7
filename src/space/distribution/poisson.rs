//! The Poisson distribution.

use std::fmt;
use std::sync::Arc;

use super::error::{finite, within};
use super::family::{Family, Parameter};
use super::keys::{Entry, PLAIN, keys};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Means beyond are refused: the table of probabilities would grow long, and none but 0 would ever occur.
const MEANS: (f64, f64) = (1e-300, 1e6);

/// Numbers of events that come by chance.
#[derive(Clone, PartialEq)]
pub struct Poisson {
    mean: f64,
    /// The least and the largest number of events left by a truncation.
    bounds: (f64, f64),
    table: Arc<Table>,
    /// What turns the whole numbers into values, one after the other; empty for the whole numbers themselves.
    units: Vec<Unit>,
}

/// The probabilities of all numbers that are worth one.
#[derive(PartialEq)]
struct Table {
    first: f64,
    probabilities: Vec<f64>,
    /// P(X <= k) of each.
    below: Vec<f64>,
    /// P(X > k) of each.
    above: Vec<f64>,
    /// The place of the median.
    middle: usize,
}

// The table follows from the rest.
impl fmt::Debug for Poisson {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mean, bounds, units, .. } = self;
        formatter.debug_struct("Poisson").field("mean", mean).field("bounds", bounds).field("units", units).finish()
    }
}

impl Distribution {
    /// Poisson with mean `mean`: 0, 1, 2 and so on.
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
    /// If `mean` lies outside [1e-300, 1e6]. Beyond, a normal distribution of this mean and its square root as the
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
        let bounds = (0.0, f64::INFINITY);
        let Some(table) = Table::new(mean, bounds) else {
            return Err(DistributionError::Overflow { distribution: "poisson" });
        };
        Self::Poisson(Poisson { mean, bounds, table: Arc::new(table), units: Vec::new() }).finite()
    }
}

impl Poisson {
    /// Levels up to so many are gone through one by one where a distribution is drawn or screened.
    const FEW: usize = 1024;
    /// Levels that are rarer than this together on either side do not count among them.
    const RARE: f64 = 1e-3;

    /// The whole numbers between `min` and `max`, both included, with their shares.
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        let nothing = DistributionError::NothingLeft { distribution: "poisson", min, max };
        // In units, the numbers are found by their values.
        let (mut low, mut high) = self.bounds;
        let all = (0..self.table.probabilities.len()).map(|k| self.table.first + k as f64);
        let mut is_empty = true;
        for k in all {
            let value = self.in_unit(k);
            low = if value < min { low.max(k + 1.0) } else { low };
            high = if value > max { high.min(k - 1.0) } else { high };
            is_empty &= !(min..=max).contains(&value);
        }
        let table = Table::new(self.mean, (low, high)).filter(|_| !is_empty).ok_or(nothing)?;
        Distribution::Poisson(Self { bounds: (low, high), table: Arc::new(table), ..self.clone() }).finite()
    }

    /// The numbers that occur, but for the rare ones, each with a `u` at which it is the quantile; `None` if they are
    /// more than 1024.
    pub fn levels(&self) -> Option<Vec<(f64, f64)>> {
        self.levels_above(Self::RARE)
    }

    /// The same, but for those that are rarer than `rare` together on either side.
    pub fn levels_above(&self, rare: f64) -> Option<Vec<(f64, f64)>> {
        let table = &self.table;
        let (first, last) = (table.place(rare, 1.0 - rare), table.place(1.0 - rare, rare));
        let level = |place: usize| {
            let low = if place == 0 { 0.0 } else { table.below[place - 1] };
            (self.in_unit(table.first + place as f64), low + (table.below[place] - low) / 2.0)
        };
        (last - first < Self::FEW).then(|| (first..=last).map(level).collect())
    }

    fn in_unit(&self, whole: f64) -> f64 {
        self.units.iter().fold(whole, |value, unit| unit.to_si(value))
    }
}

impl Table {
    /// `None` if there is no number between the bounds, both included.
    fn new(mean: f64, (low, high): (f64, f64)) -> Option<Self> {
        const LEAST: f64 = 1e-300;
        if low > high {
            return None;
        }
        let mode = mean.floor().clamp(low, high);
        // Up and down from the most probable number, whose own probability is found by the sum.
        let mut falling = vec![1.0];
        let mut k = mode;
        while k > low {
            let next = falling[falling.len() - 1] * (k / mean);
            if next < LEAST {
                break;
            }
            falling.push(next);
            k -= 1.0;
        }
        let first = k;
        let mut probabilities: Vec<f64> = falling.into_iter().rev().collect();
        k = mode;
        while k < high {
            let next = probabilities[probabilities.len() - 1] * (mean / (k + 1.0));
            if next < LEAST {
                break;
            }
            probabilities.push(next);
            k += 1.0;
        }
        // From the small ones on either side.
        let sums = |all: &mut dyn Iterator<Item = &f64>| -> Vec<f64> {
            all.scan(0.0, |sum, probability| {
                *sum += probability;
                Some(*sum)
            })
            .collect()
        };
        let below = sums(&mut probabilities.iter());
        let from: Vec<f64> = sums(&mut probabilities.iter().rev()).into_iter().rev().collect();
        let total = below[below.len() - 1];
        let middle = below.partition_point(|sum| *sum < 0.5 * total);
        let above = from.iter().skip(1).chain([&0.0]).map(|sum| sum / total).collect();
        let below = below.iter().map(|sum| sum / total).collect();
        probabilities.iter_mut().for_each(|probability| *probability /= total);
        Some(Self { first, probabilities, below, above, middle })
    }

    /// The place of the quantile at `u`, `v` being 1 - u.
    fn place(&self, u: f64, v: f64) -> usize {
        let place = if u < v {
            self.below.partition_point(|below| *below <= u).min(self.middle)
        } else {
            self.above.partition_point(|above| *above >= v).max(self.middle)
        };
        place.min(self.below.len() - 1)
    }

    fn expectation(&self, of: impl Fn(f64) -> f64) -> f64 {
        self.probabilities.iter().enumerate().map(|(k, probability)| of(self.first + k as f64) * probability).sum()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "poisson",
    summary: "Numbers of events that come by chance.",
    ways: &[keys(&["mean"])],
    build: |given| Distribution::poisson(given.number("mean")?),
    ..PLAIN
}];

impl Family for Poisson {
    fn at(&self, u: f64, v: f64) -> f64 {
        let (low, high) = self.bounds;
        if u <= 0.0 {
            return self.in_unit(low);
        }
        if v <= 0.0 {
            return self.in_unit(high);
        }
        self.in_unit(self.table.first + self.table.place(u, v) as f64)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let table = &self.table;
        let (mut low, mut high) = (0, table.below.len());
        while low < high {
            let middle = low + (high - low) / 2;
            if self.in_unit(table.first + middle as f64) <= x { low = middle + 1 } else { high = middle }
        }
        low.checked_sub(1).map_or((0.0, 1.0), |place| (table.below[place], table.above[place]))
    }

    fn mean(&self) -> f64 {
        let whole = self.bounds == (0.0, f64::INFINITY);
        self.in_unit(if whole { self.mean } else { self.table.expectation(|k| k) })
    }

    fn sd(&self) -> f64 {
        let span = |sd: f64| self.units.iter().fold(sd, |sd, unit| unit.span_to_si(sd));
        if self.bounds == (0.0, f64::INFINITY) {
            return span(self.mean.sqrt());
        }
        let mean = self.table.expectation(|k| k);
        span(self.table.expectation(|k| (k - mean) * (k - mean)).sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (
            self.in_unit(self.bounds.0),
            if self.bounds.1.is_finite() { self.in_unit(self.bounds.1) } else { f64::INFINITY },
        )
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let mut parameters = vec![("mean", self.in_unit(self.mean).into())];
        if self.bounds != (0.0, f64::INFINITY) {
            let (min, max) = self.support();
            parameters.push(("truncate", Parameter::Bounds(min, max)));
        }
        parameters
    }

    fn in_si(&self, _own: &'static Entry, unit: &Unit) -> Result<Distribution, DistributionError> {
        let units = self.units.iter().chain([unit]).cloned().collect();
        Distribution::Poisson(Self { units, ..self.clone() }).finite()
    }
}
