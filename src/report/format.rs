//! Numbers and names as people read them.

use super::capitalised;
use super::result::{EstimateRecord, IntervalRecord};

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

/// An index and the half width of its interval with four decimals, `0.3374 ± 0.0024`; both bounds where they are not
/// symmetric about the estimate, the estimate alone where there is no interval. Files have all digits.
pub fn give_or_take(record: EstimateRecord) -> String {
    const DIGITS: usize = 4;
    const LEAST: f64 = 1e-4;
    let bounds = [record.estimate, record.low.unwrap_or(record.estimate), record.high.unwrap_or(record.estimate)];
    if bounds.iter().all(|bound| *bound == 0.0) {
        return "0".to_owned();
    }
    if bounds.iter().all(|bound| bound.abs() < LEAST) {
        return if bounds.iter().all(|bound| *bound > 0.0) { "< 0.0001" } else { "0 ± < 0.0001" }.to_owned();
    }
    let text = fixed(record.estimate, DIGITS);
    let (Some(low), Some(high)) = (record.low, record.high) else { return text };
    let half_width = (high - low) / 2.0;
    if half_width < LEAST / 2.0 {
        format!("{text} ± < 0.0001")
    } else if (low + high - 2.0 * record.estimate).abs() > 0.01 * (high - low) {
        estimate(record, DIGITS)
    } else {
        format!("{text} ± {}", fixed(half_width, DIGITS))
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
pub fn chance(probability: Option<f64>) -> String {
    match probability {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(1.0) => "1".to_owned(),
        Some(p) if p < 0.001 => "<0.001".to_owned(),
        Some(p) if p > 0.999 => ">0.999".to_owned(),
        Some(p) => fixed(p, 3),
    }
}

/// A value with four significant digits.
pub fn short(value: f64) -> String {
    let text = significant(format!("{value:.3e}").parse().unwrap_or(value));
    match text.split_once('e') {
        Some((digits, exponent)) if digits.contains('.') => {
            format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    }
}

/// A value with four significant digits and its unit, if it has one.
pub fn short_with_unit(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") { short(value) } else { format!("{} {unit}", short(value)) }
}

/// The same with a true minus sign, for sentences and pages.
pub fn value(value: f64, unit: &str) -> String {
    minus(&short_with_unit(value, unit))
}

/// A value with three significant digits and a true minus sign, for charts.
pub fn printed(value: f64) -> String {
    short(format!("{value:.2e}").parse().unwrap_or(value)).replace('-', "\u{2212}")
}

/// A value with three significant digits, zeros at the end among them, and a true minus sign; a dash if it is not finite.
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
    text.replace('-', "\u{2212}")
}

/// A time in s with three digits.
pub fn time(seconds: f64) -> String {
    format!("{} s", three_digits(seconds))
}

/// A force in N with three digits, said in nN.
pub fn force(newtons: f64) -> String {
    format!("{} nN", three_digits(newtons * 1e9))
}

/// A length in m with three digits, said in nm.
pub fn length(metres: f64) -> String {
    format!("{} nm", three_digits(metres * 1e9))
}

/// A change as a part, said in percent with its sign; its direction alone where it is too small to be read; `None` if it is
/// not finite.
pub fn change(part: f64) -> Option<String> {
    const LEAST: f64 = 1e-3;
    let percent = 100.0 * part;
    if percent != 0.0 && percent.abs() < LEAST {
        return Some(format!("less than {LEAST} % ({})", if percent > 0.0 { "up" } else { "down" }));
    }
    let sign = if part > 0.0 { "+" } else { "" };
    part.is_finite().then(|| format!("{sign}{} %", three_digits(percent)))
}

/// `0.678 (0.676 to 0.680)`, with as many decimals as the interval deserves; the estimate alone without an interval.
pub fn index(record: EstimateRecord) -> String {
    let (Some(low), Some(high)) = (record.low, record.high) else { return minus(&fixed(record.estimate, 3)) };
    let half_width = (high - low) / 2.0;
    let digits = decimals(half_width);
    let [text, low, high] = [record.estimate, low, high].map(|number| fixed(number, digits));
    let is_too_narrow = half_width > 0.0 && low == high;
    minus(&if is_too_narrow {
        format!("{text} ± {}", two_digits(half_width))
    } else {
        format!("{text} ({low} to {high})")
    })
}

/// A share of 1 in percent with its bounds: `39.2 % (38.9 to 39.5 %)`.
pub fn percent(record: EstimateRecord) -> String {
    let percent = |share: f64, digits| fixed(100.0 * share, digits);
    let (Some(low), Some(high)) = (record.low, record.high) else {
        return format!("{} %", percent(record.estimate, 1));
    };
    let digits = decimals((high - low) / 2.0).saturating_sub(2).min(3);
    minus(&format!("{} % ({} to {} %)", percent(record.estimate, digits), percent(low, digits), percent(high, digits)))
}

/// Decimals that a number with this half width deserves.
fn decimals(half_width: f64) -> usize {
    if half_width > 0.0 { (-half_width.log10()).ceil().clamp(2.0, 7.0) as usize } else { 3 }
}

/// `one run`, `2 runs`, `655 360 runs`.
pub fn count(number: u64, one: &str, many: &str) -> String {
    if number == 1 { format!("one {one}") } else { format!("{} {many}", grouped(number)) }
}

/// A whole number with its digits in threes.
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

/// Hyphens before digits as minus signs, where no letter or digit stands before them.
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

/// A name of the study as words; a symbol such as `F_cr` stays one.
pub fn name(name: &str) -> String {
    if is_symbol(name) { name.to_owned() } else { words(name) }
}

/// A name as words, whatever it is.
pub fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// A name after an article, which symbols go without.
pub fn the(text: &str) -> String {
    if is_symbol(text) { text.to_owned() } else { format!("the {}", words(text)) }
}

/// A name at the beginning of a sentence.
pub fn first(text: &str) -> String {
    if is_symbol(text) { text.to_owned() } else { capitalised(&words(text)) }
}

/// A text with a capital at the beginning, but for symbols.
pub fn sentence(text: &str) -> String {
    if text.chars().count() > 3 { capitalised(text) } else { text.to_owned() }
}

fn is_symbol(name: &str) -> bool {
    name.chars().count() <= 3 || name.chars().nth(1) == Some('_')
}

/// A unit for an axis: none for pure numbers.
pub fn axis_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.to_owned() }
}

