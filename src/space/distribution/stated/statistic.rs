//! What can be known of a factor, by the keys of study files.

use crate::names::named;

named! {
/// Something known of a factor.
pub enum Statistic {
    /// The least value.
    Min = "min",
    /// The largest value.
    Max = "max",
    /// The mean.
    Mean = "mean",
    /// The standard deviation.
    Sd = "sd",
    /// The most probable value.
    Mode = "mode",
    /// The 1 % quantile, and so on.
    P01 = "p01",
    /// The 5 % quantile.
    P05 = "p05",
    /// The 10 % quantile.
    P10 = "p10",
    /// The 25 % quantile.
    P25 = "p25",
    /// The median.
    P50 = "p50",
    /// The 75 % quantile.
    P75 = "p75",
    /// The 90 % quantile.
    P90 = "p90",
    /// The 95 % quantile.
    P95 = "p95",
    /// The 99 % quantile.
    P99 = "p99",
    /// The location of a distribution that has one.
    Location = "location",
    /// The scale of a distribution that has one.
    Scale = "scale",
    /// The shape of a Weibull, gamma or Pareto distribution.
    Shape = "shape",
    /// The degrees of freedom of a Student t distribution.
    Df = "df",
    /// The mean of the logarithm, of a log-normal distribution.
    LogMean = "log_mean",
    /// The standard deviation of the logarithm, of a log-normal distribution.
    LogSd = "log_sd",
}
}

impl Statistic {
    /// The probability below it, of a quantile; 0 and 1 of the bounds.
    pub fn probability(self) -> Option<f64> {
        Some(match self {
            Self::Min => 0.0,
            Self::P01 => 0.01,
            Self::P05 => 0.05,
            Self::P10 => 0.10,
            Self::P25 => 0.25,
            Self::P50 => 0.5,
            Self::P75 => 0.75,
            Self::P90 => 0.90,
            Self::P95 => 0.95,
            Self::P99 => 0.99,
            Self::Max => 1.0,
            _ => return None,
        })
    }

    /// Whether it is the one parameter beside a location and a scale.
    pub(super) fn is_shape(self) -> bool {
        matches!(self, Self::Shape | Self::Df | Self::LogSd)
    }

    pub(super) fn is_quantile(self) -> bool {
        self.probability().is_some_and(|p| 0.0 < p && p < 1.0)
    }
}
