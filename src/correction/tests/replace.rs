use super::super::kind::gap;
use super::*;

fn estimate(estimate: f64, half_width: f64) -> Estimate {
    Estimate { estimate, interval: Some(Interval::about(estimate, half_width)) }
}

#[test]
fn gaps_are_measured_by_both_intervals() {
    assert!((gap(estimate(0.3, 0.1), estimate(0.9, 0.02)) - 5.0).abs() < 1e-12);
    assert!((gap(estimate(0.9, 0.02), estimate(0.3, 0.1)) - 5.0).abs() < 1e-12);
    assert_eq!(gap(Estimate::alone(0.3), estimate(0.9, 0.1)), 0.0);
    assert_eq!(gap(estimate(0.3, 0.0), estimate(0.3, 0.0)), 0.0);
}

#[test]
fn one_index_far_off_contradicts_and_all_of_them_a_little() {
    let judged = |gaps: Vec<f64>| {
        let gaps = Gaps::new(&[&gaps, &[0.1; 4]]);
        (gaps.is_doubt(), gaps.refusal().is_some())
    };
    assert_eq!(judged(vec![2.5, 0.2, 0.1, 0.3]), (false, false));
    assert_eq!([judged(vec![4.0, 0.0, 0.0, 0.0]), judged(vec![2.0; 4])], [(true, false); 2]);
    assert_eq!([judged(vec![10.1, 0.0, 0.0, 0.0]), judged(vec![6.1; 4])], [(true, true); 2]);
}
