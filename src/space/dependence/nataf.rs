//! The correlation of normal scores that leads to a correlation of another measure (Nataf's model).

use std::f64::consts::PI;

use super::{CorrelationMeasure, DependenceError, refused};
use crate::space::copula::from_score;
use crate::space::{Distribution, Factor};

/// Returns the correlation of normal scores that leads to the correlation `stated` by `measure`.
pub(super) fn of_normal_scores(
    measure: CorrelationMeasure,
    stated: f64,
    [a, b]: [&Factor; 2],
    [x, y]: [&Standardised<'_>; 2],
) -> Result<f64, DependenceError> {
    match measure {
        CorrelationMeasure::Normal => Ok(stated),
        CorrelationMeasure::Spearman => Ok(2.0 * libm::sin(PI / 6.0 * stated)),
        CorrelationMeasure::Kendall => Ok(libm::sin(PI / 2.0 * stated)),
        CorrelationMeasure::Pearson => pearson(stated, [a, b], [x, y]),
    }
}

/// Nodes of the quadrature of a line of normal scores, and of the plane of two.
const LINE: usize = 4000;
const PLANE: usize = 240;

/// Scores beyond this are ignored by the quadrature.
const FARTHEST: f64 = 8.5;

/// Returns nodes of the midpoint rule over normal scores with their weights, which sum to 1: for smooth integrands its
/// error falls faster than any power of the distance of nodes.
fn nodes(count: usize) -> Vec<(f64, f64)> {
    let step = 2.0 * FARTHEST / count as f64;
    let places: Vec<f64> = (0..count).map(|k| -FARTHEST + step * (k as f64 + 0.5)).collect();
    let weights: Vec<f64> = places.iter().map(|place| libm::exp(-0.5 * place * place)).collect();
    let sum: f64 = weights.iter().sum();
    places.into_iter().zip(weights).map(|(place, weight)| (place, weight / sum)).collect()
}

fn pearson(stated: f64, [a, b]: [&Factor; 2], [x, y]: [&Standardised<'_>; 2]) -> Result<f64, DependenceError> {
    if stated == 0.0 || matches!((x.distribution, y.distribution), (Distribution::Normal(_), Distribution::Normal(_))) {
        return Ok(stated);
    }
    // The nodes are symmetric.
    let low = x.line.iter().zip(y.line.iter().rev()).map(|((w, x), (_, y))| w * x * y).sum::<f64>();
    let high = x.line.iter().zip(&y.line).map(|((w, x), (_, y))| w * x * y).sum::<f64>();
    if !(low < stated && stated < high) {
        return refused(format!(
            "`{}` and `{}` cannot have a Pearson correlation of {stated}: their distributions allow {low:.4} to {high:.4}",
            a.name, b.name
        ));
    }
    // The correlation rises with r (Lancaster 1957): a secant that keeps its bracket, the end that stays twice counting half.
    let (mut left, mut right) = ((-1.0, low - stated), (1.0, high - stated));
    let mut last = 0.0;
    for _ in 0..60 {
        let r: f64 = (left.0 - left.1 * (right.0 - left.0) / (right.1 - left.1)).clamp(left.0, right.0);
        let gap = correlation(r, x, y) - stated;
        if gap.abs() < 1e-9 || right.0 - left.0 < 1e-9 {
            return Ok(r);
        }
        if gap < 0.0 {
            left = (r, gap);
            right.1 *= if last < 0.0 { 0.5 } else { 1.0 };
        } else {
            right = (r, gap);
            left.1 *= if last > 0.0 { 0.5 } else { 1.0 };
        }
        last = gap;
    }
    Ok(0.5 * (left.0 + right.0))
}

/// A distribution by normal scores, less its mean and over its standard deviation.
pub(super) struct Standardised<'a> {
    distribution: &'a Distribution,
    mean: f64,
    sd: f64,
    /// Weights and values at the nodes of a line.
    line: Vec<(f64, f64)>,
    /// Coefficients of the Hermite polynomials of unit variance.
    coefficients: [f64; TERMS],
    /// Variance of the terms that are left out.
    rest: f64,
}

/// Hermite polynomials, from that of degree 0.
const TERMS: usize = 40;

/// Largest error of a correlation by Hermite polynomials.
const MAX_ERROR: f64 = 1e-10;

impl<'a> Standardised<'a> {
    pub fn new(distribution: &'a Distribution) -> Self {
        let (mean, sd) = (distribution.mean(), distribution.sd());
        let mut law = Self { distribution, mean, sd, line: Vec::new(), coefficients: [0.0; TERMS], rest: 1.0 };
        for (z, w) in nodes(LINE) {
            let value = law.at(z);
            law.line.push((w, value));
            let (mut before, mut polynomial) = (0.0, 1.0);
            for (degree, coefficient) in law.coefficients.iter_mut().enumerate() {
                *coefficient += w * value * polynomial;
                let next = (z * polynomial - (degree as f64).sqrt() * before) / ((degree + 1) as f64).sqrt();
                (before, polynomial) = (polynomial, next);
            }
        }
        law.rest -= law.coefficients.iter().map(|coefficient| coefficient * coefficient).sum::<f64>();
        law
    }

    fn at(&self, score: f64) -> f64 {
        (self.distribution.quantile(from_score(score)) - self.mean) / self.sd
    }
}

/// Returns the correlation of two standardised distributions whose scores have the correlation `r`: the sum of the products of
/// their coefficients with the powers of r (Mehler 1866) if the terms that are left out are small, otherwise by quadrature.
fn correlation(r: f64, x: &Standardised<'_>, y: &Standardised<'_>) -> f64 {
    if r.abs().powi(TERMS as i32) * (x.rest.max(0.0) * y.rest.max(0.0)).sqrt() < MAX_ERROR {
        let products = x.coefficients.iter().zip(&y.coefficients).rev();
        return products.fold(0.0, |sum, (a, b)| sum * r + a * b);
    }
    let (plane, rest) = (nodes(PLANE), (1.0 - r * r).sqrt());
    let mut sum = 0.0;
    for (z, w) in &plane {
        sum += w * x.at(*z) * plane.iter().map(|(v, w)| w * y.at(r * z + rest * v)).sum::<f64>();
    }
    sum
}
