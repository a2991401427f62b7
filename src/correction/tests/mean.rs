use super::*;

#[test]
fn relative_errors_of_a_quotient_add_up_as_squares() {
    let of = |estimate: f64, half: f64| Estimate { estimate, interval: Some(Interval::about(estimate, half)) };
    let found = quotient(of(0.3, 0.03), of(0.6, 0.06));
    let interval = found.interval.unwrap();
    assert_eq!(found.estimate, 0.5);
    assert!((interval.high - 0.5 - 0.05 * 2f64.sqrt()).abs() < 1e-12, "{interval:?}");
    assert_eq!(quotient(of(0.3, 0.03), Estimate::alone(0.6)).interval, None);
}
