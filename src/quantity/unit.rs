//! Unit symbols.
//!
//! A unit is a product of powers of SI symbols with prefixes, read by a small grammar rather than from a list, so
//! that `mJ/m2`, `nN/nm` and `g/cm^3` need no entry of their own. Every factor is a power of ten (degrees apart), and
//! conversions shift the decimal point of the decimal number that was typed, so that `230.3 um` becomes the very
//! number `230.3e-6`, which neither 230.3 * 1e-6 nor 230.3 / 1e6 is.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Dimension, UnitError};

/// A unit symbol, its factor to SI and its dimension.
///
/// Two units are equal if they were typed alike; see [`compatible`](Self::compatible) for the same dimension.
/// As JSON or TOML it is its symbol.
///
/// ```
/// use apportion::quantity::{Dimension, Unit};
///
/// let micrometre = Unit::parse("um")?;
/// assert_eq!(micrometre.to_si(225.0), 225e-6);
/// assert!(micrometre.compatible(&Unit::parse("nm")?));
/// assert_eq!(Unit::parse("mJ/m^2")?.dimension(), Unit::parse("N/m")?.dimension());
/// assert_eq!(Unit::parse("GPa")?.dimension().to_string(), "a pressure");
/// assert!(Unit::parse("furlong").is_err());
/// # Ok::<(), apportion::quantity::UnitError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Unit {
    symbol: String,
    /// The factor is 10^decade (pi / 180)^degrees.
    decade: i32,
    degrees: i8,
    dimension: Dimension,
}

/// A symbol that prefixes apply to: factor 10^decade to SI.
struct Symbol {
    name: &'static str,
    prefixes: &'static str,
    decade: i32,
    dimension: Dimension,
}

const fn symbol(name: &'static str, prefixes: &'static str, dimension: Dimension) -> Symbol {
    Symbol { name, prefixes, decade: 0, dimension }
}

const SYMBOLS: [Symbol; 25] = [
    symbol("m", "kcmunp", Dimension::LENGTH),
    Symbol { decade: -3, ..symbol("g", "kmunp", Dimension::MASS) },
    symbol("s", "munp", Dimension::TIME),
    symbol("Hz", "GMkm", Dimension::FREQUENCY),
    symbol("N", "GMkmunp", Dimension::FORCE),
    symbol("Pa", "GMkmun", Dimension::PRESSURE),
    symbol("J", "GMkmunp", Dimension::ENERGY),
    symbol("W", "GMkmunp", Dimension::POWER),
    symbol("A", "kmunp", Dimension::CURRENT),
    symbol("C", "munp", Dimension::CHARGE),
    symbol("V", "Mkmun", Dimension::VOLTAGE),
    symbol("ohm", "GMkmu", Dimension::RESISTANCE),
    symbol("\u{3a9}", "GMkmu", Dimension::RESISTANCE),
    symbol("F", "munp", Dimension::CAPACITANCE),
    symbol("T", "mun", Dimension::FLUX_DENSITY),
    symbol("K", "mun", Dimension::TEMPERATURE),
    symbol("mol", "kmunp", Dimension::AMOUNT),
    Symbol { decade: -3, ..symbol("L", "mun", Dimension::VOLUME) },
    Symbol { decade: -3, ..symbol("l", "mun", Dimension::VOLUME) },
    Symbol { decade: 5, ..symbol("bar", "m", Dimension::PRESSURE) },
    symbol("rad", "munp", Dimension::ANGLE),
    symbol("deg", "m", Dimension::ANGLE),
    symbol("°", "", Dimension::ANGLE),
    Symbol { decade: -2, ..symbol("%", "", Dimension::NUMBER) },
    symbol("1", "", Dimension::NUMBER),
];

const PREFIXES: [(char, i32); 8] =
    [('G', 9), ('M', 6), ('k', 3), ('c', -2), ('m', -3), ('u', -6), ('n', -9), ('p', -12)];

/// Factors beyond this power of ten are refused: values would leave the range of `f64`.
const MOST_DECADES: i32 = 100;

/// Every spelling of every symbol with its prefix, and the decade that the prefix adds.
fn spellings() -> impl Iterator<Item = (String, &'static Symbol, i32)> {
    SYMBOLS.iter().flat_map(|symbol| {
        let prefixed = PREFIXES.iter().filter(|(prefix, _)| symbol.prefixes.contains(*prefix));
        let bare = std::iter::once((symbol.name.to_owned(), symbol, 0));
        bare.chain(prefixed.map(move |(prefix, decade)| (format!("{prefix}{}", symbol.name), symbol, *decade)))
    })
}

impl Unit {
    /// The unit of pure numbers, `1`.
    pub fn dimensionless() -> Self {
        Self { symbol: "1".to_owned(), decade: 0, degrees: 0, dimension: Dimension::NUMBER }
    }

