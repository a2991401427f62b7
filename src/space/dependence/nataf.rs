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
    let place = |k: usize| -FARTHEST + step * (k as f64 + 0.5);
    let weights: Vec<f64> = (0..count).map(|k| libm::exp(-0.5 * place(k) * place(k))).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().enumerate().map(|(k, weight)| (place(k), weight / sum)).collect()
}

fn pearson(stated: f64, a: &Factor, b: &Factor) -> Result<f64, DependenceError> {
    let [x, y] = [a, b].map(Factor::distribution);
    if stated == 0.0 || matches!((x, y), (Distribution::Normal(_), Distribution::Normal(_))) {
        return Ok(stated);
    }
    let standardised = |law: &'_ Distribution| {
        let (law, mean, sd) = (law.clone(), law.mean(), law.sd());
        move |score: f64| (law.quantile(from_score(score)) - mean) / sd
    };
    let [x, y] = [x, y].map(standardised);
    let line = nodes(LINE);
    let extreme = |sign: f64| line.iter().map(|(z, w)| w * x(*z) * y(sign * z)).sum::<f64>();
    let (low, high) = (extreme(-1.0), extreme(1.0));
    if !(low < stated && stated < high) {
        return refused(format!(
            "`{}` and `{}` cannot have a Pearson correlation of {stated}: their distributions allow {low:.4} to {high:.4}",
            a.name, b.name
        ));
    }
    let plane = nodes(PLANE);
    let of_x: Vec<f64> = plane.iter().map(|(z, _)| x(*z)).collect();
    let correlation = |r: f64| {
        let rest = (1.0 - r * r).sqrt();
        let inner = |z: f64| plane.iter().map(|(v, w)| w * y(r * z + rest * v)).sum::<f64>();
        plane.iter().zip(&of_x).map(|((z, w), x)| w * x * inner(*z)).sum::<f64>()
    };
    // The correlation rises with r (Lancaster 1957): a secant that keeps its bracket, the end that stays twice counting half.
    let (mut left, mut right) = ((-1.0, low - stated), (1.0, high - stated));
    let mut last = 0.0;
    for _ in 0..60 {
        let r: f64 = (left.0 - left.1 * (right.0 - left.0) / (right.1 - left.1)).clamp(left.0, right.0);
        let gap = correlation(r) - stated;
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
