//! Estimates with their errors, with as many digits as the error justifies: for all sentences, tables and captions.

use apportion::uncertainty::{Estimate, Interval};

use super::{SIGNIFICANT, minus, significant, significant_to};

/// Ratio of the longer to the shorter side up to which an interval is printed by the longer one.
const EVEN: f64 = 1.5;
/// Part of the estimate below which both ends of an interval are not needed.
const MIN_SHOWN: f64 = 0.01;
/// Part of the estimate up to which an error is that of rounding.
const ROUNDING: f64 = 1e-11;
/// Significant digits of an estimate whose error is unknown.
const WITHOUT_ERROR: usize = 3;
/// Magnitude below which numbers are written with a power of ten.
pub(super) const SMALL: f64 = 1e-5;

/// Formats an estimate and the half width of its interval, `0.02487 ± 0.00003`, or both bounds if they are not
/// symmetric about it to within half and longer than 1 % of it, `0.68 [0.52, 1.03]`. Very small and very large ones
/// share a power of ten: `(1.557 ± 0.005)e-5`.
///
/// The half width (the longer one if the two differ) has one digit, two if it begins with 1, and the estimate ends at
/// the same place, after six digits at the latest; the rounding is included in the error. Bounds have the digits of the
/// nearer
pub fn give_or_take(record: Estimate) -> String {
    let Estimate { estimate, interval: Some(Interval { low, high }) } = record else {
        return rounded(record.estimate, WITHOUT_ERROR);
    };
    let half = (high - low) / 2.0;
    // An error of rounding is none of a number that six digits hold.
    let cut = significant(estimate).parse().map_or(0.0, |shown: f64| (shown - estimate).abs());
    if !(half.max(cut) > ROUNDING * estimate.abs() && half > 0.0 && half.is_finite() && estimate.is_finite()) {
        return significant(estimate);
    }
    let (nearer, farther) = (f64::min(estimate - low, high - estimate), f64::max(estimate - low, high - estimate));
    if nearer * EVEN < farther && half >= MIN_SHOWN * estimate.abs() {
        return with_bounds(estimate, low, high, most_decimals(estimate));
    }
    let places = decimals(farther).min(most_decimals(estimate));
    let unit = libm::pow(10.0, f64::from(-places));
    let error = if places < decimals(farther) { unit * (farther / unit + 0.5).ceil() } else { farther };
    with_power(estimate, error, |power| format!("{} ± {}", at(estimate, places, power), at(error, places, power)))
}

/// Formats an estimate and both its bounds, with so many decimals at most.
fn with_bounds(estimate: f64, low: f64, high: f64, most: i32) -> String {
    // A bound next to the estimate does not justify many digits.
    let nearer = f64::min(estimate - low, high - estimate).max((high - low) / 4.0);
    let digits = if format!("{nearer:.1e}").starts_with(['1', '2']) { 2 } else { 1 };
    let places = decimals_of(nearer, digits).min(most);
    let at = |number, power| at(number, places, power);
    with_power(estimate, nearer, |power| format!("{} [{}, {}]", at(estimate, power), at(low, power), at(high, power)))
}

/// Formats an estimate with its error by `text`, which gets the power of ten that both share.
fn with_power(estimate: f64, error: f64, text: impl Fn(i32) -> String) -> String {
    let power = exponent(if estimate == 0.0 { error } else { f64::max(estimate.abs(), error) });
    if power <= SIGNIFICANT as i32 + 2 && (power >= -2 || error >= SMALL) {
        return text(0);
    }
    let text = text(power);
    if text.starts_with("0 ±") { format!("{text}e{power}") } else { format!("({text})e{power}") }
}

/// Returns the half width that [`give_or_take`] prints; `None` if it prints none.
pub fn printed_half_width(record: Estimate) -> Option<f64> {
    give_or_take(record).split_once(" ± ")?.1.replace(')', "").parse().ok()
}

