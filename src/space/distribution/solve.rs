//! Quantiles of distributions whose distribution function alone is known, or its derivatives too.

/// The least x from `low` to `high` with P(X <= x) >= `u`, `v` being 1 - u; `tails` gives P(X <= x) and P(X > x).
///
/// By the secant method on the logarithm of the smaller probability, with bisections of the bit patterns wherever it is
/// slow, so that values of any magnitude are found in a few steps, and those that have a probability of their own exactly.
pub(super) fn quantile(u: f64, v: f64, (mut low, mut high): (f64, f64), tails: impl Fn(f64) -> (f64, f64)) -> f64 {
    // In the place of ln 0: below the logarithm of every double above 0.
    const MIN_LOG: f64 = -800.0;
    let residual = |x: f64| {
        let (below, above) = tails(x);
        if u <= v { libm::log(below / u).max(MIN_LOG) } else { -libm::log(above / v).max(MIN_LOG) }
    };
    let close = 1e-15 * (1.0 - libm::log(u.min(v)));
    let mut before = residual(low);
    // At NaN nothing is known.
    if before >= 0.0 || before.is_nan() || low >= high {
        return low;
    }
    let mut after = residual(high);
    if after <= 0.0 || after.is_nan() {
        return high;
    }
    let (mut slow, mut moved) = (0, Moved::Neither);
    loop {
        let width = high - low;
        let secant = low + width * (before / (before - after));
        let by_secant = slow < 2 && low < secant && secant < high;
        let x = if by_secant { secant } else { middle(low, high) };
        if x <= low || x >= high {
            return high;
        }
        let here = residual(x);
        if here.abs() <= close {
            return x;
        }
        // An end that stays twice counts half, lest the other one creeps (the Illinois method).
        if here < 0.0 {
            after *= if moved == Moved::Low { 0.5 } else { 1.0 };
            (low, before, moved) = (x, here, Moved::Low);
        } else {
            before *= if moved == Moved::High { 0.5 } else { 1.0 };
            (high, after, moved) = (x, here, Moved::High);
        }
        slow = if high - low > 0.5 * width && slow < 2 { slow + 1 } else { 0 };
        if !by_secant {
            moved = Moved::Neither;
        }
    }
}

/// The end of the bracket that a secant moved last.
#[derive(Clone, Copy, PartialEq)]
enum Moved {
    Low,
    High,
    Neither,
}

/// A number between two, half way in the order of all doubles.
fn middle(low: f64, high: f64) -> f64 {
    if low < 0.0 && high > 0.0 {
        return 0.0;
    }
    let half = |a: f64, b: f64| f64::from_bits(a.to_bits() + (b.to_bits() - a.to_bits()) / 2);
    // The magnitudes of numbers of one sign are in the order of their bits. -0 has those of 0 here.
    if high <= 0.0 { -half(high.abs(), low.abs()) } else { half(low.abs(), high) }
}

/// Residual of the logarithm of a probability, and step, from which one more step, of third order, leaves less than rounding.
const CLOSE: f64 = 1e-5;

/// Never reached.
const MAX_STEPS: u32 = 60;

/// The root, between two bounds, of a logarithm less its target, by Halley's iteration from `start`, and the steps taken. `log` gives
/// the residual, its slope, and what twice the curvature is of the slope.
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

/// The root nearer to 0 of a parabola of this slope and curvature at 0 that has to rise by `target`, which is not positive.
pub(super) fn parabola(slope: f64, curvature: f64, target: f64) -> f64 {
    2.0 * target / (slope + (slope * slope - 2.0 * curvature * target).max(0.0).sqrt())
}
