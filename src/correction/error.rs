//! Errors of corrected indices.
//!
//! The contributions of base points to a corrected index behave almost like independent noise, and are skewed: squares
//! of the residuals are rarely large. The spread within the nets has many degrees of freedom, but is too large if nets
//! are more even than random points: up to fifty times the variance, at many points. The spread between the nets has no
//! such error, and few degrees of freedom; over all indices of a kind it determines how much of the spread within
//! counts. The variance is the mean of both, and each side of an interval has the degrees of freedom that its largest
//! contributions leave.

use super::influenced::EstimateWithInfluences;
use crate::uncertainty::{Estimate, Interval, Judgement, PartInfluences, StandardError, t_quantile};

/// Maximum number of parts of a net whose mean influences represent its points.
const PARTS: usize = 64;

/// Degrees of freedom of the spread within the nets as a prior.
const PRIOR_FREEDOM: f64 = 5.0;

/// Degrees of freedom of a common factor of 1 over the indices of a kind: few, since it is often below a tenth. It and
/// the next number were measured on 32 functions, 12 of them made for that, at 16 to 4096 base samples.
const COMMON_FREEDOM: f64 = 1.0;

/// Number of indices of an output that count as one independent one.
const DEPENDENCE: f64 = 2.0;

/// The two numbers for a choice between estimates by their errors.
const PRUDENT_FREEDOM: f64 = 8.0;
const PRUDENT_DEPENDENCE: f64 = 4.0;

/// Standard error of an index by rounding alone: the terms of a surrogate are not exactly orthonormal in their sums.
const ROUNDING: f64 = 1e-12;

/// Degrees of freedom of a side over the share of its largest contributions, sum x^4/(sum x^2)^2.
const FREEDOM_OF_SIDE: f64 = 0.4;

/// The joint statistics of the errors of indices of one kind, first-order or total.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrectionError {
    /// The spread between nets over that expected from within.
    common: f64,
    /// Its degrees of freedom.
    common_freedom: f64,
    /// The same factor for the choice between estimates: closer to 1.
    prudent: f64,
    /// Concentration of the influences below and above their mean.
    concentration: [f64; 2],
    /// Whether the true value is further above than below, as for sums of squares.
    skewed: bool,
    /// The scale of rounding errors: 1 for indices.
    unit: f64,
}

/// Returns the variance of the mean over all nets by the spread within them, and by that between them.
fn variances(parts: &PartInfluences) -> (f64, f64) {
    let nets = parts.len() as f64;
    let means: Vec<f64> = parts.iter().map(|net| net.iter().sum::<f64>() / net.len().max(1) as f64).collect();
    let within: f64 = parts.iter().zip(&means).map(|(net, mean)| variance_of_mean(net, *mean)).sum();
    let centre = means.iter().sum::<f64>() / nets;
    let between = means.iter().map(|mean| (mean - centre).powi(2)).sum::<f64>() / ((nets - 1.0).max(1.0) * nets);
    (within / (nets * nets), between)
}

fn variance_of_mean(net: &[f64], mean: f64) -> f64 {
    let n = net.len() as f64;
    net.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / ((n - 1.0).max(1.0) * n)
}

/// Returns sum x^4/(sum x^2)^2 over the negative and the positive influences.
fn concentration(parts: &PartInfluences) -> [f64; 2] {
    let size = parts.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if size == 0.0 {
        return [0.0; 2];
    }
    let squares: f64 = parts.iter().flatten().map(|x| (x / size).powi(2)).sum();
    [-1.0, 1.0].map(|sign| {
        let fourth = parts.iter().flatten().map(|x| if x * sign > 0.0 { (x / size).powi(4) } else { 0.0 });
        fourth.sum::<f64>() / (squares * squares)
    })
}

