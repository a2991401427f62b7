use super::*;

/// Compared with the antiderivative; 1e-14 for the sum.
#[test]
fn integrals_are_exact_to_rounding() {
    for end in [1e-6_f64, 0.3, 1.5] {
        assert!((integral(end, libm::cos) / libm::sin(end) - 1.0).abs() < 1e-14, "{end}");
    }
    assert_eq!(integral(0.0, libm::cos), 0.0);
}
