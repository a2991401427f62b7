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
mod tests {
    use super::*;

    fn solve(f: impl Fn(f64) -> f64, low: f64, high: f64) -> (f64, usize) {
        let mut count = 0;
        let point = |x| Point { x, y: f(x) };
        let root = between(point(low), point(high), |x| {
            count += 1;
            Ok(f(x))
        });
        (root.unwrap(), count)
    }

    /// Roots known in closed form, to 4 units roundoff (the stopping width and the rounding of the function).
    #[test]
    fn known_roots() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 5] = [
            (|x| x * x - 2.0, 0.0, 2.0, std::f64::consts::SQRT_2),
            (|x| libm::cos(x), 0.0, 3.0, std::f64::consts::FRAC_PI_2),
            (|x| libm::exp(x) - 1e9, 0.0, 700.0, 9.0 * std::f64::consts::LN_10),
            (|x| x - 1e-200, 0.0, 1.0, 1e-200),
            (|x| (x - 0.3).powi(3), 0.0, 1.0, 0.3),
        ];
        for (f, low, high, root) in cases {
            let (found, count) = solve(f, low, high);
            assert!((found / root - 1.0).abs() < 4.0 * f64::EPSILON, "{found} {root}");
            assert!(count < 800, "{count}");
            assert_eq!(solve(f, high, low).0, found, "the order of the ends does not matter");
        }
    }

    #[test]
    fn smooth_functions_take_few_evaluations() {
        assert!(solve(|x| libm::exp(x) - 2.0, 0.0, 1.0).1 <= 9);
    }

    #[test]
    fn a_jump_is_a_root() {
        let (found, _) = solve(|x| if x < 0.7 { -1.0 } else { 1.0 }, 0.0, 1.0);
        assert!((found - 0.7).abs() < 4.0 * f64::EPSILON);
    }

    #[test]
    fn undefined_values_end_the_search() {
        solve(|x| if x < 0.5 { -1.0 } else { f64::NAN }, 0.0, 1.0);
        let failing = between(Point { x: 0.0, y: -1.0 }, Point { x: 1.0, y: 1.0 }, |_| Err(Failure::BeyondPullOff));
        assert_eq!(failing, Err(Failure::BeyondPullOff));
    }
}
