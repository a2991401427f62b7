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

/// A probability; `-` if it is unknown. 0 and 1 stand for certainty, not for what rounds to them.
pub(super) fn chance(probability: Option<f64>) -> String {
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
        assert_eq!(fixed(-0.00001, 4), "0.0000");
        assert_eq!(fixed(-0.5, 1), "-0.5");
        let chances = [None, Some(0.0), Some(1e-5), Some(0.25), Some(0.9999), Some(1.0)].map(chance);
        assert_eq!(chances, ["-", "0", "<0.001", "0.250", ">0.999", "1"]);
    }
}
