//! Units of inputs and outputs: as typed at the interfaces, SI inside.

mod dimension;
mod domain;
mod error;
mod same;
mod symbols;
mod unit;
mod unlikely;

use std::fmt;

pub use dimension::Dimension;
pub use domain::Domain;
pub use error::UnitError;
pub use same::is_same;
pub use unit::Unit;
pub use unlikely::Unlikely;

/// A value with its unit, as typed.
///
/// ```
/// use apportion_base::quantity::Quantity;
///
/// let tilt = Quantity::parse("0.7 deg")?;
/// assert_eq!(tilt.to_si(), 0.7_f64.to_radians());
/// assert_eq!(tilt.to_string(), "0.7 deg");
/// # Ok::<(), apportion_base::quantity::UnitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number, in `unit`.
    pub value: f64,
    /// The unit.
    pub unit: Unit,
}

impl Quantity {
    /// Parses a finite number and a unit, with or without a space between them; without a unit it is dimensionless.
    ///
    /// # Errors
    ///
    /// [`UnitError::NotANumber`] if it does not begin with a finite number, otherwise the error of [`Unit::parse`].
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let trimmed = text.trim();
        let number = &trimmed[..number_length(trimmed)];
        let value = number.parse().ok().filter(|value: &f64| value.is_finite());
        let value = value.ok_or_else(|| UnitError::NotANumber { text: text.to_owned() })?;
        Ok(Self { value, unit: Unit::parse(&trimmed[number.len()..])? })
    }

    /// Returns the value in SI.
    pub fn to_si(&self) -> f64 {
        self.unit.to_si(self.value)
    }
}

/// Returns the length in bytes of the decimal number at the beginning of `text`.
fn number_length(text: &str) -> usize {
    let max = text.find(|c: char| !c.is_ascii_digit() && !"+-.eE".contains(c)).unwrap_or(text.len());
    // "3 eV" and "2e" contain no exponent.
    (1..=max).rev().find(|length| text[..*length].parse::<f64>().is_ok()).unwrap_or(0)
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.value.abs();
        if size == 0.0 || (1e-4..1e15).contains(&size) {
            write!(f, "{}", self.value)?;
        } else {
            write!(f, "{:e}", self.value)?;
        }
        if self.unit.symbol().is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

#[cfg(test)]
#[path = "tests/quantity.rs"]
mod tests;