/// Returns whether an interval excludes 0 from below, also as printed.
pub fn is_above_zero(record: Estimate) -> bool {
    let printed = give_or_take(record);
    let number = |text: &str| text.trim_start_matches('(').split(')').next()?.parse::<f64>().ok();
    let is_left_out = match printed.split_once(" ± ") {
        Some((estimate, half)) => number(estimate) > number(half),
        None => !printed.contains("[0, "),
    };
    record.interval.is_some_and(|interval| interval.low > 0.0) && is_left_out
}

/// Formats like [`give_or_take`], for sentences, with true minus signs.
pub fn index(record: Estimate) -> String {
    minus(&give_or_take(record))
}

/// Returns the number of meaningful decimals of an estimate.
fn most_decimals(estimate: f64) -> i32 {
    match estimate {
        0.0 => i32::MAX,
        estimate => SIGNIFICANT as i32 - 1 - exponent(estimate),
    }
}

/// Formats a part of 1 in percent with its error: `39.96 ± 0.03 %`. The bounds of a part within 0 and 1 are cut there.
pub fn percent(record: Estimate) -> String {
    let percent = |part: f64| 100.0 * part;
    let Estimate { estimate, interval } = record;
    let is_inside = (0.0..=1.0).contains(&estimate);
    let bound = |bound: f64| if is_inside { percent(bound).max(0.0) } else { percent(bound) };
    let interval = interval.map(|Interval { low, high }| Interval { low: bound(low), high: bound(high) });
    format!("{} %", minus(&up_to_all(Estimate { estimate: percent(estimate), interval })))
}

/// Formats a share in percent with its error, `-` for `None`.
pub fn share(share: Option<Estimate>) -> String {
    share.map_or_else(|| "-".to_owned(), up_to_all)
}

/// Limits a record to 100 %: an interval beyond it ends there, and a rounding remainder is 0.
fn up_to_all(record: Estimate) -> String {
    const ALL: f64 = 100.0;
    const ROUNDING: f64 = 1e-9;
    let Estimate { estimate, interval: Some(Interval { low, high }) } = record else { return give_or_take(record) };
    if [estimate, low, high].iter().all(|part| part.abs() < ROUNDING) {
        return "0".to_owned();
    }
    if !(low < ALL && high > ALL) {
        return give_or_take(record);
    }
    let words = with_bounds(estimate.min(ALL), low, ALL, most_decimals(estimate));
    // To six digits it is all.
    match words.split_once(" [") {
        Some((all, bounds)) if bounds == format!("{all}, {all}]") => significant(ALL),
        _ => words,
    }
}

/// Formats an error or width by itself, with two significant digits: 0.000083, or 8.3e-7 if it is smaller.
pub fn two_digits(value: f64) -> String {
    rounded(value, 2)
}

/// Formats `value` with so many significant digits, without trailing zeros.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    let shown = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    significant_to(shown, digits.max(SIGNIFICANT))
}

/// Returns the number of decimal places of a number with this error, which may be negative.
fn decimals(error: f64) -> i32 {
    decimals_of(error, if format!("{error:.1e}").starts_with('1') { 2 } else { 1 })
}

/// Returns the number of decimal places of a number with so many digits of its error.
fn decimals_of(error: f64, digits: i32) -> i32 {
    digits - 1 - exponent(format!("{error:.1e}").parse().unwrap_or(error))
}

pub(super) fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Formats `value`, with so many decimal places, in units of a power of ten; a zero is `0`.
fn at(value: f64, decimals: i32, power: i32) -> String {
    let (value, decimals) = (value * libm::pow(10.0, f64::from(-power)), decimals + power);
    if decimals < 0 {
        let unit = libm::pow(10.0, f64::from(-decimals));
        return significant((value / unit).round() * unit);
    }
    let text = format!("{value:.*}", decimals as usize);
    if text.chars().all(|c| matches!(c, '-' | '0' | '.')) { "0".to_owned() } else { text }
}
