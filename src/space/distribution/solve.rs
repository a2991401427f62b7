//! Quantiles by the logarithm of a distribution function and its derivatives.

/// Residual of the logarithm of a probability, and step, after which one more step of third order is enough.
const CLOSE: f64 = 1e-5;

/// A limit that is never reached.
const MAX_STEPS: u32 = 60;

/// Returns the root, between two bounds, of a logarithm minus its target, by Halley's iteration from `start`, and the
/// number of steps. `log` returns the residual, its slope, and twice the curvature over the slope.
pub(super) fn halley(start: f64, (low, high): (f64, f64), log: impl Fn(f64) -> (f64, f64, f64)) -> (f64, u32) {
    let mut d = start;
    for steps in 1..=MAX_STEPS {
        let (residual, slope, curvature) = log(d);
        let step = residual / slope;
        d = (d - step / (1.0 - 0.5 * step * curvature).max(0.5)).max(low).min(high);
        if residual.abs().max(step.abs()) < CLOSE {
            return (d, steps);
        }
    }
    (d, MAX_STEPS)
}

/// Returns the root nearer to 0 of a parabola of this slope and curvature at 0 that rises by `target` <= 0.
pub(super) fn parabola(slope: f64, curvature: f64, target: f64) -> f64 {
    2.0 * target / (slope + (slope * slope - 2.0 * curvature * target).max(0.0).sqrt())
}
