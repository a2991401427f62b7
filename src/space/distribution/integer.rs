//! The uniform distribution on whole numbers.

use super::prelude::*;

/// The largest integer up to which every integer is an `f64`, 2^53.
const LARGEST: f64 = (1u64 << 53) as f64;

/// A uniform distribution over all whole numbers between two, both included.
#[derive(Clone, Debug, PartialEq)]
pub struct Integer {
    min: f64,
    count: f64,
}

impl Distribution {
    /// Returns the distribution of every whole number from `min` to `max`, both included, with equal probability.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = min + floor(n u),   n = max - min + 1
    /// mean = (min + max) / 2,   sd = sqrt((n^2 - 1) / 12)
    /// ```
    ///
    /// # Errors
    ///
    /// If a bound is not a whole number from -2^53 to 2^53, or `min > max`.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let die = Distribution::integer(1.0, 6.0)?;
    /// assert_eq!((die.quantile(0.16), die.quantile(0.17), die.mean()), (1.0, 2.0, 3.5));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn integer(min: f64, max: f64) -> Result<Self, DistributionError> {
        for (parameter, value) in [("min", min), ("max", max)] {
            let is_whole = value.fract() == 0.0 && value.abs() <= LARGEST;
            number(parameter, value, is_whole, "be a whole number between -2^53 and 2^53")?;
        }
        if min > max {
            return Err(order("min", min, "max", max));
        }
        Self::Integer(Integer { min, count: max - min + 1.0 }).finite()
    }
}

impl Integer {
    /// Maximum number of whole numbers that are treated as separate levels when a distribution is drawn or screened.
    const MAX_LEVELS: f64 = 1024.0;

    /// Returns the values in ascending order, each with a `u` at which it is the quantile; `None` for more than 1024.
    pub fn levels(&self) -> Option<Vec<(f64, f64)>> {
        let level = |k: u32| {
            let k = f64::from(k);
            (self.min + k, (k + 0.5) / self.count)
        };
        (self.count <= Self::MAX_LEVELS).then(|| (0..self.count as u32).map(level).collect())
    }

    fn max(&self) -> f64 {
        self.min + (self.count - 1.0)
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "integer",
    summary: "Whole numbers from `min` to `max`, both included, equally likely.",
    ways: &[keys(&["min", "max"])],
    build: |given| Distribution::integer(given.number("min")?, given.number("max")?),
    ..PLAIN
}];

impl Family for Integer {
    fn quantile(&self, u: f64) -> f64 {
        // The product may be rounded up to the count itself.
        self.min + (self.count * u).floor().clamp(0.0, self.count - 1.0)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let below = (x.floor() - self.min + 1.0).clamp(0.0, self.count);
        (below / self.count, (self.count - below) / self.count)
    }

    fn moments(&self) -> (f64, f64) {
        (self.min + (self.count - 1.0) / 2.0, ((self.count - 1.0) * (self.count + 1.0) / 12.0).sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max())
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("min", self.min.into()), ("max", self.max().into())]
    }
}