    /// Reads a unit: symbols with powers (`m2`, `m^2`, `m²`, `m-2`) joined by a space, `*`, `·` or `.`, and divided
    /// by `/`. `µ` and `u` are both micro; `Ns`, `Nm`, `Pas` and `Js` need no sign between them; the empty string
    /// and `1` are a pure number.
    ///
    /// # Errors
    ///
    /// [`UnitError`] says which part was not understood. A product after a division (`N/m s`) is refused as
    /// ambiguous; so is a factor to SI beyond 10^100.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let malformed = |reason| UnitError::Malformed { unit: text.to_owned(), reason };
        let symbol = text.trim().to_owned();
        let mut unit = Self { symbol, decade: 0, degrees: 0, dimension: Dimension::NUMBER };
        if unit.symbol.is_empty() {
            return Ok(unit);
        }
        for (place, part) in plain(&unit.symbol.clone()).split('/').enumerate() {
            let mut factors = part.split(['*', '.', ' ']).filter(|factor| !factor.is_empty()).peekable();
            if factors.peek().is_none() {
                return Err(malformed("something is missing beside the \"/\""));
            }
            for (count, factor) in factors.enumerate() {
                if place > 0 && count > 0 {
                    return Err(malformed(
                        "a product after \"/\" can be read in two ways, write it before (\"N s/m\")",
                    ));
                }
                let power = if place == 0 { 1 } else { -1 };
                unit.multiply(factor, power, text)?;
            }
        }
        if unit.decade.abs() > MOST_DECADES {
            return Err(malformed("its factor to SI is beyond 10^100"));
        }
        Ok(unit)
    }

    /// Multiplies by one factor, such as `mm^2`, to the power 1 or -1.
    fn multiply(&mut self, factor: &str, sign: i8, text: &str) -> Result<(), UnitError> {
        let malformed = |reason| UnitError::Malformed { unit: text.to_owned(), reason };
        let end = factor.find(|c: char| c.is_ascii_digit() || "^+-".contains(c)).filter(|end| *end > 0);
        let (name, exponent) = factor.split_at(end.unwrap_or(factor.len()));
        let exponent = exponent.strip_prefix('^').unwrap_or(exponent);
        let power = match exponent {
            "" if name == factor => 1,
            _ => exponent.parse::<i8>().map_err(|_| malformed("a power must be a whole number, as in \"m2\""))?,
        };
        if !(1..=9).contains(&power.unsigned_abs()) {
            return Err(malformed("a power must lie between 1 and 9, or -9 and -1"));
        }
        let found = lookup(name).or_else(|| juxtaposed(name)).ok_or_else(|| UnitError::Unknown {
            unit: text.to_owned(),
            symbol: name.to_owned(),
            nearest: nearest(name),
        })?;
        for (symbol, prefix) in found {
            let too_high = || malformed("its powers are too high");
            self.decade += (symbol.decade + prefix) * i32::from(power * sign);
            self.dimension = self.dimension.times(symbol.dimension, power * sign).ok_or_else(too_high)?;
            if matches!(symbol.name, "deg" | "°") {
                self.degrees = self.degrees.checked_add(power * sign).ok_or_else(too_high)?;
            }
        }
        Ok(())
    }

    /// The symbol as typed, without the spaces around it.
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// What kind of quantity it measures.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Whether values in one unit can be turned into the other: the same dimension.
    pub fn compatible(&self, other: &Self) -> bool {
        self.dimension == other.dimension
    }

    /// A value in this unit, in SI: the `f64` nearest to the decimal number typed, with its decimal point shifted;
    /// degrees are then within 1 ulp. Overflows to infinity. Some 0.2 us, so not for inner loops.
    pub fn to_si(&self, value: f64) -> f64 {
        shift(value, self.decade) * 1f64.to_radians().powi(self.degrees.into())
    }

    /// A value in SI, in this unit; `from_si(to_si(x))` is `x` for numbers of up to 15 digits and no
    /// degrees, else to within 2 ulp.
    pub fn from_si(&self, value: f64) -> f64 {
        shift(value / 1f64.to_radians().powi(self.degrees.into()), -self.decade)
    }
}

/// `value * 10^decade`, `value` standing for the shortest decimal number that is read as it.
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

/// The unit with its typographical characters in plain ones, powers as digits and `^`.
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
            // The sign of the ohm is the Greek letter.
            '\u{2126}' => '\u{3a9}',
            other => other,
        })
        .collect()
}

fn lookup(name: &str) -> Option<Vec<(&'static Symbol, i32)>> {
    spellings().find(|(spelling, ..)| spelling == name).map(|(_, symbol, prefix)| vec![(symbol, prefix)])
}

/// Two symbols without a sign between them, as in `Ns/m`; only after `N`, `Pa` and `J`, where nothing else is meant.
fn juxtaposed(name: &str) -> Option<Vec<(&'static Symbol, i32)>> {
    spellings().filter(|(_, symbol, _)| matches!(symbol.name, "N" | "Pa" | "J")).find_map(
        |(spelling, symbol, prefix)| {
            let rest = name.strip_prefix(spelling.as_str())?;
            let mut second = lookup(rest).filter(|found| matches!(found[0].0.name, "m" | "s"))?;
            second.insert(0, (symbol, prefix));
            Some(second)
        },
    )
}

/// The known spelling at most one edit away, a different case counting least.
fn nearest(name: &str) -> Option<String> {
    let distance = |spelling: &str| {
        let exact = strsim::damerau_levenshtein(name, spelling);
        let folded = strsim::damerau_levenshtein(&name.to_lowercase(), &spelling.to_lowercase());
        (folded, exact)
    };
    let all = spellings().map(|(spelling, ..)| spelling).filter(|spelling| spelling.chars().count() > 1);
    all.map(|spelling| (distance(&spelling), spelling))
        .filter(|((folded, _), _)| *folded <= 1)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, spelling)| spelling)
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.symbol)
    }
}

impl TryFrom<String> for Unit {
    type Error = UnitError;

    fn try_from(text: String) -> Result<Self, UnitError> {
        Self::parse(&text)
    }
}

impl From<Unit> for String {
    fn from(unit: Unit) -> Self {
        unit.symbol
    }
}

#[cfg(test)]
mod tests;
