use std::f64::consts::PI;

use super::*;

#[test]
fn values_in_closed_form() {
    // psi'(1) = pi^2/6, psi'(1/2) = pi^2/2, psi''(1) = -2 zeta(3).
    assert!((trigamma(1.0) - PI * PI / 6.0).abs() < 1e-13);
    assert!((trigamma(0.5) - PI * PI / 2.0).abs() < 1e-13);
    assert!((tetragamma(1.0) + 2.0 * 1.202_056_903_159_594_2).abs() < 1e-12);
    // E ln chi^2_2 - ln 2 = -Euler's constant.
    assert!((log_bias(2.0) + 0.577_215_664_901_532_9).abs() < 1e-12);
}

#[test]
fn freedom_inverts_the_variance_at_every_size() {
    for freedom in [0.05, 0.5, 1.0, 2.0, 5.0, 30.0, 1e3, 1e6] {
        let back = freedom_of_log_variance(log_variance(freedom));
        assert!((back / freedom - 1.0).abs() < 1e-8, "{freedom}: {back}");
    }
}
