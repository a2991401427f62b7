//! The normal distribution.

use super::prelude::*;
use apportion_base::special::{normal_below, normal_quantile};

/// The normal (Gaussian) distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal {
    pub(super) mean: f64,
    pub(super) sd: f64,
}

impl Distribution {
    /// Returns the normal distribution with mean `mean` and standard deviation `sd`.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = mean + sd Phi^-1(u)
    /// ```
    ///
    /// # Errors
    ///
    /// If `mean` is not finite, `sd` is not finite and positive, or values about 9 sd from the mean overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let normal = Distribution::normal(10.0, 2.0)?;
    /// assert!((normal.quantile(0.975) - 13.919927969080108).abs() < 1e-14);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn normal(mean: f64, sd: f64) -> Result<Self, DistributionError> {
        Self::Normal(Normal::new(mean, sd)?).finite()
    }
}

impl Normal {
    pub(super) fn new(mean: f64, sd: f64) -> Result<Self, DistributionError> {
        Ok(Self { mean: finite("mean", mean)?, sd: positive("sd", sd)? })
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "normal",
    summary: "The normal (Gaussian) distribution.",
    key_sets: &[keys(&["mean", "sd"]), TWO_QUANTILES],
    make: |_, [mean, sd, _]| Distribution::normal(mean, sd),
    build: |given| Distribution::normal(given.number("mean")?, given.number("sd")?),
    ..PLAIN
}];

impl Family for Normal {
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

    fn moments(&self) -> (f64, f64) {
        (self.mean, self.sd)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        vec![("mean", self.mean.into()), ("sd", self.sd.into())]
    }
}
