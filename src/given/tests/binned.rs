use super::*;

fn binned_first_order(x: &[f64], y: &[f64]) -> Binned {
    of_order(&Order::from_values(x), x, &crate::given::centred(y).unwrap(), true)
}

#[test]
fn two_groups_by_hand() {
    // Means 0 and 10, one degree of freedom between; within each group 0.25 x 20 x 2 squares, on 38 degrees.
    let x: Vec<f64> = (0..40).map(|k| f64::from(k % 2)).collect();
    let y: Vec<f64> = (0..40).map(|k| f64::from(k % 2) * 10.0 + if k % 4 < 2 { 0.5 } else { -0.5 }).collect();
    let got = binned_first_order(&x, &y);
    assert_eq!(got.bins, 2);
    let expected = (1000.0 - 10.0 / 38.0) / 1010.0;
    assert!((got.estimate.estimate - expected).abs() < 1e-14);
}

/// y = 3 a + b, log-normal a and b: means of bins find 0.75 instead of 0.9, in a table of a thousand rows.
#[test]
fn variation_within_a_bin_is_included() {
    let quantile = |u: f64| libm::exp(apportion_base::special::normal_quantile(u));
    let a: Vec<f64> = (0..1000).map(|k| quantile((f64::from(k) + 0.5) / 1000.0)).collect();
    let y: Vec<f64> =
        (0..1000).map(|k| 3.0 * a[k as usize] + quantile((f64::from(k * 371 % 1000) + 0.5) / 1000.0)).collect();
    let estimated = binned_first_order(&a, &y).estimate;
    let interval = estimated.interval.unwrap();
    assert!((estimated.estimate - 0.9).abs() < 0.02 && interval.low < 0.9 && 0.9 < interval.high, "{estimated:?}");
    assert!(interval.high - interval.low < 0.3, "{estimated:?}");
}

#[test]
fn the_number_of_bins_follows_its_rule() {
    for (rows, bins) in [(30, 5), (40, 6), (100, 6), (200, 8), (1000, 18), (10_000, 60)] {
        assert_eq!(bins_for(rows), bins);
    }
}

/// y = 2 (a > 0.7) + noise: S = 0.84 / (0.84 + 1/12), of which a line in the bin of the step misses up to a tenth of a bin.
#[test]
fn a_step_inside_of_a_bin_is_in_the_interval() {
    for shift in 0..20 {
        let edge = 0.65 + 0.005 * f64::from(shift);
        let x: Vec<f64> = (0..1000).map(|k| (f64::from(k) + 0.5) / 1000.0).collect();
        let y: Vec<f64> = (0..1000)
            .map(|k| 2.0 * f64::from(u8::from(x[k as usize] > edge)) + f64::from(k * 371 % 1000) / 1000.0)
            .collect();
        let variance = 4.0 * edge * (1.0 - edge);
        let (exact, estimated) = (variance / (variance + 1.0 / 12.0), binned_first_order(&x, &y).estimate);
        let interval = estimated.interval.unwrap();
        assert!(interval.low < exact && exact < interval.high && interval.width() < 0.08, "{estimated:?} {exact}");
    }
}
