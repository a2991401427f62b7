//! Numbers and names as people read them.

mod estimates;
mod units;

use apportion::uncertainty::Estimate;
use apportion_base::text::symbol;
pub use estimates::{PrintedEstimate, give_or_take, index, is_above_zero, percent, share};
pub use units::unit;

/// Formats a value with its unit, if it has one.
pub fn with_unit(value: f64, unit: &str) -> String {
    let value = significant(value);
    if matches!(unit, "" | "1") { value } else { format!("{value} {}", self::unit(unit)) }
}

/// Formats a non-zero share of the runs in percent; a share below 1 is never printed as 100 %.
pub fn share_of_runs(share: f64) -> String {
    match share {
        ..0.001 => "less than 0.1 %".to_owned(),
        1.0 => "100 %".to_owned(),
        0.9995.. => "more than 99.9 %".to_owned(),
        share => format!("{:.1} %", 100.0 * share),
    }
}

/// Formats `value` with `digits` decimals; a zero has no sign.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// Formats `value` with six significant digits, in exponent form if it is small or huge, without trailing zeros.
pub fn significant(value: f64) -> String {
    significant_to(value, SIGNIFICANT)
}

/// Magnitude below which numbers are written with a power of ten.
const SMALL: f64 = 1e-5;
/// Number of digits of [`significant`].
const SIGNIFICANT: usize = 6;

/// Formats `value` with so many significant digits; the digits before the decimal point are all written.
fn significant_to(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { value.to_string() };
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    let max_power = digits as i32 - 1;
    match value.abs() < SMALL || power > max_power + 3 {
        true => format!("{}e{exponent}", without_zeros(mantissa)),
        false => without_zeros(&format!("{value:.*}", (max_power - power).max(0) as usize)).to_owned(),
    }
}

/// Removes trailing zeros of the decimals.
fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// Formats an error or width by itself, with two significant digits: 0.000083, or 8.3e-7 if it is smaller.
pub fn two_digits(value: f64) -> String {
    rounded(value, 2)
}

/// Formats `value` with so many significant digits, without trailing zeros.
fn rounded(value: f64, digits: usize) -> String {
    significant_to(round_significant(value, digits), digits.max(SIGNIFICANT))
}

/// Rounds to so many significant digits; formatting and reading do it exactly.
pub fn round_significant(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Returns the power of ten of the first digit of a number.
fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// Formats a probability; `-` if it is unknown. An estimate is never certain: beyond 0.001 and 0.999 it is a bound.
pub fn chance(probability: Option<f64>) -> String {
    match probability {
        None => "-".to_owned(),
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) if p > 0.999 => "> 0.999".to_owned(),
        Some(p) => fixed(p, 3),
    }
}

/// Formats a value by `text`; a dash for `None`.
pub fn or_dash<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), text)
}

/// Formats a value with four significant digits.
pub fn short(value: f64) -> String {
    rounded(value, 4)
}

/// Formats a value with four significant digits, or with as many more as distinguish values over a range of `spread`.
pub fn short_among(value: f64, spread: f64) -> String {
    /// Number of digits of the spread that are shown.
    const SPREAD_DIGITS: i32 = 3;
    /// Number of digits of a double.
    const MAX_DIGITS: i32 = 15;
    let digits = match value != 0.0 && value.is_finite() && spread > 0.0 {
        true => (exponent(value) - exponent(spread) + SPREAD_DIGITS).clamp(4, MAX_DIGITS),
        false => 4,
    };
    rounded(value, digits as usize)
}

/// Does the same as `short_among`, with the unit if there is one.
pub fn among_with_unit(value: f64, spread: f64, unit: &str) -> String {
    let value = short_among(value, spread);
    if matches!(unit, "" | "1") { value } else { format!("{value} {}", self::unit(unit)) }
}

/// Formats a value with four significant digits and its unit, if it has one.
pub fn short_with_unit(value: f64, unit: &str) -> String {
    among_with_unit(value, 0.0, unit)
}

