//! Estimates with their errors, with as many digits as the error justifies: for all sentences, tables and captions.

use std::fmt;

use apportion::uncertainty::{Estimate, Interval};

use super::{SIGNIFICANT, SMALL, exponent, minus, round_significant, rounded, significant};

/// Ratio of the longer to the shorter side up to which an interval is printed by the longer one.
const EVEN: f64 = 1.5;
/// Part of the estimate below which both ends of an interval are not needed.
const MIN_SHOWN: f64 = 0.01;
/// Part of the estimate up to which an error is that of rounding.
const ROUNDING: f64 = 1e-11;
/// Significant digits of an estimate whose error is unknown.
const WITHOUT_ERROR: usize = 3;

/// An estimate as it is printed: `0.02487 ± 0.00003` with the half width of its interval, or `0.68 [0.52, 1.03]` with
/// both bounds if they are not symmetric about it to within half and longer than 1 % of it. Very small and very large
/// numbers share a power of ten: `(1.557 ± 0.005)e-5`.
///
/// The half width (the longer one if the two differ) has one digit, two if it begins with 1, and the estimate ends at
/// the same place, after six digits at the latest; the rounding is included in the error. Bounds have the digits of the
/// nearer one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedEstimate {
    estimate: f64,
    error: PrintedError,
    /// Number of decimals of all numbers, which may be negative.
    decimals: i32,
    /// The power of ten that all numbers share; 0 for none.
    power: i32,
}

/// The error next to a printed estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PrintedError {
    Unknown,
    /// Less than the printed digits show.
    OfRounding,
    HalfWidth(f64),
    Bounds(Interval),
}

impl PrintedEstimate {
    /// Chooses the digits of an estimate.
    pub fn new(Estimate { estimate, interval }: Estimate) -> Self {
        let Some(bounds) = interval else { return Self::alone(estimate, PrintedError::Unknown) };
        let (below, above) = (estimate - bounds.low, bounds.high - estimate);
        let half = (bounds.high - bounds.low) / 2.0;
        // An error of rounding is none of a number that six digits hold.
        let cut = (six_digits(estimate) - estimate).abs();
        if !(half.max(cut) > ROUNDING * estimate.abs() && half > 0.0 && half.is_finite() && estimate.is_finite()) {
            return Self::alone(estimate, PrintedError::OfRounding);
        }
        let (nearer, farther) = (f64::min(below, above), f64::max(below, above));
        if nearer * EVEN < farther && half >= MIN_SHOWN * estimate.abs() {
            return Self::with_bounds(estimate, bounds);
        }
        let decimals = decimals_of(farther, 20.0).min(max_decimals(estimate));
        let unit = libm::pow(10.0, f64::from(-decimals));
        let is_cut = decimals < decimals_of(farther, 20.0);
        let error = if is_cut { unit * (farther / unit + 0.5).ceil() } else { farther };
        let power = common_power(estimate, error);
        Self { estimate, error: PrintedError::HalfWidth(error), decimals, power }
    }

    fn alone(estimate: f64, error: PrintedError) -> Self {
        Self { estimate, error, decimals: 0, power: 0 }
    }

    fn with_bounds(estimate: f64, bounds: Interval) -> Self {
        let Interval { low, high } = bounds;
        // A bound next to the estimate does not justify many digits.
        let nearer = f64::min(estimate - low, high - estimate).max((high - low) / 4.0);
        let decimals = decimals_of(nearer, 30.0).min(max_decimals(estimate));
        let power = common_power(estimate, nearer);
        Self { estimate, error: PrintedError::Bounds(bounds), decimals, power }
    }

    /// Returns the half width as printed; `None` if none is.
    pub fn half_width(&self) -> Option<f64> {
        match self.error {
            PrintedError::HalfWidth(half) => Some(self.rounded(half)),
            _ => None,
        }
    }

    /// Returns the number without its error, if it has no more than `max_decimals` and no power of ten.
    pub(crate) fn short_number(&self, max_decimals: usize) -> Option<String> {
        let text = match self.error {
            PrintedError::Unknown => rounded(self.estimate, WITHOUT_ERROR),
            PrintedError::OfRounding => significant(self.estimate),
            _ => self.digits(self.estimate),
        };
        let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        (!self.has_power() && decimals <= max_decimals).then(|| minus(&text))
    }

    /// Returns whether the estimate has a power of ten: a zero next to a half width has none.
    fn has_power(&self) -> bool {
        let is_zero = matches!(self.error, PrintedError::HalfWidth(_)) && self.digits(self.estimate) == "0";
        self.power != 0 && !is_zero
    }

