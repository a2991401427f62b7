//! Families of a location, a scale and at most one shape: x = location + scale z, with z of the standard distribution.
//!
//! Every statement is linear in location and scale: a + b z-statistic = value. Two statements give both; a third one
//! gives the shape, at which the determinant of the three lines (1 or 0, z-statistic, value) vanishes.

use super::super::Distribution;
use super::root::{evenly, first_zero};
use super::{Law, Statement, Statistic, is_as_stated};

/// A statement of the standard distribution: coefficients of location and scale, and the value.
type Line = [f64; 3];

pub(super) fn solve(law: Law, stated: &[Statement]) -> Option<Distribution> {
    // Of a symmetric distribution these are one.
    let middle = |s: Statistic| matches!(s, Statistic::Location | Statistic::Mean | Statistic::Mode | Statistic::P50);
    if law == Law::StudentT && stated.iter().filter(|(statistic, _)| middle(*statistic)).count() > 1 {
        return None;
    }
    let accept = |shape: f64| {
        let (location, scale) = Lines::of(law, shape, stated)?.located()?;
        let found = made(law, location, scale, shape, stated)?;
        is_as_stated(&found, |statistic| statistic_of(law, &found, statistic, shape), stated).then_some(found)
    };
    if let Some((_, shape)) = stated.iter().find(|(statistic, _)| statistic.is_shape()) {
        return accept(*shape);
    }
    // From narrow to wide.
    let logs: (f64, f64, u32) = match law {
        Law::LogNormal => (1e-9, 26.0, 500),
        Law::LogUniform => (1e-9, 700.0, 500),
        Law::Weibull => (1e4, 0.015, 500),
        Law::Gamma => (1e5, 1e-3, 300),
        Law::StudentT => (2e5, 2.0001, 300),
        Law::Pareto => (1e6, 2.0001, 500),
        // The sd of a mean of 1.
        Law::InverseGaussian => (1e-5, 1e5, 300),
        Law::Triangular => {
            return first_zero(evenly(0.0, 1.0, 401), |shape| determinant(law, shape, stated), accept);
        }
        _ => return accept(f64::NAN),
    };
    let (from, to, count) = logs;
    let by_log = |log: f64| determinant(law, libm::exp(log), stated);
    first_zero(evenly(libm::log(from), libm::log(to), count), by_log, |log| accept(libm::exp(log)))
}

/// The distribution of location 0 (or least value 0) and scale 1.
fn standard(law: Law, shape: f64) -> Option<Distribution> {
    match law {
        Law::Uniform => Distribution::uniform(0.0, 1.0),
        Law::Normal => Distribution::normal(0.0, 1.0),
        Law::Gumbel => Distribution::gumbel(0.0, 1.0),
        Law::LogUniform => Distribution::log_uniform(1.0, libm::exp(shape)),
        Law::LogNormal => Distribution::log_normal_of_logs(0.0, shape),
        Law::Weibull => Distribution::weibull(shape, 1.0, 0.0),
        Law::Gamma => Distribution::gamma(shape, 1.0, 0.0),
        Law::Exponential => Distribution::exponential(1.0, 0.0),
        Law::Logistic => Distribution::logistic(0.0, 1.0),
        Law::StudentT => Distribution::student_t(shape, 0.0, 1.0),
        Law::Pareto => Distribution::pareto(shape, 1.0),
        Law::InverseGaussian => Distribution::inverse_gaussian(1.0, shape.powi(-2)),
        Law::Triangular => Distribution::triangular(0.0, shape, 1.0),
    }
    .ok()
}

fn statistic_of(law: Law, distribution: &Distribution, statistic: Statistic, shape: f64) -> Option<f64> {
    Some(match statistic {
        Statistic::Mean => distribution.mean(),
        Statistic::Sd => distribution.sd(),
        Statistic::Mode | Statistic::Location | Statistic::Scale | Statistic::LogMean => {
            return parameter_of(law, distribution, statistic, shape);
        }
        Statistic::Shape | Statistic::Df | Statistic::LogSd => shape,
        other => distribution.quantile(other.probability()?),
    })
}

/// What only the parameters of a distribution tell.
fn parameter_of(law: Law, distribution: &Distribution, statistic: Statistic, shape: f64) -> Option<f64> {
    let parameters = distribution.parameters();
    let parameter = |name: &str| {
        parameters.iter().find(|(other, _)| *other == name).and_then(|(_, value)| match value {
            super::super::Parameter::Number(number) => Some(*number),
            _ => None,
        })
    };
    match (law, statistic) {
        (Law::Normal, Statistic::Mode) => parameter("mean"),
        (Law::Triangular, Statistic::Mode) => parameter("mode"),
        (Law::Gumbel | Law::Logistic | Law::StudentT, Statistic::Mode) => parameter("location"),
        (Law::Gamma, Statistic::Mode) => {
            let (location, scale) = parameter("location").zip(parameter("scale"))?;
            Some(location + scale * (shape - 1.0).max(0.0))
        }
        // mean (sqrt(1 + c^2) - c) with c = 3 mean / (2 scale)
        (Law::InverseGaussian, Statistic::Mode) => {
            let c = 1.5 * shape * shape;
            parameter("mean").map(|mean| mean / (libm::hypot(c, 1.0) + c))
        }
        (Law::LogNormal, Statistic::LogMean) => parameter("log_mean"),
        // exp(mu - sigma^2), the mode of a log-normal distribution.
        (Law::LogNormal, Statistic::Mode) => parameter("log_mean").map(|log_mean| libm::exp(log_mean - shape * shape)),
        (Law::Weibull, Statistic::Mode) => {
            let (location, scale) = parameter("location").zip(parameter("scale"))?;
            Some(location + scale * weibull_mode(shape))
        }
        (_, Statistic::Location) => parameter("location"),
        (_, Statistic::Scale) => parameter("scale"),
        _ => None,
    }
}

