//! Estimates with their errors.

use apportion::uncertainty::{Estimate, Interval};
use apportion_report::format::{give_or_take, index, is_above_zero, percent, share, two_digits};
use proptest::prelude::*;

fn record(low: f64, estimate: f64, high: f64) -> Estimate {
    Estimate { estimate, interval: Some(Interval { low, high }) }
}

fn about(estimate: f64, half: f64) -> String {
    give_or_take(record(estimate - half, estimate, estimate + half))
}

#[test]
fn estimates_have_the_digits_that_their_errors_bear() {
    let cases = [
        (0.024_868, 0.000_03, "0.02487 ± 0.00003"),
        (0.5, 0.02, "0.50 ± 0.02"),
        (0.5, 0.123, "0.50 ± 0.12"),
        (0.5, 0.097, "0.50 ± 0.10"),
        (5e-5, 9e-5, "0.00005 ± 0.00009"),
        (1.5572e-5, 5e-8, "(1.557 ± 0.005)e-5"),
        (-1.234e12, 3e9, "(-1.234 ± 0.003)e12"),
        (0.000_05, 0.3, "0 ± 0.3"),
        (-0.041_2, 0.005, "-0.041 ± 0.005"),
        (3.506e-7, 2e-9, "(3.51 ± 0.02)e-7"),
        (0.975_501_2, 4.1e-8, "0.975501 ± 0.000001"),
        (1.000_500_166_9, 1e-12, "1.00050 ± 0.00001"),
        (1344.08, 23.0, "1340 ± 20"),
        (0.0, 3e-7, "0 ± 3e-7"),
        (1.0, 1e-12, "1"),
    ];
    for (estimate, half, text) in cases {
        assert_eq!(about(estimate, half), text);
    }
}

#[test]
fn asymmetric_intervals_are_shown_by_their_bounds() {
    assert_eq!(give_or_take(record(0.5217, 0.6789, 1.0301)), "0.68 [0.52, 1.03]");
    assert_eq!(give_or_take(record(0.4, 0.5, 0.52)), "0.50 [0.40, 0.52]");
    assert_eq!(give_or_take(record(0.3282, 0.328_45, 0.3287)), "0.3285 ± 0.0003");
    assert_eq!(give_or_take(record(0.0, 0.0, 1.0)), "0 [0, 1.00]");
    assert_eq!(give_or_take(record(0.8e-5, 1.2e-5, 3e-5)), "(1.2 [0.8, 3.0])e-5");
    assert_eq!(give_or_take(record(0.4886, 0.4889, 0.4893)), "0.4889 ± 0.0004");
    assert_eq!(give_or_take(record(0.9755011, 0.97550118, 0.9755012)), "0.975501 ± 0.000001");
    assert_eq!(index(record(-0.03, -0.01, 0.05)), "−0.010 [−0.030, 0.050]");
    let cases = [record(1e-19, 0.998, 1.0), record(0.001, 0.5, 1.0), record(-0.1, 0.3, 0.7)];
    assert_eq!(cases.map(is_above_zero), [false; 3]);
    assert_eq!([record(0.2, 0.3, 0.4), record(0.3, 0.3, 0.3), record(0.2, 0.3, 0.7)].map(is_above_zero), [true; 3]);
}

#[test]
fn exact_numbers_and_those_without_an_error() {
    assert_eq!(give_or_take(record(0.0, 0.0, 0.0)), "0");
    assert_eq!(give_or_take(record(1.0, 1.0, 1.0)), "1");
    assert_eq!(give_or_take(Estimate::alone(0.5)), "0.5");
    assert_eq!(give_or_take(Estimate::alone(2.345_678e-7)), "2.35e-7");
    assert_eq!(give_or_take(record(f64::NAN, f64::NAN, f64::NAN)), "NaN");
}

#[test]
fn parts_and_shares_in_percent() {
    assert_eq!(percent(record(0.389, 0.392, 0.395)), "39.2 ± 0.3 %");
    assert_eq!(percent(Estimate::alone(0.5)), "50 %");
    assert_eq!(percent(record(0.25, 0.52, 1.18)), "52 [25, 100] %");
    let of = |estimate, low, high| share(Some(record(low, estimate, high)));
    assert_eq!((of(97.61, 97.6, 97.62), share(None)), ("97.610 ± 0.010".to_owned(), "-".to_owned()));
    assert_eq!(of(100.0, 99.95, 100.05), "100.000 [99.950, 100.000]");
    assert_eq!(
        (of(100.0, 100.0 - 1e-10, 100.0 + 1e-10), of(99.0, 98.0, 101.0)),
        ("100".to_owned(), "99.0 [98.0, 100.0]".to_owned())
    );
    assert_eq!(of(100.000_01, 99.95, 100.05), "100.000 [99.950, 100.000]");
    assert_eq!(
        (of(1.158_45e-12, 1.158_43e-12, 1.158_47e-12), of(1e-12, -0.1, 0.1)),
        ("0".to_owned(), "0 ± 0.10".to_owned())
    );
    assert_eq!(
        (percent(record(0.9995, 1.0, 1.0005)), percent(record(1e-15, 1e-14, 2e-14))),
        ("100.000 [99.950, 100.000] %".to_owned(), "0 %".to_owned())
    );
    let widths = [0.0, 0.0351, 8.3e-5, 4.96e-5, 8.32e-7, 2e-8, 12.4].map(two_digits);
    assert_eq!(widths, ["0", "0.035", "0.000083", "0.00005", "8.3e-7", "2e-8", "12"]);
}

proptest! {
    /// The text is within half of the last place of the value, and never shows a place beyond the error.
    #[test]
    fn rounded_numbers_are_within_their_error(estimate in -10.0..10.0, power in -9.0..0.5_f64) {
        let half = libm::pow(10.0, power);
        let text = about(estimate, half);
        let (value, error) = text.split_once(" ± ").expect("symmetric");
        let power = error.split_once('e').map_or("0", |(_, power)| power);
        let digits = |text: &str| text.split('e').next().unwrap().trim_matches(['(', ')']).to_owned();
        let number = |text: &str| format!("{}e{power}", digits(text)).parse::<f64>().unwrap();
        let (value, error) = (number(value), number(error));
        prop_assert!((value - estimate).abs() <= 1.34 * error, "{}", text);
        prop_assert!(error > 0.66 * half && error < 1.34 * half + 1.5e-5, "{} of {}", text, half);
    }
}
