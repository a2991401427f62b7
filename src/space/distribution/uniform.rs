//! The uniform distribution.

use super::prelude::*;

/// A distribution in which every value between two bounds is equally likely.
#[derive(Clone, Debug, PartialEq)]
pub struct Uniform {
    min: f64,
    max: f64,
    width: f64,
}

impl Distribution {
    /// Returns the uniform distribution on [`min`, `max`].
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = min + (max - min) u
    /// ```
    ///
    /// # Errors
    ///
    /// If a bound is not finite, `min >= max`, or their difference overflows.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// assert_eq!(Distribution::uniform(-1.0, 1.0)?.quantile(0.75), 0.5);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn uniform(min: f64, max: f64) -> Result<Self, DistributionError> {
        let width = bounds(min, max, "uniform")?;
        Self::Uniform(Uniform { min, max, width }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "uniform",
    summary: "Every value between two bounds is equally likely.",
    key_sets: &[keys(&["min", "max"]), MOMENTS, TWO_QUANTILES],
    make: |_, [least, width, _]| Distribution::uniform(least, least + width),
    build: |given| Distribution::uniform(given.number("min")?, given.number("max")?),
    ..PLAIN
}];

impl Family for Uniform {
    fn quantile(&self, u: f64) -> f64 {
        // Never above `max`: the width is rounded up by at most half an ulp, and u <= 1 - 2^-53 subtracts a whole one.
        self.min + self.width * u
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        (((x - self.min) / self.width).clamp(0.0, 1.0), ((self.max - x) / self.width).clamp(0.0, 1.0))
    }

    fn moments(&self) -> (f64, f64) {
        (0.5 * self.min + 0.5 * self.max, self.width / 12f64.sqrt())
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("min", self.min.into()), ("max", self.max.into())]
    }
}
