//! Numbers as people read them.

use crate::report::result::{EstimateRecord, IntervalRecord};

/// A value with its unit, if it has one.
pub fn with_unit(value: f64, unit: &str) -> String {
    let value = significant(value);
    if matches!(unit, "" | "1") { value } else { format!("{value} {unit}") }
}

/// A share of the runs that is not zero, in percent.
pub fn share_of_runs(share: f64) -> String {
    if share < 0.001 { "less than 0.1 %".to_owned() } else { format!("{:.1} %", 100.0 * share) }
}

/// `0.3374 [0.3350, 0.3398]`, or the estimate alone where there is no interval.
pub fn estimate(record: EstimateRecord, digits: usize) -> String {
    match (record.low, record.high) {
        (Some(low), Some(high)) => {
            format!("{} [{}, {}]", fixed(record.estimate, digits), fixed(low, digits), fixed(high, digits))
        }
        _ => fixed(record.estimate, digits),
    }
}

/// `0.3374 ± 0.0024`, the estimate and half of its interval, with four decimals or as many as the half width needs; both
/// bounds where they are not symmetric about the estimate, the estimate alone where there is no interval.
pub(in crate::report) fn give_or_take(record: EstimateRecord) -> String {
    const FEWEST: usize = 4;
    const MOST: f64 = 7.0;
    let (Some(low), Some(high)) = (record.low, record.high) else { return fixed(record.estimate, FEWEST) };
    let half_width = (high - low) / 2.0;
    let needed = if half_width > 0.0 { (-half_width.log10()).ceil().clamp(0.0, MOST) as usize } else { 0 };
    let digits = needed.max(FEWEST);
    match symmetric(record.estimate, (low, high)) {
        true => format!("{} ± {}", fixed(record.estimate, digits), fixed(half_width, digits)),
        false => estimate(record, digits),
    }
}

/// Whether an interval reaches as far up as down, to what is printed.
fn symmetric(estimate: f64, (low, high): (f64, f64)) -> bool {
    (low + high - 2.0 * estimate).abs() <= 0.01 * (high - low)
}

/// A share in percent and half of its interval, as [`give_or_take`].
pub(super) fn share_give_or_take(percent: Option<f64>, interval: Option<IntervalRecord>) -> String {
    match (percent, interval) {
        (Some(percent), Some(IntervalRecord { low, high })) if symmetric(percent, (low, high)) => {
            format!("{} ± {}", fixed(percent, 1), fixed((high - low) / 2.0, 1))
        }
        _ => share(percent, interval),
    }
}

/// A share in percent with its interval, `-` if it does not exist.
pub fn share(share: Option<f64>, interval: Option<IntervalRecord>) -> String {
    match (share, interval) {
        (None, _) => "-".to_owned(),
        (Some(share), None) => fixed(share, 1),
        (Some(share), Some(i)) => format!("{} [{}, {}]", fixed(share, 1), fixed(i.low, 1), fixed(i.high, 1)),
    }
}

/// `value` with `digits` decimals, where a zero has no sign.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// `value` with two significant digits, as errors and widths have them: 0.000083, or 8.3e-7 where there would be more zeros.
pub fn two_digits(value: f64) -> String {
    const LEAST: f64 = 1e-6;
    let rounded = format!("{value:.1e}").parse().unwrap_or(value);
    if value != 0.0 && value.abs() < LEAST {
        return format!("{value:.1e}").replace(".0e", "e");
    }
    match significant(rounded) {
        text if text.contains('e') && rounded.abs() < 1.0 => {
            let decimals = 1 - rounded.abs().log10().floor() as i32;
            let text = format!("{rounded:.*}", decimals.max(0) as usize);
            text.trim_end_matches('0').to_owned()
        }
        text => text,
    }
}

/// `value` with six significant digits, in exponent form where that is shorter.
pub fn significant(value: f64) -> String {
    const DIGITS: i32 = 6;
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=DIGITS + 2).contains(&exponent) {
        return format!("{value:.*e}", DIGITS as usize - 1);
    }
    let text = format!("{value:.*}", (DIGITS - 1 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A probability; `-` if it is unknown. Only what is 0 or 1 is shown as such, not what rounds to it.
pub(in crate::report) fn chance(probability: Option<f64>) -> String {
    match probability {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(1.0) => "1".to_owned(),
        Some(p) if p < 0.001 => "<0.001".to_owned(),
        Some(p) if p > 0.999 => ">0.999".to_owned(),
        Some(p) => fixed(p, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(significant(489.404_123), "489.404");
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(1.5e-9), "1.50000e-9");
        assert_eq!(significant(-12_345_678.0), "-12345678");
        assert_eq!(significant(100.0), "100");
        assert_eq!(significant(0.001), "0.001");
        let widths = [0.0, 0.0351, 8.3e-5, 4.96e-5, 8.32e-7, 2e-8, 12.4].map(two_digits);
        assert_eq!(widths, ["0", "0.035", "0.000083", "0.00005", "8.3e-7", "2e-8", "12"]);
        assert_eq!(fixed(-0.00001, 4), "0.0000");
        assert_eq!(fixed(-0.5, 1), "-0.5");
        let record = |low, estimate, high| EstimateRecord { estimate, low: Some(low), high: Some(high) };
        assert_eq!(give_or_take(record(0.48, 0.5, 0.52)), "0.5000 ± 0.0200");
        assert_eq!(give_or_take(record(0.5e-4, 0.6e-4, 0.7e-4)), "0.00006 ± 0.00001");
        assert_eq!(give_or_take(record(0.4, 0.5, 0.52)), "0.5000 [0.4000, 0.5200]");
        assert_eq!(give_or_take(record(0.0, 0.0, 0.0)), "0.0000 ± 0.0000");
        assert_eq!(give_or_take(EstimateRecord { estimate: 0.5, low: None, high: None }), "0.5000");
        let chances = [None, Some(0.0), Some(1e-5), Some(0.25), Some(0.9999), Some(1.0)].map(chance);
        assert_eq!(chances, ["-", "0", "<0.001", "0.250", ">0.999", "1"]);
    }
}