/// Formats the same with a true minus sign, for sentences and pages.
pub fn value(value: f64, unit: &str) -> String {
    minus(&short_with_unit(value, unit))
}

/// Formats a value with three significant digits and a true minus sign, for charts.
pub fn printed(value: f64) -> String {
    minus(&rounded(value, 3))
}

/// Formats a value with three significant digits, trailing zeros included, and a true minus sign; a dash if not finite.
pub fn three_digits(value: f64) -> String {
    const DIGITS: i32 = 3;
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    // The exponent after rounding: 9.996 is 10.0, not 10.00.
    let scientific = format!("{value:.*e}", DIGITS as usize - 1);
    let exponent = scientific.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    let text = match exponent {
        _ if value == 0.0 => "0".to_owned(),
        -3..=5 => format!("{value:.*}", (DIGITS - 1 - exponent).max(0) as usize),
        _ => scientific,
    };
    minus(&text)
}

/// Formats a time in s with three digits.
pub fn time(seconds: f64) -> String {
    format!("{} s", three_digits(seconds))
}

/// Formats a force in N with three digits, in nN.
pub fn force(newtons: f64) -> String {
    format!("{} nN", three_digits(newtons * 1e9))
}

/// Formats a length in m with three digits, in nm.
pub fn length(metres: f64) -> String {
    format!("{} nm", three_digits(metres * 1e9))
}

/// Formats a relative change in percent with its sign; only its direction if it is too small to be read; `None` if it
/// is not finite.
pub fn change(part: f64) -> Option<String> {
    const MIN_PROBABILITY: f64 = 1e-3;
    let percent = 100.0 * part;
    if percent != 0.0 && percent.abs() < MIN_PROBABILITY {
        return Some(format!("less than {MIN_PROBABILITY} % ({})", if percent > 0.0 { "up" } else { "down" }));
    }
    let sign = if part > 0.0 { "+" } else { "" };
    part.is_finite().then(|| format!("{sign}{} %", three_digits(percent)))
}

/// Formats a count with its noun: `one run`, `2 runs`, `655 360 runs`.
pub fn count(number: u64, one: &str, many: &str) -> String {
    if number == 1 { format!("one {one}") } else { format!("{} {many}", grouped(number)) }
}

/// Formats a whole number with its digits in groups of three.
pub fn grouped(number: u64) -> String {
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

/// Replaces hyphens before digits by minus signs, unless a letter or digit precedes them.
pub fn minus(text: &str) -> String {
    let mut signed = String::with_capacity(text.len());
    let (mut before, mut letters) = (' ', text.chars().peekable());
    while let Some(c) = letters.next() {
        let is_sign = c == '-' && !before.is_alphanumeric() && letters.peek().is_some_and(char::is_ascii_digit);
        signed.push(if is_sign { '−' } else { c });
        before = c;
    }
    signed
}

/// Formats an estimate with its error and its unit, if it has one.
pub(crate) fn index_with_unit(record: Estimate, unit: &str) -> String {
    format!("{} {}", index(record), axis_unit(unit)).trim_end().to_owned()
}

/// Converts a name of the study to words; a symbol such as `F_cr` is kept.
pub fn name(name: &str) -> String {
    if is_symbol(name) { name.to_owned() } else { words(name) }
}

/// Converts any name to words.
pub fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// Splits a text after its first word, or before it if it does not begin with one.
pub(crate) fn split_word(text: &str) -> (&str, &str) {
    let end = if text.starts_with(is_in_word) { text.find(|c| !is_in_word(c)) } else { text.find(is_in_word) };
    text.split_at(end.unwrap_or(text.len()))
}

fn is_in_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn is_symbol(name: &str) -> bool {
    name.chars().count() <= 3 || symbol(name).is_some()
}

/// Formats a unit for an axis: none for pure numbers.
pub fn axis_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { self::unit(unit) }
}

/// Formats a name and its unit, if it has one, as a heading.
pub fn heading(name: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") { self::name(name) } else { format!("{} ({})", self::name(name), self::unit(unit)) }
}
