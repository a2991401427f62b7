//! The log-normal distribution.

use super::prelude::*;
use apportion_base::special::{normal_below, normal_quantile};

/// The distribution of a variable whose logarithm is normal.
#[derive(Clone, Debug, PartialEq)]
pub struct LogNormal {
    log_mean: f64,
    log_sd: f64,
    /// Mean and standard deviation of the variable itself, if these were given.
    moments: Option<(f64, f64)>,
}

impl Distribution {
    /// Returns the log-normal distribution with mean `mean` and standard deviation `sd` of the variable itself.
    ///
    /// # Formula
    ///
    /// ```text
    /// log_sd^2 = ln(1 + (sd / mean)^2),   log_mean = ln(mean) - log_sd^2 / 2
    /// ```
    ///
    /// # Errors
    ///
    /// If a parameter is not finite and positive, or values overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let log_normal = Distribution::log_normal(5.0, 1.0)?;
    /// assert_eq!((log_normal.mean(), log_normal.sd()), (5.0, 1.0));
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn log_normal(mean: f64, sd: f64) -> Result<Self, DistributionError> {
        positive("mean", mean)?;
        positive("sd", sd)?;
        let variation = sd / mean;
        // Below 1e-8 the logarithm equals its argument, above 1e8 the 1 is lost; the square might leave the range.
        let log_sd = match variation {
            small if small < 1e-8 => small,
            large if large > 1e8 => (2.0 * libm::log(large)).sqrt(),
            other => libm::log1p(other * other).sqrt(),
        };
        let log_mean = libm::log(mean) - 0.5 * log_sd * log_sd;
        Self::LogNormal(LogNormal { log_mean, log_sd, moments: Some((mean, sd)) }).finite()
    }

    /// Returns the log-normal distribution whose natural logarithm has mean `log_mean` and standard deviation `log_sd`.
    ///
    /// # Formula
    ///
    /// ```text
    /// quantile(u) = exp(log_mean + log_sd quantile_normal(u))
    /// mean = exp(log_mean + log_sd^2 / 2),   sd = mean sqrt(exp(log_sd^2) - 1)
    /// ```
    ///
    /// # Errors
    ///
    /// If `log_mean` is not finite, `log_sd` is not finite and positive, or values or moments overflow.
    ///
    /// ```
    /// use apportion::Distribution;
    ///
    /// let log_normal = Distribution::log_normal_of_logs(0.0, 0.5)?;
    /// assert_eq!(log_normal.median(), 1.0);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn log_normal_of_logs(log_mean: f64, log_sd: f64) -> Result<Self, DistributionError> {
        finite("log_mean", log_mean)?;
        positive("log_sd", log_sd)?;
        Self::LogNormal(LogNormal { log_mean, log_sd, moments: None }).finite()
    }
}

pub(super) const ENTRIES: &[Entry] = &[Entry {
    name: "log-normal",
    summary: "The logarithm is normal.",
    key_sets: &[keys(&["mean", "sd"]), keys(&["log_mean", "log_sd"]), keys(&["median", "gsd"]), TWO_QUANTILES],
    of_ratios: true,
    shape: Shape::Between(1e-9, 26.0, 500),
    make: |_, [_, median, log_sd]| Distribution::log_normal_of_logs(libm::log(median), log_sd),
    build: |given| match (given.number_if("log_mean"), given.number_if("median")) {
        (Some(log_mean), _) => Distribution::log_normal_of_logs(log_mean, given.number("log_sd")?),
        (None, Some(median)) => {
            let gsd = given.number("gsd")?;
            number("gsd", gsd, gsd > 1.0, "be greater than 1")?;
            Distribution::log_normal_of_logs(libm::log(positive("median", median)?), libm::log(gsd))
        }
        (None, None) => Distribution::log_normal(given.number("mean")?, given.number("sd")?),
    },
    ..PLAIN
}];

impl Family for LogNormal {
    fn quantile(&self, u: f64) -> f64 {
        libm::exp(self.log_mean + self.log_sd * normal_quantile(u))
    }

    fn tails(&self, x: f64) -> (f64, f64) {
        let z = (libm::log(x.max(0.0)) - self.log_mean) / self.log_sd;
        (normal_below(z), normal_below(-z))
    }

    fn upper_quantile(&self, v: f64) -> f64 {
        libm::exp(self.log_mean - self.log_sd * normal_quantile(v))
    }

    fn moments(&self) -> (f64, f64) {
        self.moments.unwrap_or_else(|| {
            let mean = libm::exp(self.log_mean + 0.5 * self.log_sd * self.log_sd);
            (mean, mean * libm::expm1(self.log_sd * self.log_sd).sqrt())
        })
    }

    fn support(&self) -> (f64, f64) {
        (0.0, f64::INFINITY)
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        match self.moments {
            Some((mean, sd)) => vec![("mean", mean.into()), ("sd", sd.into())],
            None => vec![("log_mean", self.log_mean.into()), ("log_sd", self.log_sd.into())],
        }
    }
}
