//! A root between two points where a continuous function has opposite signs.

use super::Failure;

/// A point and the value of the function there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
}

/// Number of iterations after which interpolation is replaced by plain halving.
const PATIENCE: usize = 64;

/// Returns the root of `f` between `a` and `b`, whose values have opposite signs, to two units roundoff of the root.
///
/// Chandrupatla 1997: inverse quadratic interpolation where it is safe, halving elsewhere, so that it always ends.
/// Adv. Eng. Softw. 28, 145.
///
/// # Errors
/// Those of `f`.
pub(super) fn between(a: Point, b: Point, mut f: impl FnMut(f64) -> Result<f64, Failure>) -> Result<f64, Failure> {
    let (mut newest, mut opposite) = (a, b);
    let mut fraction = 0.5_f64;
    let mut iterations = 0;
    loop {
        let best = if newest.y.abs() < opposite.y.abs() { newest } else { opposite };
        let width = (opposite.x - newest.x).abs();
        let limit = (2.0 * f64::EPSILON * best.x.abs() + f64::MIN_POSITIVE) / width;
        // Also ends if a value is not a number, or the width is zero.
        if best.y == 0.0 || limit > 0.5 || limit.is_nan() {
            return Ok(best.x);
        }
        let x = newest.x + fraction.clamp(limit, 1.0 - limit) * (opposite.x - newest.x);
        let next = Point { x, y: f(x)? };
        let third;
        if (next.y > 0.0) == (newest.y > 0.0) {
            third = newest;
        } else {
            third = opposite;
            opposite = newest;
        }
        newest = next;
        iterations += 1;
        fraction = if iterations < PATIENCE { interpolate(newest, opposite, third) } else { 0.5 };
    }
}

/// Returns where the inverse parabola through three points vanishes, as a fraction of the way from the first to the
/// second; one half if the parabola is unreliable.
fn interpolate(newest: Point, opposite: Point, third: Point) -> f64 {
    let xi = (newest.x - opposite.x) / (third.x - opposite.x);
    let phi = (newest.y - opposite.y) / (third.y - opposite.y);
    if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
        newest.y / (opposite.y - newest.y) * third.y / (opposite.y - third.y)
            + (third.x - newest.x) / (opposite.x - newest.x) * newest.y / (third.y - newest.y) * opposite.y
                / (third.y - opposite.y)
    } else {
        0.5
    }
}

#[cfg(test)]
#[path = "tests/root.rs"]
mod tests;
