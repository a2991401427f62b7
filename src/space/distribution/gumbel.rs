//! The Gumbel distribution of maxima.

use std::f64::consts::PI;

use super::error::{finite, positive};
use super::family::{Family, Parameter};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// Euler's constant.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// The limit of the largest of many values: long tail to the right.
#[derive(Clone, Debug, PartialEq)]
pub struct Gumbel {
    location: f64,
    scale: f64,
}

impl Distribution {
    /// Gumbel of maximum type: mode `location`, scale `scale`.
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
        finite("location", location)?;
        positive("scale", scale)?;
        Self::Gumbel(Gumbel { location, scale }).finite()
    }
}

impl Gumbel {
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        Distribution::gumbel_between(self.location, self.scale, (min, max))
    }
}

impl Family for Gumbel {
    fn name(&self) -> &'static str {
        "gumbel"
    }

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

    fn mean(&self) -> f64 {
        self.location + EULER_GAMMA * self.scale
    }

    fn sd(&self) -> f64 {
        PI / 6f64.sqrt() * self.scale
    }

    fn support(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("location", self.location.into()), ("scale", self.scale.into())]
    }

    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError> {
        Distribution::gumbel(unit.to_si(self.location), unit.span_to_si(self.scale))
    }
}
