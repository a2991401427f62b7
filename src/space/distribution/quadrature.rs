//! Quadrature for moments without a cancellation-free formula.

use std::f64::consts::PI;

/// Nodes from 0 up and weights of the Gauss-Legendre rule of five points on -1 to 1 (Abramowitz and Stegun 1964, table 25.4).
const NODES: [(f64, f64); 3] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Returns twice the mean of a smooth function within `half` of `middle`, by the Gauss-Legendre rule of five points.
fn panel(middle: f64, half: f64, function: &impl Fn(f64) -> f64) -> f64 {
    let pairs = NODES.into_iter().map(|(node, weight)| {
        let sum = function(middle - half * node) + function(middle + half * node);
        // The middle node is counted twice by the pair.
        if node == 0.0 { 0.5 * weight * sum } else { weight * sum }
    });
    pairs.sum::<f64>()
}

/// Returns the integral of a smooth function, by the Gauss-Legendre rule of five points on each of 200 panels.
pub(super) fn integral(from: f64, to: f64, function: impl Fn(f64) -> f64) -> f64 {
    const PANELS: u32 = 200;
    let half = 0.5 * (to - from) / f64::from(PANELS);
    half * (0..PANELS).map(|index| panel(from + half * f64::from(2 * index + 1), half, &function)).sum::<f64>()
}

/// Iterates over the nodes u, 1 - u and the weights, from 0 to 1, of the tanh-sinh rule (Takahasi and Mori 1974, Publ.
/// RIMS Kyoto Univ. 9, 721-741), which allows singularities at the ends; u and 1 - u go down to 1e-290.
pub(super) fn nodes() -> impl Iterator<Item = (f64, f64, f64)> {
    const STEP: f64 = 1.0 / 32.0;
    (-193..=193).map(|index| {
        let t = STEP * f64::from(index);
        let ratio = libm::exp(-PI * libm::sinh(t).abs());
        let (small, large) = (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio));
        let weight = STEP * PI * libm::cosh(t) * small * large;
        if t < 0.0 { (small, large, weight) } else { (large, small, weight) }
    })
}

/// Returns mean and standard deviation of the values `quantile(u, v)`, v = 1 - u, for u from 0 to 1.
pub(super) fn moments(quantile: impl Fn(f64, f64) -> f64) -> (f64, f64) {
    let origin = quantile(0.5, 0.5);
    let (mut first, mut second) = (0.0, 0.0);
    for (below, above, weight) in nodes() {
        let deviation = quantile(below, above) - origin;
        first += weight * deviation;
        second += weight * deviation * deviation;
    }
    (origin + first, (second - first * first).max(0.0).sqrt())
}
