use proptest::prelude::*;

use super::*;

#[test]
fn small_samples_by_hand() {
    // R: quantile(c(1, 2, 4, 8), c(.25, .5, .9), type = 8) is 1.416667, 3, 8.
    let x = [1.0, 2.0, 4.0, 8.0];
    for (p, expected) in [(0.25, 1.0 + 5.0 / 12.0), (0.5, 3.0), (0.9, 8.0), (0.0, 1.0), (1.0, 8.0)] {
        assert!((quantile(&x, p) - expected).abs() < 1e-14, "{p}");
    }
    assert_eq!(quantile(&[5.0], 0.3), 5.0);
    assert!(quantile(&[], 0.3).is_nan());
    assert_eq!(quantile(&[-f64::MAX, f64::MAX], 0.5), 0.0);
}

proptest! {
    #[test]
    fn it_rises_with_p_and_stays_inside(values in prop::collection::vec(-1e9..1e9f64, 1..40), p in 0.0..1.0f64, q in 0.0..1.0f64) {
        let mut sorted = values;
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (quantile(&sorted, p.min(q)), quantile(&sorted, p.max(q)));
        // Interpolation rounds.
        prop_assert!(low <= high + 1e-6);
        prop_assert!(sorted[0] - 1e-6 <= low && high <= sorted[sorted.len() - 1] + 1e-6);
    }
}
