//! Moments and histogram of samples with known answers.

use proptest::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

use super::*;

fn distribution(values: &[f64]) -> OutputDistribution {
    OutputDistribution::from_values(values, &Unit::dimensionless()).unwrap()
}

/// The middles of n slices of equal probability of a distribution.
fn ideal(n: usize, inverse: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..n).map(|k| inverse((k as f64 + 0.5) / n as f64)).collect()
}

fn normal(n: usize) -> Vec<f64> {
    ideal(n, |p| Normal::standard().inverse_cdf(p))
}

#[test]
fn small_samples_by_hand() {
    let d = distribution(&[1.0, 2.0, 4.0, 9.0]);
    assert_eq!((d.count, d.mean, d.min, d.max), (4, 4.0, 1.0, 9.0));
    // Deviations -3, -2, 0, 5: squares 38, cubes 90, fourth powers 722.
    assert!((d.sd.unwrap() - (38.0f64 / 3.0).sqrt()).abs() < 1e-14);
    assert!((d.skewness.unwrap() - 22.5 / libm::pow(9.5f64, 1.5)).abs() < 1e-14);
    assert!((d.excess_kurtosis.unwrap() - (180.5 / 90.25 - 3.0)).abs() < 1e-14);
    assert_eq!(d.quantile(50.0), Some(3.0));
    let d = distribution(&[-1.0, 1.0]);
    assert_eq!((d.skewness, d.excess_kurtosis, d.sd), (Some(0.0), Some(-2.0), Some(2f64.sqrt())));
    assert_eq!(d.histogram.unwrap().counts.iter().sum::<u64>(), 2);
}

#[test]
fn units_are_those_of_the_record() {
    let values: Vec<f64> = normal(500).iter().map(|z| 5e-9 + 1e-9 * z).collect();
    let nano = OutputDistribution::from_values(&values, &Unit::parse("nN").unwrap()).unwrap();
    assert!((nano.mean - 5.0).abs() < 1e-12 && (nano.sd.unwrap() - 1.0).abs() < 0.01);
    assert_eq!(serde_json::to_value(&nano.unit).unwrap(), "nN");
}

#[test]
fn bins_are_as_wide_as_the_rule_says() {
    let d = distribution(&ideal(2000, |p| 3.0 + 2.0 * p));
    let histogram = d.histogram.unwrap();
    // IQR 1: 2 x 2000^(-1/3) = 0.159 wide.
    assert_eq!((histogram.counts.len(), histogram.below, histogram.above), (13, 0, 0));
}

#[test]
fn heavy_tails_leave_the_middle_visible() {
    let cauchy = ideal(10_001, |p| libm::tan(std::f64::consts::PI * (p - 0.5)));
    let d = distribution(&cauchy);
    let histogram = d.histogram.unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>() + histogram.below + histogram.above, 10_001);
    // Quartiles at -1 and 1, the reach 12 beyond them.
    assert!((histogram.edges[0] + 13.0).abs() < 0.01);
    assert!(histogram.counts.len() > 50 && histogram.below > 200);
}

#[test]
fn degenerate_samples_are_results() {
    let unit = Unit::dimensionless();
    assert_eq!(OutputDistribution::from_values(&[], &unit), None);
    assert_eq!(OutputDistribution::from_values(&[1.0, f64::INFINITY], &unit), None);
    for value in [0.0, 0.1, 1e300, -1e-300, 5e-324] {
        for n in [1, 2, 50] {
            let d = distribution(&vec![value; n]);
            assert_eq!((d.mean, d.min, d.max, d.quantile(97.5)), (value, value, value, Some(value)));
            assert_eq!(d.sd, (n > 1).then_some(0.0));
            assert_eq!((d.skewness, d.histogram), (None, None));
        }
    }
    // More than half of the values equal: no interquartile range.
    let mut values = vec![0.0; 60];
    values.extend(normal(40));
    let d = distribution(&values);
    assert_eq!(d.histogram.unwrap().counts.iter().sum::<u64>(), 100);
}

proptest! {
    #[test]
    fn any_finite_sample_has_a_distribution(values in prop::collection::vec(prop::num::f64::ANY, 1..60)) {
        let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).chain([1.0]).collect();
        let d = distribution(&values);
        prop_assert!(d.min <= d.mean && d.mean <= d.max && d.sd.is_none_or(|sd| sd >= 0.0), "{d:?}");
        if let Some(h) = &d.histogram {
            prop_assert_eq!(h.counts.iter().sum::<u64>() + h.below + h.above, values.len() as u64);
            prop_assert!(h.edges.windows(2).all(|e| e[0] < e[1]));
        }
        let text = serde_json::to_string(&d).unwrap();
        prop_assert_eq!(serde_json::from_str::<OutputDistribution>(&text).unwrap(), d);
    }

    #[test]
    fn scale_changes_the_unit_only(values in prop::collection::vec(-1.0..1.0f64, 5..60), exponent in -900..900i32) {
        let scale = 2f64.powi(exponent);
        let (a, b) = (distribution(&values), distribution(&values.iter().map(|v| v * scale).collect::<Vec<_>>()));
        prop_assert_eq!(a.skewness, b.skewness);
        prop_assert_eq!(a.mean * scale, b.mean);
        prop_assert_eq!(a.histogram.map(|h| h.counts), b.histogram.map(|h| h.counts));
    }
}
