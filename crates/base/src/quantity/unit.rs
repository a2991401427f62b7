//! Unit symbols.
//!
//! A unit is a product of powers of SI symbols with prefixes, parsed by a small grammar instead of a list, so that
//! `mJ/m2`, `nN/nm` and `g/cm^3` need no separate entry. Most factors are powers of ten, and conversions shift the
//! decimal point of the decimal number that was typed, so that `230.3 um` becomes exactly the number `230.3e-6`, unlike
//! 230.3 * 1e-6 and 230.3 / 1e6.
//!
//! `degC` and `degF` have an offset. It applies if such a unit is used alone and a value is converted; a difference of
//! two values, and a product such as `W/m2/degC`, has only the scale.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::symbols::{lookup, nearest};
use super::{Dimension, UnitError};

/// A unit symbol, its factor to SI and its dimension.
///
/// Two units are equal if they were typed alike; see [`compatible`](Self::compatible) for the same dimension. In JSON
/// it is its symbol; when read from there, a text that is not a unit is a [`label`](Self::label).
///
/// ```
/// use apportion_base::quantity::Dimension;
/// use apportion_base::quantity::Unit;
///
/// let micrometre = Unit::parse("um")?;
/// assert_eq!(micrometre.to_si(225.0), 225e-6);
/// assert!(micrometre.compatible(&Unit::parse("nm")?));
/// assert_eq!(Unit::parse("mJ/m^2")?.dimension(), Unit::parse("N/m")?.dimension());
/// assert_eq!(Unit::parse("GPa")?.dimension().to_string(), "a pressure");
/// assert!(Unit::parse("furlong").is_err());
/// let celsius = Unit::parse("degC")?;
/// assert_eq!((celsius.to_si(20.0), celsius.span_to_si(20.0)), (293.15, 20.0));
/// # Ok::<(), apportion_base::quantity::UnitError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct Unit {
    symbol: String,
    /// The factor is 10^decade times / over (pi / 180)^degrees.
    decade: i32,
    times: f64,
    over: f64,
    degrees: i8,
    /// The offset added to a value, in this unit, before it is multiplied.
    offset: f64,
    dimension: Dimension,
    is_label: bool,
}

/// Factors beyond this power of ten are refused: values would exceed the range of `f64`.
const MAX_DECADES: f64 = 100.0;

impl Unit {
    /// Returns the unit of dimensionless numbers, `1`.
    pub fn dimensionless() -> Self {
        Self::called("1")
    }

    /// Returns the unit `text` if it is one, otherwise a label: a unit of its own kind, whose numbers are not
    /// converted. Outputs of programs have such units, for example `USD` or `points`.
    ///
    /// ```
    /// use apportion_base::quantity::Unit;
    ///
    /// let price = Unit::label("EUR/kWh");
    /// assert_eq!((price.symbol(), price.to_si(0.3)), ("EUR/kWh", 0.3));
    /// assert!(!price.compatible(&Unit::label("USD/kWh")));
    /// assert_eq!(Unit::label("nN").to_si(3.0), 3e-9);
    /// ```
    pub fn label(text: &str) -> Self {
        Self::known(text).unwrap_or_else(|| Self { is_label: true, ..Self::called(text.trim()) })
    }

    /// Returns the unit `text`, if it is one.
    pub fn known(text: &str) -> Option<Self> {
        Self::read(text, |_| None).ok()
    }

    /// Returns a dimensionless unit with this symbol.
    fn called(symbol: &str) -> Self {
        let (symbol, dimension) = (symbol.to_owned(), Dimension::NUMBER);
        Self { symbol, decade: 0, times: 1.0, over: 1.0, degrees: 0, offset: 0.0, dimension, is_label: false }
    }

