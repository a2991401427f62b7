//! The correlation of normal scores that leads to a correlation of another measure (Nataf's model).

use std::f64::consts::PI;

use super::{CorrelationMeasure, DependenceError, refused};
use crate::space::copula::from_score;
use crate::space::{Distribution, Factor};

/// Returns the correlation of normal scores that leads to the correlation `stated` by `measure`.
pub(super) fn of_normal_scores(
    measure: CorrelationMeasure,
    stated: f64,
    a: &Factor,
    b: &Factor,
) -> Result<f64, DependenceError> {
    match measure {
        CorrelationMeasure::Normal => Ok(stated),
        CorrelationMeasure::Spearman => Ok(2.0 * libm::sin(PI / 6.0 * stated)),
        CorrelationMeasure::Kendall => Ok(libm::sin(PI / 2.0 * stated)),
        CorrelationMeasure::Pearson => pearson(stated, a, b),
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

fn pearson(stated: f64, a: &Factor, b: &Factor) -> Result<f64, DependenceError> {
    let [x, y] = [a, b].map(Factor::distribution);
    if stated == 0.0 || matches!((x, y), (Distribution::Normal(_), Distribution::Normal(_))) {
        return Ok(stated);
    }
    let [x, y] = [x, y].map(|law| Standardised { distribution: law, mean: law.mean(), sd: law.sd() });
    let line = nodes(LINE);
    let [low, high] = [-1.0, 1.0].map(|sign| line.iter().map(|(z, w)| w * x.at(*z) * y.at(sign * z)).sum::<f64>());
    if !(low < stated && stated < high) {
        return refused(format!(
            "`{}` and `{}` cannot have a Pearson correlation of {stated}: their distributions allow {low:.4} to {high:.4}",
            a.name, b.name
        ));
    }
    let plane = nodes(PLANE);
    let of_x: Vec<f64> = plane.iter().map(|(z, _)| x.at(*z)).collect();
    // The correlation rises with r (Lancaster 1957): a secant that keeps its bracket, the end that stays twice counting half.
    let (mut left, mut right) = ((-1.0, low - stated), (1.0, high - stated));
    let mut last = 0.0;
    for _ in 0..60 {
        let r: f64 = (left.0 - left.1 * (right.0 - left.0) / (right.1 - left.1)).clamp(left.0, right.0);
        let gap = correlation(r, &plane, &of_x, &y) - stated;
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
struct Standardised<'a> {
    distribution: &'a Distribution,
    mean: f64,
    sd: f64,
}

impl Standardised<'_> {
    fn at(&self, score: f64) -> f64 {
        (self.distribution.quantile(from_score(score)) - self.mean) / self.sd
    }
}

/// Returns the correlation of two standardised distributions whose scores have the correlation `r`; `of_x` is the first
/// at the nodes of `plane`.
fn correlation(r: f64, plane: &[(f64, f64)], of_x: &[f64], y: &Standardised<'_>) -> f64 {
    let rest = (1.0 - r * r).sqrt();
    let mut sum = 0.0;
    for ((z, w), x) in plane.iter().zip(of_x) {
        sum += w * x * plane.iter().map(|(v, w)| w * y.at(r * z + rest * v)).sum::<f64>();
    }
    sum
}
