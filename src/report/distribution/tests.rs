//! Moments, histogram and density of samples with known answers.

use proptest::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

use super::*;
use crate::report::chart::png;

fn of(values: &[f64]) -> OutputDistribution {
    OutputDistribution::of(values, &Unit::dimensionless()).unwrap()
}

/// The middles of n slices of equal probability of a distribution.
fn ideal(n: usize, inverse: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..n).map(|k| inverse((k as f64 + 0.5) / n as f64)).collect()
}

fn normal(n: usize) -> Vec<f64> {
    ideal(n, |p| Normal::standard().inverse_cdf(p))
}

/// Integral of the density, by trapezoids.
fn mass(density: &Density) -> f64 {
    let step = density.x[1] - density.x[0];
    let ends = (density.density[0] + density.density[density.density.len() - 1]) / 2.0;
    step * (density.density.iter().sum::<f64>() - ends)
}

#[test]
fn small_samples_by_hand() {
    let d = of(&[1.0, 2.0, 4.0, 9.0]);
    assert_eq!((d.count, d.mean, d.min, d.max), (4, 4.0, 1.0, 9.0));
    // Deviations -3, -2, 0, 5: squares 38, cubes 90, fourth powers 722.
    assert!((d.sd.unwrap() - (38.0f64 / 3.0).sqrt()).abs() < 1e-14);
    assert!((d.skewness.unwrap() - 22.5 / libm::pow(9.5f64, 1.5)).abs() < 1e-14);
    assert!((d.excess_kurtosis.unwrap() - (180.5 / 90.25 - 3.0)).abs() < 1e-14);
    assert_eq!(d.quantile(50.0), Some(3.0));
    let d = of(&[-1.0, 1.0]);
    assert_eq!((d.skewness, d.excess_kurtosis, d.sd), (Some(0.0), Some(-2.0), Some(2f64.sqrt())));
    assert_eq!(d.histogram.unwrap().counts.iter().sum::<u64>(), 2);
}

#[test]
fn units_are_those_of_the_record() {
    let values: Vec<f64> = normal(500).iter().map(|z| 5e-9 + 1e-9 * z).collect();
    let nano = OutputDistribution::of(&values, &Unit::parse("nN").unwrap()).unwrap();
    assert!((nano.mean - 5.0).abs() < 1e-12 && (nano.sd.unwrap() - 1.0).abs() < 0.01);
    let density = nano.density.unwrap();
    // The density at the mean of a normal distribution of standard deviation 1 nN, smoothed by the kernel.
    let peak = density.density.iter().copied().fold(0.0, f64::max);
    assert!((peak - 0.3989 / (1.0 + density.bandwidth.powi(2)).sqrt()).abs() < 0.005, "{peak}");
    assert_eq!(serde_json::to_value(&nano.unit).unwrap(), "nN");
}

#[test]
fn the_bandwidth_is_that_of_sums_over_all_pairs() {
    // The rule with plain sums over all pairs, in NumPy: no cells.
    for (n, plain) in [(100, 0.47297577823), (1000, 0.28204998013), (5000, 0.19995011301)] {
        let density = of(&normal(n)).density.unwrap();
        assert_eq!(density.rule, BandwidthRule::SheatherJones);
        // Cells are 1/40 of the bandwidth and less.
        assert!((density.bandwidth / plain - 1.0).abs() < 1e-4, "{n}: {} {plain}", density.bandwidth);
        // The best for normal data is 1.0592 sd n^(-1/5); on such smooth samples the rule is somewhat above.
        assert!((1.0..1.13).contains(&(density.bandwidth / (1.0592 * libm::pow(n as f64, -0.2)))));
        // What the kernels spread beyond is reflected; trapezoids on 256 steps are exact to 1e-4.
        assert!((mass(&density) - 1.0).abs() < 1e-3, "{}", mass(&density));
    }
}

#[test]
fn bounds_do_not_sag() {
    let d = of(&ideal(2000, |p| 3.0 + 2.0 * p));
    let density = d.density.unwrap();
    // A uniform density is 1/2 everywhere, also at its ends.
    assert!(density.density.iter().all(|f| (f - 0.5).abs() < 0.02), "{:?}", density.density);
    let histogram = d.histogram.unwrap();
    // IQR 1: 2 x 2000^(-1/3) = 0.159 wide.
    assert_eq!((histogram.counts.len(), histogram.below, histogram.above), (13, 0, 0));
}

