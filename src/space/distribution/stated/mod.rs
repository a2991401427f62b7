//! Distributions by what people know of a factor: its mean and scatter, its mode, two of its quantiles.

mod root;
mod scaled;
mod statistic;

use std::fmt::Write;

use super::{Distribution, DistributionError};
use crate::names::named;
pub use statistic::Statistic;

named! {
/// A family that what is known of a factor can determine.
pub enum Law {
    /// [`Distribution::uniform`], by two.
    Uniform = "uniform",
    /// [`Distribution::log_uniform`], by two.
    LogUniform = "log-uniform",
    /// [`Distribution::normal`], by two.
    Normal = "normal",
    /// [`Distribution::log_normal`], by two.
    LogNormal = "log-normal",
    /// [`Distribution::gumbel`], by two.
    Gumbel = "gumbel",
    /// [`Distribution::weibull`], by two and location 0, or by three.
    Weibull = "weibull",
    /// [`Distribution::gamma`], by two and location 0, or by three.
    Gamma = "gamma",
    /// [`Distribution::exponential`], by one and location 0, or by two.
    Exponential = "exponential",
    /// [`Distribution::logistic`], by two.
    Logistic = "logistic",
    /// [`Distribution::student_t`], by three.
    StudentT = "student-t",
    /// [`Distribution::pareto`], by two.
    Pareto = "pareto",
    /// [`Distribution::inverse_gaussian`], by two.
    InverseGaussian = "inverse-gaussian",
    /// [`Distribution::triangular`], by three.
    Triangular = "triangular",
}
}

/// What is stated, each with its value.
type Statement = (Statistic, f64);

impl Law {
    /// Whether `statistic` can be stated of the family.
    pub fn takes(self, statistic: Statistic) -> bool {
        use Statistic::{Df, Location, LogMean, LogSd, Max, Mean, Min, Mode, Scale, Sd, Shape};
        let others: &[Statistic] = match self {
            Self::Uniform | Self::LogUniform => &[Min, Max, Mean, Sd],
            Self::Normal => &[Mean, Sd, Mode],
            Self::LogNormal => &[Mean, Sd, Mode, LogMean, LogSd],
            Self::Gumbel => &[Location, Scale, Mean, Sd, Mode],
            Self::Weibull | Self::Gamma => &[Location, Scale, Shape, Mean, Sd, Mode],
            Self::Exponential => &[Location, Scale, Mean, Sd],
            Self::Logistic => &[Location, Scale, Mean, Sd, Mode],
            Self::StudentT => &[Df, Location, Scale, Mean, Sd, Mode],
            Self::Pareto => &[Min, Shape, Mean, Sd],
            Self::InverseGaussian => &[Mean, Scale, Sd, Mode],
            Self::Triangular => &[Min, Mode, Max, Mean, Sd],
        };
        statistic.is_quantile() || others.contains(&statistic)
    }

    /// What it takes to determine a distribution of the family, in words.
    pub fn needs(self) -> &'static str {
        match self {
            Self::Uniform | Self::LogUniform => {
                "two of min, max, mean, sd, p01, p05, p10, p25, p50, p75, p90, p95, p99"
            }
            Self::Normal => "two of mean, sd, mode, p01, p05, p10, p25, p50, p75, p90, p95, p99",
            Self::LogNormal => "two of mean, sd, mode, log_mean, log_sd, p01, p05, p10, p25, p50, p75, p90, p95, p99",
            Self::Gumbel | Self::Logistic => {
                "two of location, scale, mean, sd, mode, p01, p05, p10, p25, p50, p75, p90, p95, p99"
            }
            Self::Weibull | Self::Gamma => {
                "two (location 0) or three of location, scale, shape, mean, sd, mode, p01, p05, p10, p25, p50, p75, p90, p95, p99"
            }
            Self::Exponential => {
                "one (location 0) or two of location, scale, mean, sd, p01, p05, p10, p25, p50, p75, p90, p95, p99"
            }
            Self::StudentT => {
                "three of df, location, scale, mean, sd, mode, p01, p05, p10, p25, p50, p75, p90, p95, p99"
            }
            Self::Pareto => "two of shape, min, mean, sd, p01, p05, p10, p25, p50, p75, p90, p95, p99",
            Self::InverseGaussian => "two of mean, scale, sd, mode, p01, p05, p10, p25, p50, p75, p90, p95, p99",
            Self::Triangular => "three of min, mode, max, mean, sd, p01, p05, p10, p25, p50, p75, p90, p95, p99",
        }
    }

    /// Whether all values are above 0, and stay of the family in any unit without a zero of its own.
    fn is_positive(self) -> bool {
        matches!(self, Self::LogNormal | Self::LogUniform | Self::Pareto | Self::InverseGaussian)
    }

    fn is_enough(self, stated: &[Statement]) -> bool {
        let states = |statistic| stated.iter().any(|(other, _)| *other == statistic);
        match self {
            Self::Uniform | Self::LogUniform | Self::Normal | Self::LogNormal | Self::Gumbel => stated.len() == 2,
            Self::Logistic | Self::Pareto | Self::InverseGaussian => stated.len() == 2,
            Self::Weibull | Self::Gamma => stated.len() == 3 || stated.len() == 2 && !states(Statistic::Location),
            Self::Exponential => stated.len() == 2 || stated.len() == 1 && !states(Statistic::Location),
            Self::Triangular | Self::StudentT => stated.len() == 3,
        }
    }
}