    fn rounded(&self, value: f64) -> f64 {
        let unit = libm::pow(10.0, f64::from(self.decimals.abs()));
        if self.decimals < 0 { (value / unit).round() * unit } else { (value * unit).round() / unit }
    }

    /// Formats a number with the decimals, in units of the power of ten; a zero is `0`.
    fn digits(&self, value: f64) -> String {
        let (value, decimals) = (value * libm::pow(10.0, f64::from(-self.power)), self.decimals + self.power);
        if decimals < 0 {
            let unit = libm::pow(10.0, f64::from(-decimals));
            return significant((value / unit).round() * unit);
        }
        let text = format!("{value:.*}", decimals as usize);
        if text.chars().all(|c| matches!(c, '-' | '0' | '.')) { "0".to_owned() } else { text }
    }
}

impl fmt::Display for PrintedEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let estimate = self.digits(self.estimate);
        let text = match self.error {
            PrintedError::Unknown => return f.write_str(&rounded(self.estimate, WITHOUT_ERROR)),
            PrintedError::OfRounding => return f.write_str(&significant(self.estimate)),
            PrintedError::HalfWidth(half) => format!("{estimate} ± {}", self.digits(half)),
            PrintedError::Bounds(Interval { low, high }) => {
                format!("{estimate} [{}, {}]", self.digits(low), self.digits(high))
            }
        };
        match self.power {
            0 => f.write_str(&text),
            power if self.has_power() => write!(f, "({text})e{power}"),
            power => write!(f, "{text}e{power}"),
        }
    }
}

/// Formats an estimate and its error as [`PrintedEstimate`] does.
pub fn give_or_take(record: Estimate) -> String {
    PrintedEstimate::new(record).to_string()
}

/// Returns whether an interval excludes 0 from below, also as printed.
pub fn is_above_zero(record: Estimate) -> bool {
    let printed = PrintedEstimate::new(record);
    let is_printed_above = match printed.error {
        PrintedError::HalfWidth(half) => printed.rounded(printed.estimate) > printed.rounded(half),
        PrintedError::Bounds(bounds) => printed.rounded(bounds.low) != 0.0,
        PrintedError::Unknown | PrintedError::OfRounding => true,
    };
    record.interval.is_some_and(|interval| interval.low > 0.0) && is_printed_above
}

/// Formats like [`give_or_take`], for sentences, with true minus signs.
pub fn index(record: Estimate) -> String {
    minus(&give_or_take(record))
}

/// Formats a part of 1 in percent with its error: `39.96 ± 0.03 %`. The bounds of a part within 0 and 1 are cut there.
pub fn percent(record: Estimate) -> String {
    let Estimate { estimate, interval } = record;
    let min = if (0.0..=1.0).contains(&estimate) { 0.0 } else { f64::NEG_INFINITY };
    let interval =
        interval.map(|Interval { low, high }| Interval { low: (100.0 * low).max(min), high: (100.0 * high).max(min) });
    format!("{} %", minus(&up_to_all(Estimate { estimate: 100.0 * estimate, interval })))
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
    let printed = PrintedEstimate::with_bounds(estimate.min(ALL), Interval { low, high: ALL });
    // To six digits it is all.
    match [low, printed.estimate].iter().all(|bound| printed.rounded(*bound) == printed.rounded(ALL)) {
        true => significant(ALL),
        false => printed.to_string(),
    }
}

/// Rounds as [`significant`] does: to six digits, or to a whole number of up to nine.
fn six_digits(value: f64) -> f64 {
    let rounded = round_significant(value, SIGNIFICANT);
    let whole = SIGNIFICANT as i32..=SIGNIFICANT as i32 + 2;
    if whole.contains(&exponent(rounded)) { value.round() } else { rounded }
}

/// Returns the power of ten that an estimate and its error share; 0 if they are readable without.
fn common_power(estimate: f64, error: f64) -> i32 {
    let power = exponent(if estimate == 0.0 { error } else { f64::max(estimate.abs(), error) });
    if power <= SIGNIFICANT as i32 + 2 && (power >= -2 || error >= SMALL) { 0 } else { power }
}

/// Returns the number of meaningful decimals of an estimate.
fn max_decimals(estimate: f64) -> i32 {
    match estimate {
        0.0 => i32::MAX,
        estimate => SIGNIFICANT as i32 - 1 - exponent(estimate),
    }
}

/// Returns the number of decimals of a number with this error, of which one digit is printed, or two if they are less
/// than `one_digit`.
fn decimals_of(error: f64, one_digit: f64) -> i32 {
    let rounded = round_significant(error, 2);
    let exponent = exponent(rounded);
    let two_digits = (rounded * libm::pow(10.0, f64::from(1 - exponent))).round();
    if two_digits < one_digit { 1 - exponent } else { -exponent }
}
