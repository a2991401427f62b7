use super::*;

#[test]
fn intervals_of_one_factor_can_both_be_true() {
    let estimate =
        |low: f64, high: f64| Estimate { estimate: (low + high) / 2.0, interval: Some(Interval { low, high }) };
    let (first, total, contradictory) = agreeing(estimate(0.30, 0.34), estimate(0.20, 0.24));
    assert!(contradictory);
    let (first, total) = (first.interval.unwrap(), total.interval.unwrap());
    assert!((first.low - 0.22).abs() < 1e-12 && (total.high - 0.32).abs() < 1e-12, "{first:?} {total:?}");
    assert_eq!((first.high, total.low), (0.34, 0.20));
    let touching = (estimate(0.23, 0.34), estimate(0.20, 0.24));
    assert_eq!(agreeing(touching.0, touching.1), (touching.0, touching.1, false));
    let unknown = Estimate::alone(0.9);
    assert_eq!(agreeing(unknown, touching.1), (unknown, touching.1, false));
}
