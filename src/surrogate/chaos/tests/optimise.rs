use super::*;

/// The function of Rosenbrock (1960).
fn rosenbrock(x: &[f64]) -> (f64, Vec<f64>) {
    let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
    (a * a + 100.0 * b * b, vec![-2.0 * a - 400.0 * b * x[0], 200.0 * b])
}

#[test]
fn a_valley_is_followed_to_its_end_or_to_a_bound() {
    let free = minimise(&mut rosenbrock, &[-1.2, 1.0], &[(-5.0, 5.0); 2], 200);
    assert!(free.iter().all(|x| (x - 1.0).abs() < 1e-4), "{free:?}");
    // On x1 = 1/2 the least is at x2 = 1/4.
    let held = minimise(&mut rosenbrock, &[-1.2, 1.0], &[(-5.0, 0.5), (-5.0, 5.0)], 200);
    assert!(held[0] == 0.5 && (held[1] - 0.25).abs() < 1e-4, "{held:?}");
}
