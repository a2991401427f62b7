//! The Gumbel distribution of maxima.

use std::f64::consts::PI;

use super::prelude::*;

/// Euler's constant.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// The limit of the largest of many values: long tail to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct Gumbel {
    pub(super) location: f64,
    pub(super) scale: f64,
}

impl Distribution {
    /// Returns the Gumbel distribution of maximum type with mode `location` and scale `scale`.
    ///
    /// # Formula
    ///
    /// ```text
    /// F(x) = exp(-exp(-(x - location) / scale)),   quantile(u) = location - scale ln(-ln u)
    /// mean = location + 0.5772... scale,   sd = pi scale / sqrt(6)
    /// ```
    ///
    /// # Errors
    ///
    /// If `location` is not finite, `scale` is not finite and positive, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let gumbel = Distribution::gumbel(1.0, 2.0)?;
    /// assert!((gumbel.quantile((-1f64).exp()) - 1.0).abs() < 1e-15);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn gumbel(location: f64, scale: f64) -> Result<Self, DistributionError> {
        Self::Gumbel(Gumbel::new(location, scale)?).finite()
    }
}

impl Gumbel {
    pub(super) fn new(location: f64, scale: f64) -> Result<Self, DistributionError> {
        Ok(Self { location: finite("location", location)?, scale: positive("scale", scale)? })
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "gumbel",
    summary: "The largest of many values.",
    key_sets: &[keys(&["location", "scale"]), MOMENTS, TWO_QUANTILES],
    make: |_, [location, scale, _]| Distribution::gumbel(location, scale),
    build: |given| Distribution::gumbel(given.number("location")?, given.number("scale")?),
    ..PLAIN
}];

impl Family for Gumbel {
    fn quantile(&self, u: f64) -> f64 {
        self.location - self.scale * libm::log(-libm::log(u))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let log = libm::exp(-(x - self.location) / self.scale);
        (libm::exp(-log), -libm::expm1(-log))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.location - self.scale * libm::log(-libm::log1p(-v))
    }

    fn moments(&self) -> (f64, f64) {
        (self.location + EULER_GAMMA * self.scale, PI / 6f64.sqrt() * self.scale)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("location", self.location.into()), ("scale", self.scale.into())]
    }
}
