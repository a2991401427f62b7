//! The log-uniform (reciprocal) distribution.

use super::prelude::*;

/// The distribution of a variable whose logarithm is uniform between the logarithms of two positive bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct LogUniform {
    min: f64,
    max: f64,
    /// sqrt(min max)
    centre: f64,
    /// ln(max / min) / 2
    half: f64,
}

impl Distribution {
    /// Returns the log-uniform distribution on [`min`, `max`]: each decade between the bounds is equally likely.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = min (max / min)^u = c exp((2 u - 1) h),   c = sqrt(min max), h = ln(max / min) / 2
    /// mean = c sinh(h) / h
    /// ```
    ///
    /// # Errors
    ///
    /// If a bound is not finite, `min <= 0`, or `min >= max`.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// assert_eq!(Distribution::log_uniform(1.0, 100.0)?.median(), 10.0);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn log_uniform(min: f64, max: f64) -> Result<Self, DistributionError> {
        positive("min", min)?;
        let width = bounds(min, max, "log-uniform")?;
        // The difference is exact up to a ratio of 2, and its quotient then keeps all digits; above it the logarithm
        // does, computed from the square roots because the quotient itself may overflow.
        let half = match width < min {
            true => 0.5 * libm::log1p(width / min),
            false => libm::log(max.sqrt() / min.sqrt()),
        };
        let centre = min.sqrt() * max.sqrt();
        Self::LogUniform(LogUniform { min, max, centre, half }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "log-uniform",
    summary: "The logarithm is uniform: every decade between two bounds is equally likely.",
    key_sets: &[keys(&["min", "max"]), MOMENTS, TWO_QUANTILES],
    of_ratios: true,
    shape: Shape::Between(1e-9, 700.0, 500),
    make: |_, [_, min, log]| Distribution::log_uniform(min, min * libm::exp(log)),
    build: |given| Distribution::log_uniform(given.number("min")?, given.number("max")?),
    ..PLAIN
}];

impl Family for LogUniform {
    fn quantile(&self, u: f64) -> f64 {
        // From the centre, where the argument of exp stays within its range and rounds least.
        (self.centre * libm::exp((2.0 * u - 1.0) * self.half)).clamp(self.min, self.max)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let x = x.clamp(self.min, self.max);
        let parts =
            [(self.min, x), (x, self.max)].map(|(from, to)| libm::log1p((to - from) / from) / (2.0 * self.half));
        (parts[0].min(1.0), parts[1].min(1.0))
    }

    fn moments(&self) -> (f64, f64) {
        // E[x^2] - mean^2 = c^2 (sinh h / h) (cosh h - sinh h / h)
        let h = self.half;
        let mean_ratio = libm::sinh(h) / h;
        let excess = match h < 1.0 {
            // The difference cancels; its series is the sum of 2 k h^2k / (2 k + 1)!.
            true => {
                (1..=10).rev().fold(0.0, |sum, k| {
                    let k = f64::from(k);
                    (2.0 * k + h * h * sum) / (2.0 * k * (2.0 * k + 1.0))
                }) * h
                    * h
            }
            false => libm::cosh(h) - mean_ratio,
        };
        (
            self.centre * (libm::sinh(self.half) / self.half),
            (self.centre * mean_ratio).sqrt() * (self.centre * excess).sqrt(),
        )
    }

    fn support(&self) -> (f64, f64) {
        (self.min, self.max)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("min", self.min.into()), ("max", self.max.into())]
    }
}
