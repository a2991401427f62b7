//! What can be known of a factor, by the keys of study files.

/// Something known of a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statistic {
    /// The least value.
    Min,
    /// The largest value.
    Max,
    /// The mean; of a truncated normal distribution, before truncation.
    Mean,
    /// The standard deviation; of a truncated normal distribution, before truncation.
    Sd,
    /// The most probable value.
    Mode,
    /// The 1 % quantile, and so on.
    P01,
    /// The 5 % quantile.
    P05,
    /// The 10 % quantile.
    P10,
    /// The 25 % quantile.
    P25,
    /// The median.
    P50,
    /// The 75 % quantile.
    P75,
    /// The 90 % quantile.
    P90,
    /// The 95 % quantile.
    P95,
    /// The 99 % quantile.
    P99,
    /// The location of a distribution that has one.
    Location,
    /// The scale of a distribution that has one.
    Scale,
    /// The shape of a Weibull, gamma or Pareto distribution.
    Shape,
    /// The degrees of freedom of a Student t distribution.
    Df,
    /// The first shape of a beta distribution.
    Alpha,
    /// The second shape of a beta distribution.
    Beta,
    /// The mean of the logarithm, of a log-normal distribution.
    LogMean,
    /// The standard deviation of the logarithm, of a log-normal distribution.
    LogSd,
}

impl Statistic {
    /// All of them.
    pub const ALL: [Self; 22] = [
        Self::Min,
        Self::Max,
        Self::Mean,
        Self::Sd,
        Self::Mode,
        Self::P01,
        Self::P05,
        Self::P10,
        Self::P25,
        Self::P50,
        Self::P75,
        Self::P90,
        Self::P95,
        Self::P99,
        Self::Location,
        Self::Scale,
        Self::Shape,
        Self::Df,
        Self::Alpha,
        Self::Beta,
        Self::LogMean,
        Self::LogSd,
    ];

    /// The key in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Min => "min",
            Self::Max => "max",
            Self::Mean => "mean",
            Self::Sd => "sd",
            Self::Mode => "mode",
            Self::P01 => "p01",
            Self::P05 => "p05",
            Self::P10 => "p10",
            Self::P25 => "p25",
            Self::P50 => "p50",
            Self::P75 => "p75",
            Self::P90 => "p90",
            Self::P95 => "p95",
            Self::P99 => "p99",
            Self::Location => "location",
            Self::Scale => "scale",
            Self::Shape => "shape",
            Self::Df => "df",
            Self::Alpha => "alpha",
            Self::Beta => "beta",
            Self::LogMean => "log_mean",
            Self::LogSd => "log_sd",
        }
    }

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
