//! Names and numbers in the sentences of the page.

use crate::report::result::{EstimateRecord, IntervalRecord};
pub(super) use crate::report::two_digits as half_width;
use crate::report::{capitalised, fixed};

/// A name of the study as words; a symbol such as `F_cr` stays one.
pub(super) fn name(name: &str) -> String {
    if is_symbol(name) { name.to_owned() } else { name.replace('_', " ") }
}

/// A name after an article, which symbols go without.
pub(super) fn the(text: &str) -> String {
    if is_symbol(text) { text.to_owned() } else { format!("the {}", name(text)) }
}

/// A name at the beginning of a sentence.
pub(super) fn first(text: &str) -> String {
    if is_symbol(text) { text.to_owned() } else { capitalised(&name(text)) }
}

fn is_symbol(name: &str) -> bool {
    name.chars().count() <= 3 || name.chars().nth(1) == Some('_')
}

/// `one run`, `2 runs`, `655 360 runs`.
pub(super) fn count(number: u64, one: &str, many: &str) -> String {
    if number == 1 { format!("one {one}") } else { format!("{} {many}", grouped(number)) }
}

/// A whole number with its digits in threes.
pub(super) fn grouped(number: u64) -> String {
    const NARROW_SPACE: char = '\u{202f}';
    let digits = number.to_string();
    if digits.len() <= 4 {
        return digits;
    }
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(NARROW_SPACE);
        }
        text.push(digit);
    }
    text
}

/// Decimals that a number with this half width deserves.
fn decimals(half_width: f64) -> usize {
    if half_width > 0.0 { (-half_width.log10()).ceil().clamp(2.0, 7.0) as usize } else { 3 }
}

/// `0.678 (0.676 to 0.680)`, with as many decimals as the interval deserves; the estimate alone without an interval.
pub(super) fn index(record: EstimateRecord) -> String {
    let (Some(low), Some(high)) = (record.low, record.high) else { return minus(fixed(record.estimate, 3)) };
    let digits = decimals((high - low) / 2.0);
    minus(format!("{} ({} to {})", fixed(record.estimate, digits), fixed(low, digits), fixed(high, digits)))
}

/// A share of 1 in percent with its bounds: `39.2 % (38.9 to 39.5 %)`.
pub(super) fn percent(record: EstimateRecord) -> String {
    let percent = |share: f64, digits| fixed(100.0 * share, digits);
    let (Some(low), Some(high)) = (record.low, record.high) else {
        return format!("{} %", percent(record.estimate, 1));
    };
    let digits = decimals((high - low) / 2.0).saturating_sub(2).min(3);
    minus(format!("{} % ({} to {} %)", percent(record.estimate, digits), percent(low, digits), percent(high, digits)))
}

/// A share in percent with its interval, for a table: `47.0 [46.8, 47.2]`.
pub(super) fn share(share: Option<f64>, interval: Option<IntervalRecord>) -> String {
    crate::report::share(share, interval)
}

/// A value with four significant digits and its unit.
pub(super) fn value(value: f64, unit: &str) -> String {
    minus(crate::report::asked::short_with_unit(value, unit))
}

/// An index and the half width of its interval for a table, with four decimals: the files have all digits.
pub(super) fn give_or_take(record: EstimateRecord) -> String {
    const DIGITS: usize = 4;
    const LEAST: f64 = 1e-4;
    let bounds = [record.estimate, record.low.unwrap_or(record.estimate), record.high.unwrap_or(record.estimate)];
    if bounds.iter().all(|bound| *bound == 0.0) {
        return "0".to_owned();
    }
    if bounds.iter().all(|bound| bound.abs() < LEAST) {
        return if bounds.iter().all(|bound| *bound > 0.0) { "< 0.0001" } else { "0 ± < 0.0001" }.to_owned();
    }
    let estimate = fixed(record.estimate, DIGITS);
    let (Some(low), Some(high)) = (record.low, record.high) else { return estimate };
    let width = (high - low) / 2.0;
    if (low + high - 2.0 * record.estimate).abs() > 0.01 * (high - low) {
        format!("{estimate} [{}, {}]", fixed(low, DIGITS), fixed(high, DIGITS))
    } else if width < LEAST / 2.0 {
        format!("{estimate} ± < 0.0001")
    } else {
        format!("{estimate} ± {}", fixed(width, DIGITS))
    }
}

/// Hyphens before digits as minus signs, for numbers in sentences.
fn minus(text: String) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut before = ' ';
    for c in text.chars() {
        plain.push(if c == '-' && !before.is_alphanumeric() { '−' } else { c });
        before = c;
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(low: f64, estimate: f64, high: f64) -> EstimateRecord {
        EstimateRecord { estimate, low: Some(low), high: Some(high) }
    }

    #[test]
    fn names_and_numbers_read_well() {
        assert_eq!((name("critical_force"), name("F_cr")), ("critical force".to_owned(), "F_cr".to_owned()));
        assert_eq!((the("critical_force"), the("y")), ("the critical force".to_owned(), "y".to_owned()));
        assert_eq!((first("thickness"), first("x1")), ("Thickness".to_owned(), "x1".to_owned()));
        assert_eq!(grouped(655_360), "655\u{202f}360");
        assert_eq!((grouped(1024), grouped(1_048_576)), ("1024".to_owned(), "1\u{202f}048\u{202f}576".to_owned()));
        assert_eq!((count(1, "run", "runs"), count(2, "run", "runs")), ("one run".to_owned(), "2 runs".to_owned()));
        assert_eq!(index(estimate(0.6755, 0.6778, 0.6801)), "0.678 (0.675 to 0.680)");
        assert_eq!(index(estimate(-0.02, 0.0, 0.02)), "0.00 (−0.02 to 0.02)");
        assert_eq!(percent(estimate(0.3890, 0.3920, 0.3950)), "39.2 % (38.9 to 39.5 %)");
        assert_eq!(percent(EstimateRecord { estimate: 0.5, low: None, high: None }), "50.0 %");
        assert_eq!(give_or_take(estimate(0.0, 0.0, 0.0)), "0");
        assert_eq!(give_or_take(estimate(1e-6, 2e-6, 3e-6)), "< 0.0001");
        assert_eq!(give_or_take(estimate(-2e-5, 1e-5, 4e-5)), "0 ± < 0.0001");
        assert_eq!(give_or_take(estimate(0.012_34, 0.012_35, 0.012_36)), "0.0123 ± < 0.0001");
        assert_eq!(give_or_take(estimate(0.48, 0.5, 0.52)), "0.5000 ± 0.0200");
        assert_eq!(give_or_take(estimate(-4e-5, 5e-5, 14e-5)), "0.0001 ± 0.0001");
        assert_eq!(give_or_take(estimate(0.4, 0.5, 0.52)), "0.5000 [0.4000, 0.5200]");
        assert_eq!(half_width(0.012_345), "0.012");
    }
}
