//! The normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use libm::erfc;
use statrs::function::erf::erfc_inv;

use super::error::{finite, positive};
use super::family::{Family, Parameter};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;

/// The normal (Gaussian) distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal {
    mean: f64,
    sd: f64,
}

/// The quantile of the standard normal distribution; relative error below 4e-16 from u = 1e-290 up.
pub(in crate::space) fn standard_quantile(u: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * u)
}

/// P(Z < z) of the standard normal distribution, to full relative precision in the lower tail.
pub(in crate::space) fn standard_below(z: f64) -> f64 {
    0.5 * erfc(-z * FRAC_1_SQRT_2)
}

impl Distribution {
    /// Normal with mean `mean` and standard deviation `sd`.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = mean - sd sqrt(2) erfc^-1(2 u)
    /// ```
    ///
    /// # Errors
    ///
    /// If `mean` is not finite, `sd` is not finite and positive, or values some 9 sd from the mean overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let normal = Distribution::normal(10.0, 2.0)?;
    /// assert!((normal.quantile(0.975) - 13.919927969080108).abs() < 1e-14);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn normal(mean: f64, sd: f64) -> Result<Self, DistributionError> {
        finite("mean", mean)?;
        positive("sd", sd)?;
        Self::Normal(Normal { mean, sd }).finite()
    }
}

impl Normal {
    pub(super) fn between(&self, min: f64, max: f64) -> Result<Distribution, DistributionError> {
        Distribution::normal_between((self.mean, self.sd), (min, max))
    }
}

impl Family for Normal {
    fn name(&self) -> &'static str {
        "normal"
    }

    fn quantile(&self, u: f64) -> f64 {
        self.mean + self.sd * standard_quantile(u)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = (x - self.mean) / self.sd;
        (standard_below(z), standard_below(-z))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.mean - self.sd * standard_quantile(v)
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sd(&self) -> f64 {
        self.sd
    }

    fn support(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("mean", self.mean.into()), ("sd", self.sd.into())]
    }

    fn to_si(&self, unit: &Unit) -> Result<Distribution, DistributionError> {
        Distribution::normal(unit.to_si(self.mean), unit.span_to_si(self.sd))
    }
}