/// The mode of a Weibull distribution at location 0 and scale 1: ((k - 1)/k)^(1/k), 0 for shapes k up to 1.
fn weibull_mode(shape: f64) -> f64 {
    if shape > 1.0 { libm::exp(libm::log1p(-shape.recip()) / shape) } else { 0.0 }
}

/// The statements as lines, for one shape.
struct Lines {
    lines: Vec<Line>,
    /// What was taken off the values, so that those far from 0 keep their digits.
    origin: f64,
}

impl Lines {
    fn of(law: Law, shape: f64, stated: &[Statement]) -> Option<Self> {
        let standard = standard(law, shape)?;
        let mut lines = Vec::with_capacity(3);
        let at_zero = match law {
            Law::Weibull | Law::Gamma => stated.len() == 2,
            Law::Exponential => stated.len() == 1,
            law => law.is_positive(),
        };
        if at_zero {
            lines.push([1.0, 0.0, 0.0]);
        }
        for (statistic, value) in stated {
            lines.push(match statistic {
                Statistic::Sd => [0.0, standard.sd(), *value],
                // That of an inverse Gaussian distribution grows with the mean.
                Statistic::Scale if law == Law::InverseGaussian => [0.0, shape.powi(-2), *value],
                Statistic::Scale => [0.0, 1.0, *value],
                Statistic::Location => [1.0, 0.0, *value],
                // The scale of a log-normal distribution is exp(log_mean).
                Statistic::LogMean => [0.0, 1.0, libm::exp(*value)],
                shape if shape.is_shape() => continue,
                other => [1.0, statistic_of(law, &standard, *other, shape)?, *value],
            });
        }
        let origin = lines.iter().find(|line| line[0] == 1.0).map_or(0.0, |line| line[2]);
        lines.iter_mut().for_each(|line| line[2] -= line[0] * origin);
        Some(Self { lines, origin })
    }

    /// Location and scale from the two lines that determine them best.
    fn located(&self) -> Option<(f64, f64)> {
        let lines = &self.lines;
        let pairs = (0..lines.len()).flat_map(|i| (i + 1..lines.len()).map(move |j| (i, j)));
        let (_, i, j) = pairs
            .map(|(i, j)| ((lines[i][0] * lines[j][1] - lines[i][1] * lines[j][0]).abs(), i, j))
            // The coefficients are of order 1: lines of no more angle than this are one line.
            .filter(|(size, ..)| *size > 1e-12)
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let ([a, b, v], [c, d, w]) = (lines[i], lines[j]);
        let size = a * d - b * c;
        let (location, scale) = ((v * d - b * w) / size, (a * w - v * c) / size);
        (scale > 0.0 && scale.is_finite()).then_some((self.origin + location, scale))
    }
}

/// Zero where three statements agree; NaN where the standard distribution does not exist.
fn determinant(law: Law, shape: f64, stated: &[Statement]) -> f64 {
    let Some(Lines { lines, .. }) = Lines::of(law, shape, stated) else { return f64::NAN };
    let [a, b, c] = lines[..] else { return f64::NAN };
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The distribution, its own parameters as stated where they are stated.
fn made(law: Law, location: f64, scale: f64, shape: f64, stated: &[Statement]) -> Option<Distribution> {
    let or = |statistic: Statistic, value: f64| {
        stated.iter().find(|(other, _)| *other == statistic).map_or(value, |(_, stated)| *stated)
    };
    match law {
        Law::Uniform => Distribution::uniform(or(Statistic::Min, location), or(Statistic::Max, location + scale)),
        Law::Normal => {
            Distribution::normal(or(Statistic::Mean, or(Statistic::Mode, location)), or(Statistic::Sd, scale))
        }
        Law::Gumbel => {
            Distribution::gumbel(or(Statistic::Location, or(Statistic::Mode, location)), or(Statistic::Scale, scale))
        }
        Law::LogUniform => {
            Distribution::log_uniform(or(Statistic::Min, scale), or(Statistic::Max, scale * libm::exp(shape)))
        }
        Law::LogNormal => Distribution::log_normal_of_logs(or(Statistic::LogMean, libm::log(scale)), shape),
        Law::Weibull => Distribution::weibull(shape, or(Statistic::Scale, scale), or(Statistic::Location, location)),
        Law::Gamma => Distribution::gamma(shape, or(Statistic::Scale, scale), or(Statistic::Location, location)),
        Law::Exponential => {
            Distribution::exponential(or(Statistic::Scale, or(Statistic::Sd, scale)), or(Statistic::Location, location))
        }
        Law::Logistic => {
            let middle = or(Statistic::Location, or(Statistic::Mean, or(Statistic::Mode, location)));
            Distribution::logistic(middle, or(Statistic::Scale, scale))
        }
        Law::StudentT => {
            let middle = or(Statistic::Location, or(Statistic::Mean, or(Statistic::Mode, location)));
            Distribution::student_t(shape, middle, or(Statistic::Scale, scale))
        }
        Law::Pareto => Distribution::pareto(shape, or(Statistic::Min, scale)),
        Law::InverseGaussian => {
            let mean = or(Statistic::Mean, scale);
            let variation = or(Statistic::Sd, mean * shape) / mean;
            Distribution::inverse_gaussian(mean, or(Statistic::Scale, mean / (variation * variation)))
        }
        Law::Triangular => {
            let (min, max) = (or(Statistic::Min, location), or(Statistic::Max, location + scale));
            Distribution::triangular(min, or(Statistic::Mode, location + scale * shape).clamp(min, max), max)
        }
    }
    .ok()
}