impl Distribution {
    /// The distribution of the family `law` of which all of `stated` is true.
    ///
    /// Closed forms where a location and a scale are asked for; else a root in the shape, to the last
    /// digits: each statement then holds to 1e-9 standard deviations. Where several distributions of the family fit
    /// (a log-normal one of given mean and 95 % quantile may be narrow or wide), it is the narrowest.
    ///
    /// # Errors
    ///
    /// If something is stated that the family does not have, or twice; too little or too much is stated
    /// ([`Law::needs`]); quantiles and bounds are not in order; no distribution of the family fits; or as the
    /// constructor of the family.
    ///
    /// ```
    /// use apportion::space::distribution::{Law, Statistic};
    /// use apportion::Distribution;
    ///
    /// let roughness = Distribution::stated(Law::LogNormal, &[(Statistic::P05, 1.0), (Statistic::P95, 4.0)])?;
    /// assert!((roughness.median() - 2.0).abs() < 1e-12);
    /// let length = Distribution::stated(Law::Triangular, &[(Statistic::Mode, 3.0), (Statistic::P05, 1.0), (Statistic::P95, 5.0)])?;
    /// assert!((length.mean() - 3.0).abs() < 1e-9);
    /// # Ok::<(), apportion::DistributionError>(())
    /// ```
    pub fn stated(law: Law, stated: &[(Statistic, f64)]) -> Result<Self, DistributionError> {
        check(law, stated)?;
        scaled::solve(law, stated).ok_or_else(|| DistributionError::NoSuchDistribution {
            distribution: law.name(),
            statements: in_words(stated),
            first: stated[0].0.name(),
        })
    }
}

fn check(law: Law, stated: &[Statement]) -> Result<(), DistributionError> {
    for (place, (statistic, value)) in stated.iter().enumerate() {
        let (distribution, parameter) = (law.name(), statistic.name());
        if !law.takes(*statistic) {
            return Err(DistributionError::NotStated { distribution, statistic: parameter });
        }
        if stated[..place].iter().any(|(other, _)| other == statistic) {
            return Err(DistributionError::StatedTwice { statistic: parameter });
        }
        super::error::finite(parameter, *value)?;
        let positive = law.is_positive() && *statistic != Statistic::LogMean;
        let spread = matches!(statistic, Statistic::Sd | Statistic::Scale) || statistic.is_shape();
        if positive || spread {
            super::error::positive(parameter, *value)?;
        }
    }
    if !law.is_enough(stated) {
        return Err(DistributionError::Determined {
            distribution: law.name(),
            needed: law.needs(),
            given: stated.len(),
        });
    }
    let mut ordered: Vec<(f64, Statement)> =
        stated.iter().filter_map(|statement| Some((statement.0.probability()?, *statement))).collect();
    ordered.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in ordered.windows(2) {
        let ((_, (lower, low)), (_, (upper, high))) = (pair[0], pair[1]);
        if low >= high {
            return Err(DistributionError::Order { lower: lower.name(), low, upper: upper.name(), high });
        }
    }
    Ok(())
}

fn in_words(stated: &[Statement]) -> String {
    let mut text = String::new();
    for (place, (statistic, value)) in stated.iter().enumerate() {
        let joint = match place {
            0 => "",
            _ if place + 1 == stated.len() => " and ",
            _ => ", ",
        };
        let _ = write!(text, "{joint}{} = {value}", statistic.name());
    }
    text
}

/// Whether `distribution` is what was stated: to 1e-9 of its standard deviation, to which the last digits of a value
/// far from 0 may add a few.
fn is_as_stated(
    distribution: &Distribution,
    value_of: impl Fn(Statistic) -> Option<f64>,
    stated: &[Statement],
) -> bool {
    let scale = distribution.sd();
    stated.iter().all(|(statistic, value)| {
        let Some(found) = value_of(*statistic) else { return false };
        // Of pure numbers, such as shapes, the relative error counts.
        let tolerance = match statistic {
            shape if shape.is_shape() => 1e-9 * value.abs(),
            Statistic::LogMean => 1e-9,
            _ => 1e-9 * scale + 1e-13 * value.abs(),
        };
        (found - value).abs() <= tolerance
    })
}

#[cfg(test)]
mod tests;
