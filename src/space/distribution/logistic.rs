//! The logistic distribution.

use std::f64::consts::PI;

use super::prelude::*;

/// A distribution that is symmetric like a normal one, with longer tails.
#[derive(Clone, Debug, PartialEq)]
pub struct Logistic {
    location: f64,
    scale: f64,
}

impl Distribution {
    /// Returns the logistic distribution with mean `location` and scale `scale`.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = 1 / (1 + exp(-(x - location) / scale)),   quantile(u) = location + scale ln(u / (1 - u))
    /// mean = location,   sd = pi scale / sqrt(3)
    /// ```
    ///
    /// # Errors
    ///
    /// If `location` is not finite, `scale` is not finite and positive, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let logistic = Distribution::logistic(1.0, 2.0)?;
    /// assert!((logistic.quantile(0.75) - (1.0 + 2.0 * 3f64.ln())).abs() < 1e-15);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn logistic(location: f64, scale: f64) -> Result<Self, DistributionError> {
        finite("location", location)?;
        positive("scale", scale)?;
        Self::Logistic(Logistic { location, scale }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "logistic",
    summary: "Like a normal distribution, with longer tails.",
    key_sets: &[keys(&["location", "scale"]), MOMENTS, TWO_QUANTILES],
    make: |_, [location, scale, _]| Distribution::logistic(location, scale),
    build: |given| Distribution::logistic(given.number("location")?, given.number("scale")?),
    ..PLAIN
}];

impl Family for Logistic {
    fn quantile(&self, u: f64) -> f64 {
        self.location + self.scale * (libm::log(u) - libm::log1p(-u))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.location - self.scale * (libm::log(v) - libm::log1p(-v))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = (x - self.location) / self.scale;
        (1.0 / (1.0 + libm::exp(-z)), 1.0 / (1.0 + libm::exp(z)))
    }

    fn moments(&self) -> (f64, f64) {
        (self.location, PI / 3f64.sqrt() * self.scale)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("location", self.location.into()), ("scale", self.scale.into())]
    }
}