#[test]
fn two_modes_stay_two() {
    let mut values = normal(1000);
    values.extend(normal(1000).iter().map(|z| 12.0 + z));
    let density = of(&values).density.unwrap().density;
    let middle = density[density.len() / 2];
    let peak = density.iter().copied().fold(0.0, f64::max);
    // Silverman's rule, which takes both modes for one, would leave 40 % of the peak between them.
    assert!(middle < 0.01 * peak && peak > 0.18, "{middle} {peak}");
}

#[test]
fn heavy_tails_leave_the_middle_visible() {
    let cauchy = ideal(10_001, |p| libm::tan(std::f64::consts::PI * (p - 0.5)));
    let d = of(&cauchy);
    let histogram = d.histogram.unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>() + histogram.below + histogram.above, 10_001);
    // Quartiles at -1 and 1, the reach 12 beyond them.
    assert!((histogram.edges[0] + 13.0).abs() < 0.01);
    assert!(histogram.counts.len() > 50 && histogram.below > 200);
    let density = d.density.unwrap();
    let peak = density.density.iter().copied().fold(0.0, f64::max);
    // 1/pi, lowered by the kernel.
    assert!((0.27..0.32).contains(&peak), "{peak}");
    assert!((mass(&density) - 0.951).abs() < 0.005, "{}", mass(&density));
}

#[test]
fn degenerate_samples_are_results() {
    let unit = Unit::dimensionless();
    assert_eq!(OutputDistribution::of(&[], &unit), Err(DistributionError::NoValues));
    let error = OutputDistribution::of(&[1.0, f64::INFINITY], &unit).unwrap_err();
    assert_eq!(error, DistributionError::NotFinite { number: 2 });
    for value in [0.0, 0.1, 1e300, -1e-300, 5e-324] {
        for n in [1, 2, 50] {
            let d = of(&vec![value; n]);
            assert_eq!((d.mean, d.min, d.max, d.quantile(97.5)), (value, value, value, Some(value)));
            assert_eq!(d.sd, (n > 1).then_some(0.0));
            assert_eq!((d.skewness, d.histogram, d.density), (None, None, None));
        }
    }
    // More than half of the values equal: no interquartile range.
    let mut values = vec![0.0; 60];
    values.extend(normal(40));
    let d = of(&values);
    assert_eq!(d.density.unwrap().rule, BandwidthRule::Silverman);
    assert_eq!(d.histogram.unwrap().counts.iter().sum::<u64>(), 100);
}

#[test]
fn charts_draw_every_kind_of_sample() {
    let cases = [normal(500), vec![1e300, -1e300, 3e299], vec![2e-300, 1e-300], vec![0.0; 9], vec![7.0]];
    for values in cases {
        let svg = density_chart(&of(&values), "Distribution", "force").svg().unwrap();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(png(&svg).is_ok());
    }
    let svg = density_chart(&of(&normal(500)), "Distribution", "force").svg().unwrap();
    for text in ["2.5 % \u{2212}1.9", "median", "mean", "97.5 % 1.9", "95 % of the 500 values of force lie between"] {
        assert!(svg.contains(text), "{text}");
    }
}

proptest! {
    #[test]
    fn any_finite_sample_has_a_distribution(values in prop::collection::vec(prop::num::f64::ANY, 1..60)) {
        let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).chain([1.0]).collect();
        let d = of(&values);
        prop_assert!(d.min <= d.mean && d.mean <= d.max && d.sd.is_none_or(|sd| sd >= 0.0), "{d:?}");
        if let Some(h) = &d.histogram {
            prop_assert_eq!(h.counts.iter().sum::<u64>() + h.below + h.above, values.len() as u64);
            prop_assert!(h.edges.windows(2).all(|e| e[0] < e[1]));
        }
        if let Some(density) = &d.density {
            prop_assert!(density.density.iter().all(|f| f.is_finite() && *f >= 0.0));
        }
        let text = serde_json::to_string(&d).unwrap();
        prop_assert_eq!(serde_json::from_str::<OutputDistribution>(&text).unwrap(), d);
    }

    #[test]
    fn scale_changes_the_unit_only(values in prop::collection::vec(-1.0..1.0f64, 5..60), exponent in -900..900i32) {
        let scale = 2f64.powi(exponent);
        let (a, b) = (of(&values), of(&values.iter().map(|v| v * scale).collect::<Vec<_>>()));
        prop_assert_eq!(a.skewness, b.skewness);
        prop_assert_eq!(a.mean * scale, b.mean);
        prop_assert_eq!(a.histogram.map(|h| h.counts), b.histogram.map(|h| h.counts));
    }
}