/// A name and its unit, if it has one, as a heading.
pub fn heading(name: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") { first(name) } else { format!("{} ({unit})", first(name)) }
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
        let chances = [None, Some(0.0), Some(1e-5), Some(0.25), Some(0.9999), Some(1.0)].map(chance);
        assert_eq!(chances, ["-", "0", "<0.001", "0.250", ">0.999", "1"]);
    }

    fn record(low: f64, estimate: f64, high: f64) -> EstimateRecord {
        EstimateRecord { estimate, low: Some(low), high: Some(high) }
    }

    #[test]
    fn values_in_tables_and_sentences() {
        assert_eq!(short(1234.567), "1235");
        assert_eq!(short_with_unit(-0.012_346, "nN"), "-0.01235 nN");
        assert_eq!(value(-0.012_346, "nN"), "−0.01235 nN");
        assert_eq!(short(0.0), "0");
        assert_eq!((short(3.072e-5), short(-1e-12)), ("3.072e-5".to_owned(), "-1e-12".to_owned()));
        assert_eq!(short_with_unit(2.5, "1"), "2.5");
        assert_eq!(grouped(655_360), "655\u{202f}360");
        assert_eq!((grouped(1024), grouped(1_048_576)), ("1024".to_owned(), "1\u{202f}048\u{202f}576".to_owned()));
        assert_eq!((count(1, "run", "runs"), count(2, "run", "runs")), ("one run".to_owned(), "2 runs".to_owned()));
        assert_eq!(index(record(0.6755, 0.6778, 0.6801)), "0.678 (0.675 to 0.680)");
        assert_eq!(index(record(-0.02, 0.0, 0.02)), "0.00 (−0.02 to 0.02)");
        assert_eq!(index(record(1.0, 1.0, 1.0)), "1.000 (1.000 to 1.000)");
        assert_eq!(index(record(0.758_136_218, 0.758_136_22, 0.758_136_226)), "0.7581362 ± 4e-9");
        assert_eq!(percent(record(0.3890, 0.3920, 0.3950)), "39.2 % (38.9 to 39.5 %)");
        assert_eq!(percent(EstimateRecord { estimate: 0.5, low: None, high: None }), "50.0 %");
        assert_eq!(give_or_take(record(0.0, 0.0, 0.0)), "0");
        assert_eq!(give_or_take(record(1e-6, 2e-6, 3e-6)), "< 0.0001");
        assert_eq!(give_or_take(record(-2e-5, 1e-5, 4e-5)), "0 ± < 0.0001");
        assert_eq!(give_or_take(record(0.012_34, 0.012_35, 0.012_36)), "0.0123 ± < 0.0001");
        assert_eq!(give_or_take(record(0.012_340, 0.012_343, 0.012_36)), "0.0123 ± < 0.0001");
        assert_eq!(give_or_take(record(0.48, 0.5, 0.52)), "0.5000 ± 0.0200");
        assert_eq!(give_or_take(record(-4e-5, 5e-5, 14e-5)), "0.0001 ± 0.0001");
        assert_eq!(give_or_take(record(0.4, 0.5, 0.52)), "0.5000 [0.4000, 0.5200]");
        assert_eq!(give_or_take(EstimateRecord { estimate: 0.5, low: None, high: None }), "0.5000");
    }

    #[test]
    fn names_read_as_words_and_symbols_stay() {
        assert_eq!((name("critical_force"), name("F_cr")), ("critical force".to_owned(), "F_cr".to_owned()));
        assert_eq!((the("critical_force"), the("y")), ("the critical force".to_owned(), "y".to_owned()));
        assert_eq!((first("thickness"), first("x1")), ("Thickness".to_owned(), "x1".to_owned()));
    }

    #[test]
    fn three_digits_are_three() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (0.131_27, "0.131"),
            (630.96, "631"),
            (-26.9, "\u{2212}26.9"),
            (9.996, "10.0"),
            (123_456.0, "123456"),
            (1.5e-7, "1.50e\u{2212}7"),
            (1e300, "1.00e300"),
            (f64::NAN, "\u{2013}"),
        ];
        for (value, text) in cases {
            assert_eq!(three_digits(value), text, "{value}");
        }
        assert_eq!(force(631.2e-9), "631 nN");
        assert_eq!(change(0.0123).as_deref(), Some("+1.23 %"));
        assert_eq!(change(-0.5).as_deref(), Some("\u{2212}50.0 %"));
        assert_eq!(change(-5e-7).as_deref(), Some("less than 0.001 % (down)"));
        assert_eq!(change(f64::NAN), None);
    }
}