    /// Parses a unit: symbols with powers (`m2`, `m^2`, `m²`, `m-2`) joined by a space, `*`, `·` or `.`, and divided by
    /// `/`. `µ` and `u` are both micro; `Ns`, `Nm`, `Pas` and `Js` need no sign between them; the empty string and `1`
    /// are dimensionless.
    ///
    /// # Errors
    ///
    /// [`UnitError`] with the part that is invalid. A product after a division (`N/m s`) is refused as ambiguous; so is
    /// a factor to SI beyond 10^100.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        Self::read(text, nearest)
    }

    /// Parses a unit; `nearest` finds a symbol similar to an unknown one.
    fn read(text: &str, nearest: fn(&str) -> Option<String>) -> Result<Self, UnitError> {
        let mut unit = Self::called(text.trim());
        if unit.symbol.is_empty() {
            return Ok(unit);
        }
        let mut offsets = Vec::new();
        for (place, part) in plain(&unit.symbol.clone()).split('/').enumerate() {
            let mut factors = part.split(['*', '.', ' ']).filter(|factor| !factor.is_empty()).peekable();
            if factors.peek().is_none() {
                return Err(malformed(text, "something is missing next to the \"/\""));
            }
            for (count, factor) in factors.enumerate() {
                if place > 0 && count > 0 {
                    let reason = "a product after \"/\" can be read in two ways, write it before (\"N s/m\")";
                    return Err(malformed(text, reason));
                }
                let power = if place == 0 { 1 } else { -1 };
                offsets.extend(unit.multiply(factor, power, text, nearest)?);
            }
        }
        if let [(offset, 1)] = offsets[..] {
            unit.offset = offset;
        }
        let decades = f64::from(unit.decade) + libm::log10(unit.times / unit.over);
        if !(-MAX_DECADES..=MAX_DECADES).contains(&decades) {
            return Err(malformed(text, "its factor to SI is beyond 10^100"));
        }
        Ok(unit)
    }

    /// Multiplies by one factor, such as `mm^2`, to the power 1 or -1. Returns the offset and the power of every symbol
    /// in it, except `1`. `nearest` finds a symbol similar to an unknown one.
    fn multiply(
        &mut self,
        factor: &str,
        sign: i8,
        text: &str,
        nearest: fn(&str) -> Option<String>,
    ) -> Result<Vec<(f64, i8)>, UnitError> {
        let end = factor.find(|c: char| c.is_ascii_digit() || "^+-".contains(c)).filter(|end| *end > 0);
        let (name, exponent) = factor.split_at(end.unwrap_or(factor.len()));
        let exponent = exponent.strip_prefix('^').unwrap_or(exponent);
        let power = match exponent {
            "" if name == factor => 1,
            _ => exponent.parse::<i8>().map_err(|_| malformed(text, "a power must be a whole number, as in \"m2\""))?,
        };
        if !(1..=9).contains(&power.unsigned_abs()) {
            return Err(malformed(text, "a power must lie between 1 and 9, or -9 and -1"));
        }
        let mut offsets = Vec::new();
        let Some(symbols) = lookup(name) else {
            let (unit, symbol, nearest) = (text.to_owned(), name.to_owned(), nearest(name));
            return Err(UnitError::Unknown { unit, symbol, nearest });
        };
        for (symbol, prefix) in symbols {
            let (times, over) = (symbol.times.powi(power.abs().into()), symbol.over.powi(power.abs().into()));
            let (times, over) = if power * sign > 0 { (times, over) } else { (over, times) };
            (self.times, self.over) = (self.times * times, self.over * over);
            self.decade += (symbol.decade + prefix) * i32::from(power * sign);
            self.dimension = self.dimension.times(symbol.dimension, power * sign).ok_or_else(|| too_high(text))?;
            if matches!(symbol.name, "deg" | "°") {
                self.degrees = self.degrees.checked_add(power * sign).ok_or_else(|| too_high(text))?;
            }
            if symbol.name != "1" {
                offsets.push((symbol.offset, power * sign));
            }
        }
        Ok(offsets)
    }

    /// Returns the symbol as typed, without surrounding spaces.
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// Returns the kind of quantity that it measures.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Returns whether it is a label, not a unit of physics.
    pub fn is_label(&self) -> bool {
        self.is_label
    }

    /// Returns whether it measures something: neither a label nor dimensionless, which is the default.
    pub fn is_of_kind(&self) -> bool {
        !self.is_label && self.dimension != Dimension::NUMBER
    }

    /// Returns whether values can be converted between the units: they have the same dimension, and label if any.
    pub fn compatible(&self, other: &Self) -> bool {
        let is_label = self.is_label || other.is_label;
        self.dimension == other.dimension && (!is_label || self == other)
    }

    /// Returns whether its values are those in SI.
    pub fn is_si(&self) -> bool {
        self.is_decimal() && self.decade == 0 && self.degrees == 0 && !self.has_offset()
    }

    /// Returns whether its zero differs from that of SI, as for `degC`: ratios of its values have no meaning.
    pub fn has_offset(&self) -> bool {
        self.offset != 0.0
    }

    /// Converts a value in this unit to SI. If the factor is a power of ten, the result is the `f64` nearest to the
    /// decimal number typed, with its decimal point shifted; otherwise it is within 2 ulp. Overflows to infinity. Takes
    /// about 0.2 us, so not for inner loops.
    pub fn to_si(&self, value: f64) -> f64 {
        self.span_to_si(if self.has_offset() { value + self.offset } else { value })
    }

    /// Converts a value in SI to this unit; `from_si(to_si(x))` is `x` for numbers of up to 15 digits if the factor is
    /// a power of ten, otherwise to within 2 ulp, for a unit with an offset of the value and the offset together.
    pub fn from_si(&self, value: f64) -> f64 {
        if !self.has_offset() {
            return self.span_from_si(value);
        }
        let near = self.span_from_si(value) - self.offset;
        // The decimal number that was probably typed, without the rounding errors of a sum.
        let typed: Option<f64> = format!("{near:.10}").parse().ok();
        typed.filter(|typed| self.to_si(*typed) == value).unwrap_or(near)
    }

    /// Converts a difference of values in this unit, such as a standard deviation, to SI: no offset of `degC`.
    pub fn span_to_si(&self, span: f64) -> f64 {
        let multiplied = if self.is_decimal() { span } else { span * self.times / self.over };
        shift(multiplied, self.decade) * 1f64.to_radians().powi(self.degrees.into())
    }

    /// Converts a difference of two values in SI to this unit.
    pub fn span_from_si(&self, span: f64) -> f64 {
        let shifted = shift(span / 1f64.to_radians().powi(self.degrees.into()), -self.decade);
        if self.is_decimal() { shifted } else { shifted * self.over / self.times }
    }

    /// Returns whether the factor is a power of ten, apart from degrees.
    fn is_decimal(&self) -> bool {
        self.times == 1.0 && self.over == 1.0
    }
}

