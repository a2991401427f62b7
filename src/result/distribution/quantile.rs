//! Sample quantiles.

/// The percentages at which quantiles are reported.
pub const PERCENTS: [f64; 11] = [0.1, 1.0, 2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5, 99.0, 99.9];

/// Returns the quantile of probability `p`, 0 to 1, of ascending values: type 8 of Hyndman and Fan (1996, Am. Stat. 50,
/// 361-365), approximately median-unbiased for any distribution. It interpolates between the order statistics at (n +
/// 1/3) p + 1/3; beyond the first and the last it returns these. NaN for no values.
pub fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let n = sorted.len() as f64;
    let place = ((n + 1.0 / 3.0) * p + 1.0 / 3.0 - 1.0).clamp(0.0, last as f64);
    let lower = place.floor() as usize;
    let (a, b) = (sorted[lower], sorted[(lower + 1).min(last)]);
    let part = place - lower as f64;
    // The difference of two large numbers of different sign could overflow; equal ones are returned unchanged.
    if a == b { a } else { a * (1.0 - part) + b * part }
}

#[cfg(test)]
mod tests {
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
}