impl CorrectionError {
    /// Computes the statistics of indices of one kind; `skewed` for total indices.
    pub fn new<'a>(indices: impl IntoIterator<Item = &'a PartInfluences>, skewed: bool) -> Self {
        let moving: Vec<&PartInfluences> = indices.into_iter().filter(|parts| variances(parts).0 > 0.0).collect();
        // Without any, the factors are 1, as before any spread is known.
        let count = moving.len().max(1) as f64;
        let nets = moving.first().map_or(1, |parts| parts.len()) as f64;
        let ratios = moving.iter().map(|parts| variances(parts)).map(|(within, between)| between / within);
        let ratio = ratios.sum::<f64>() / count;
        let direct = (nets - 1.0) * (count / DEPENDENCE).max(1.0);
        let prudent = (nets - 1.0) * (count / PRUDENT_DEPENDENCE).max(1.0);
        let sums = moving.iter().map(|parts| concentration(parts)).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        Self {
            common: (direct * ratio + COMMON_FREEDOM) / (direct + COMMON_FREEDOM),
            common_freedom: direct + COMMON_FREEDOM,
            prudent: (prudent * ratio + PRUDENT_FREEDOM) / (prudent + PRUDENT_FREEDOM),
            concentration: sums.map(|sum| sum / count),
            skewed,
            unit: 1.0,
        }
    }

    /// Computes those of a number whose size is the scale of rounding: a mean or a variance.
    pub fn of_moment(parts: &PartInfluences, skewed: bool) -> Self {
        Self { unit: 0.0, ..Self::new([parts], skewed) }
    }

    /// Adapts them to a choice by errors: for a rare event nets may agree by chance, and all be wrong.
    pub fn prudent(self) -> Self {
        Self { common: self.prudent, ..self }
    }

    /// Removes the skewness: for differences.
    pub fn even(self) -> Self {
        let [low, high] = self.concentration;
        Self { concentration: [low.max(high); 2], skewed: false, ..self }
    }

    /// Returns the standard error of the number.
    pub fn error(&self, of: &EstimateWithInfluences) -> StandardError {
        let mut model = self.error_of_parts(&of.parts);
        let rounding = ROUNDING * of.estimate.abs().max(self.unit);
        model.error = libm::hypot(libm::hypot(model.error, of.beyond), rounding);
        if of.low.is_empty() {
            return model;
        }
        // The low-fidelity runs are independent: variances add up (the freedom after Welch and Satterthwaite).
        let low = Self::new([&of.low], false).error_of_parts(&of.low);
        let (a, b) = (model.error * model.error, low.error * low.error);
        let freedom = (a + b).powi(2) / (a * a / model.freedom + b * b / low.freedom);
        let freedom = if freedom.is_finite() { freedom } else { model.freedom.min(low.freedom) };
        StandardError { error: libm::hypot(model.error, low.error), freedom }
    }

    /// Returns the standard error of the mean of influences (its freedom after Welch and Satterthwaite).
    pub fn error_of_parts(&self, parts: &PartInfluences) -> StandardError {
        let (within, between) = variances(parts);
        let direct = parts.len() as f64 - 1.0;
        let weight = direct / (PRIOR_FREEDOM + direct);
        let variance = (1.0 - weight) * self.common * within + weight * between;
        // weight^2/direct, which is 0 for a single net.
        let freedom = ((1.0 - weight).powi(2) / self.common_freedom + weight / (PRIOR_FREEDOM + direct)).recip();
        StandardError { error: variance.sqrt(), freedom }
    }

    /// Returns the number with its interval.
    pub fn estimate(&self, of: &EstimateWithInfluences) -> Estimate {
        let (estimate, error) = (of.estimate, self.error(of));
        // The influences of missing rows are like those of existing ones: if large positive ones are rare, they are
        // missing from an estimate that is too small.
        let [low, high] = self.concentration.map(|concentration| {
            let freedom = (FREEDOM_OF_SIDE / concentration).min(error.freedom).max(1.0);
            t_quantile(freedom).map(|quantile| quantile * error.error)
        });
        let interval = low.zip(high).map(|(low, high)| {
            let q = if self.skewed && estimate > 0.0 { (high / estimate).min(1.0) } else { 0.0 };
            let stretch = if q > 1e-9 { libm::expm1(q) / q } else { 1.0 };
            Interval { low: estimate - low, high: estimate + high * stretch }
        });
        Estimate { estimate, interval: interval.and_then(Interval::finite) }
    }

    /// Returns the number with all that replaces a plain one.
    pub(super) fn judgement(self, of: &EstimateWithInfluences) -> Judgement {
        Judgement::new(self.estimate(of), self.error(of), of.parts.clone())
    }
}

/// Returns the contributions of the points of every net as influences of up to 64 parts of each.
pub(super) fn in_parts(nets: &[Vec<f64>]) -> PartInfluences {
    nets.iter().map(|points| means_of_parts(points)).collect()
}

fn means_of_parts(points: &[f64]) -> Vec<f64> {
    let (count, parts) = (points.len(), points.len().min(PARTS));
    let parts = (0..parts).map(|k| &points[k * count / parts..(k + 1) * count / parts]);
    parts.map(|part| part.iter().sum::<f64>() / part.len() as f64).collect()
}