fn malformed(unit: &str, reason: &'static str) -> UnitError {
    UnitError::Malformed { unit: unit.to_owned(), reason }
}

fn too_high(unit: &str) -> UnitError {
    malformed(unit, "its powers are too high")
}

impl PartialEq for Unit {
    fn eq(&self, other: &Self) -> bool {
        self.symbol == other.symbol
    }
}

impl Eq for Unit {}

/// Returns `value * 10^decade`, where `value` represents the shortest decimal number that is read as it.
fn shift(value: f64, decade: i32) -> f64 {
    let arithmetic = value * 10f64.powi(decade);
    if decade == 0 || !value.is_finite() {
        return arithmetic;
    }
    let decimal = format!("{value:e}");
    let parts = decimal.split_once('e');
    let exponent = parts.and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    let shifted =
        parts.zip(exponent).and_then(|((digits, _), exponent)| format!("{digits}e{}", exponent + decade).parse().ok());
    shifted.unwrap_or(arithmetic)
}

/// Returns the unit with typographical characters replaced by plain ones, powers as digits and `^`.
fn plain(text: &str) -> String {
    text.replace("**", "^")
        .chars()
        .map(|c| match c {
            '\u{b5}' | '\u{3bc}' => 'u',
            '\u{b7}' | '\u{22c5}' | '\u{d7}' => '*',
            '\u{2212}' | '\u{207b}' => '-',
            '\u{b9}' => '1',
            '\u{b2}' => '2',
            '\u{b3}' => '3',
            '\u{2074}' => '4',
            // The ohm sign becomes the Greek letter, the angstrom sign the Swedish one.
            '\u{2126}' => '\u{3a9}',
            '\u{212b}' => '\u{c5}',
            other => other,
        })
        .collect()
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.symbol)
    }
}

impl From<String> for Unit {
    fn from(text: String) -> Self {
        Self::label(&text)
    }
}

impl From<Unit> for String {
    fn from(unit: Unit) -> Self {
        unit.symbol
    }
}

#[cfg(test)]
#[path = "tests/unit.rs"]
mod tests;
