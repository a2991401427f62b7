//! The exponential distribution.

use super::prelude::*;

/// The distribution of waiting times between random events.
#[derive(Clone, Debug, PartialEq)]
pub struct Exponential {
    scale: f64,
    location: f64,
}

impl Distribution {
    /// Returns the exponential distribution with scale `scale` (its standard deviation, and one over the rate),
    /// beginning at `location`, usually 0.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = 1 - exp(-(x - location) / scale),   quantile(u) = location - scale ln(1 - u)
    /// mean = location + scale,   sd = scale
    /// ```
    ///
    /// # Errors
    ///
    /// If `scale` is not finite and positive, `location` is not finite, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let wait = Distribution::exponential(2.0, 0.0)?;
    /// assert_eq!((wait.mean(), wait.median()), (2.0, 2.0 * 2f64.ln()));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn exponential(scale: f64, location: f64) -> Result<Self, DistributionError> {
        positive("scale", scale)?;
        finite("location", location)?;
        Self::Exponential(Exponential { scale, location }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "exponential",
    summary: "Waiting times between random events.",
    key_sets: &[
        keys(&["scale"]).perhaps(&["location"]),
        solved_keys(&["mean"]).perhaps(&["location"]),
        MOMENTS,
        TWO_QUANTILES,
    ],
    make: |_, [location, scale, _]| Distribution::exponential(scale, location),
    defaults: &[("location", 0.0)],
    build: |given| Distribution::exponential(given.number("scale")?, given.number("location")?),
    ..PLAIN
}];

impl Family for Exponential {
    fn quantile(&self, u: f64) -> f64 {
        self.location - self.scale * libm::log1p(-u)
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.location - self.scale * libm::log(v)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = ((x - self.location) / self.scale).max(0.0);
        (-libm::expm1(-z), libm::exp(-z))
    }

    fn moments(&self) -> (f64, f64) {
        (self.location + self.scale, self.scale)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("scale", self.scale.into()), ("location", self.location.into())]
    }
}
