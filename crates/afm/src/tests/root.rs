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
