//! The normal distribution.

use super::error::{finite, positive};
use super::family::{Family, Parameter};
use super::{Distribution, DistributionError};
use crate::quantity::Unit;
use crate::special::{normal_below, normal_quantile};

/// The normal (Gaussian) distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal {
    mean: f64,
    sd: f64,
}

impl Distribution {
    /// Normal with mean `mean` and standard deviation `sd`.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = mean + sd Phi^-1(u)
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
        Distribution::normal_between(self.mean, self.sd, (min, max))
    }
}

impl Family for Normal {
    fn name(&self) -> &'static str {
        "normal"
    }

    fn quantile(&self, u: f64) -> f64 {
        self.mean + self.sd * normal_quantile(u)
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = (x - self.mean) / self.sd;
        (normal_below(z), normal_below(-z))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        self.mean - self.sd * normal_quantile(v)
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
