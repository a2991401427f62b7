//! Quadrature for the moments that have no formula without cancellation.

/// The integral of a smooth function, by the Gauss-Legendre rule of five points on each of 200 panels.
pub(super) fn integral(from: f64, to: f64, function: impl Fn(f64) -> f64) -> f64 {
    const PANELS: u32 = 200;
    // Abramowitz and Stegun 1964, table 25.4.
    const NODES: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let half = 0.5 * (to - from) / f64::from(PANELS);
    let panel = |index: u32| {
        let middle = from + half * f64::from(2 * index + 1);
        let pair = |(node, weight): (f64, f64)| {
            let sum = function(middle - half * node) + function(middle + half * node);
            // The middle node is counted twice by the pair.
            if node == 0.0 { 0.5 * weight * sum } else { weight * sum }
        };
        NODES.into_iter().map(pair).sum::<f64>()
    };
    half * (0..PANELS).map(panel).sum::<f64>()
}
