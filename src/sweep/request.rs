//! What a sweep is asked for: factors with the values they take.

use thiserror::Error;

use crate::quantity::{Quantity, UnitError};
use crate::run::Halt;
use crate::space::{Distribution, Factor, Space};
use crate::study::nearest;

/// Where a sweep ends on a side on which the factor's distribution is unbounded: this quantile, or 1 minus it.
pub const TAIL: f64 = 1e-3;
/// Most values of one factor.
pub const MAX_POINTS: usize = 100_000;

/// A factor with the values it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct FactorValues {
    /// The number of the factor in its space.
    pub factor: usize,
    /// Its values, in its unit.
    pub values: Vec<f64>,
}

/// What a sweep is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRequest {
    /// The factors to sweep, each by itself, with every other factor at its nominal value.
    pub factors: Vec<FactorValues>,
    /// A factor for whose values each sweep is repeated, which gives a family of curves. Its own sweep stays single.
    pub against: Option<FactorValues>,
}

/// What is wrong with the request for a sweep, or why there is none.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SweepError {
    /// The model gave up, or the sweep was asked to end.
    #[error(transparent)]
    Halted(#[from] Halt),
    /// There is no such factor.
    #[error(
        "the study has no factor `{name}`{}: its factors are {}",
        nearest.as_ref().map_or_else(String::new, |n| format!(" (did you mean `{n}`?)")),
        known.join(", ")
    )]
    UnknownFactor {
        /// The name given.
        name: String,
        /// The nearest factor.
        nearest: Option<String>,
        /// All factors of the study.
        known: Vec<String>,
    },
    /// A factor asked for twice.
    #[error("factor `{name}` is asked for twice")]
    Repeated {
        /// Its name.
        name: String,
    },
    /// Values are expected and missing.
    #[error("expected NAME=VALUES, as in {example}")]
    NoValues {
        /// A request that would be right.
        example: String,
    },
    /// A value that cannot be read.
    #[error(transparent)]
    Value(#[from] UnitError),
    /// A value without its unit.
    #[error("`{value}` needs a unit, as in {example}: factor `{name}` is {dimension}")]
    MissingUnit {
        /// The value as typed.
        value: String,
        /// The factor.
        name: String,
        /// What kind of quantity the factor is.
        dimension: String,
        /// A request that would be right.
        example: String,
    },
    /// A value in a unit of another kind.
    #[error("`{value}` is {found}, but factor `{name}` is {dimension}, as in {example}")]
    WrongUnit {
        /// The value as typed.
        value: String,
        /// What kind of quantity it is.
        found: String,
        /// The factor.
        name: String,
        /// What kind of quantity the factor is.
        dimension: String,
        /// A request that would be right.
        example: String,
    },
    /// A value that is no category of the factor.
    #[error("`{value}` is no category of factor `{name}`: it takes {known}")]
    NoCategory {
        /// The value as typed.
        value: String,
        /// The factor.
        name: String,
        /// The labels of its categories.
        known: String,
    },
    /// A value between whole numbers.
    #[error("{value} is no whole number, but factor `{name}` takes whole numbers only")]
    NotWhole {
        /// The value.
        value: f64,
        /// The factor.
        name: String,
    },
    /// A number of points that makes no sweep.
    #[error("{points} points: a sweep needs from 2 to {MAX_POINTS}")]
    Points {
        /// The number asked for.
        points: usize,
    },
    /// A family of curves of a factor against itself.
    #[error("factor `{name}` cannot be swept against itself: name another factor to sweep")]
    AgainstItself {
        /// Its name.
        name: String,
    },
}

impl SweepRequest {
    /// Checks that no factor is asked for twice, and that a family has another factor to be swept.
    ///
    /// # Errors
    /// [`SweepError::Repeated`] and [`SweepError::AgainstItself`].
    ///
    /// # Panics
    /// If a factor's number is not one of `space`.
    pub fn check(&self, space: &Space) -> Result<(), SweepError> {
        let name = |factor: usize| space.factors()[factor].name.clone();
        for (place, asked) in self.factors.iter().enumerate() {
            if self.factors[..place].iter().any(|other| other.factor == asked.factor) {
                return Err(SweepError::Repeated { name: name(asked.factor) });
            }
        }
        match (&self.against, &self.factors[..]) {
            (Some(against), [only]) if only.factor == against.factor => {
                Err(SweepError::AgainstItself { name: name(against.factor) })
            }
            _ => Ok(()),
        }
    }
}

impl FactorValues {
    /// `points` values over the range of factor number `factor`: from the least to the largest value, or between the
    /// quantiles [`TAIL`] and 1 - [`TAIL`] on an unbounded side; at equal ratios for a log-uniform or log-normal factor,
    /// else at equal distances. A discrete or categorical factor takes each of its values, one of whole numbers each of
    /// them or `points` of them, a constant its only one.
    ///
    /// # Errors
    /// [`SweepError::Points`] for fewer than 2 points or more than [`MAX_POINTS`].
    ///
    /// # Panics
    /// If the space has no factor of that number.
    pub fn over_range(space: &Space, factor: usize, points: usize) -> Result<Self, SweepError> {
        if !(2..=MAX_POINTS).contains(&points) {
            return Err(SweepError::Points { points });
        }
        let distribution = space.factors()[factor].distribution();
        let (low, high) = range(distribution);
        let last = points - 1;
        let between = |i: usize| match i {
            0 => low,
            // At the end itself, whatever the rounding on the way.
            _ if i == last => high,
            _ => {
                let part = i as f64 / last as f64;
                if is_logarithmic(distribution) {
                    libm::exp(libm::log(low) * (1.0 - part) + libm::log(high) * part)
                } else {
                    low * (1.0 - part) + high * part
                }
            }
        };
        let values = match distribution {
            Distribution::Constant(_) => vec![low],
            whole if whole.is_whole() && high - low >= points as f64 => {
                (0..points).map(|i| between(i).round()).collect()
            }
            _ => match distribution.levels() {
                Some(levels) => levels.into_iter().map(|(value, _)| value).collect(),
                None => (0..points).map(between).collect(),
            },
        };
        Ok(Self { factor, values })
    }

    /// Reads `NAME=v1,v2,v3 UNIT`: numbers with their units, where a number without one has that of the next.
    ///
    /// ```
    /// use std::path::Path;
    /// use apportion::sweep::FactorValues;
    /// use apportion::Study;
    ///
    /// let study = Study::parse(include_str!("../../studies/soft-cantilever.toml"), Path::new("s.toml"), &[])?;
    /// let three = FactorValues::parse("thickness=1.5, 2 um, 2500 nm", study.space())?;
    /// assert_eq!((three.factor, three.values), (0, vec![1.5, 2.0, 2.5]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SweepError`] says which value is wrong, and what would be right.
    pub fn parse(text: &str, space: &Space) -> Result<Self, SweepError> {
        let (name, list) = text.split_once('=').unwrap_or((text, ""));
        let number = find(space, name)?;
        let factor = &space.factors()[number];
        if list.trim().is_empty() {
            return Err(SweepError::NoValues { example: example(factor) });
        }
        if let Distribution::Categorical(categories) = factor.distribution() {
            let value = |text: &str| {
                let number = text.parse().ok().filter(|number| categories.label(*number).is_some());
                categories.value_of(text).or(number).ok_or_else(|| SweepError::NoCategory {
                    value: text.to_owned(),
                    name: factor.name.clone(),
                    known: categories.labels().join(", "),
                })
            };
            let values = list.split(',').map(|text| value(text.trim())).collect::<Result<_, _>>()?;
            return Ok(Self { factor: number, values });
        }
        let mut quantities = list.split(',').map(Quantity::parse).collect::<Result<Vec<_>, _>>()?;
        for i in (1..quantities.len()).rev() {
            if quantities[i - 1].unit.symbol().is_empty() {
                quantities[i - 1].unit = quantities[i].unit.clone();
            }
        }
        let values = quantities.iter().map(|quantity| in_unit(quantity, factor)).collect::<Result<Vec<f64>, _>>()?;
        if let (true, Some(value)) = (factor.distribution().is_whole(), values.iter().find(|v| v.fract() != 0.0)) {
            return Err(SweepError::NotWhole { value: *value, name: factor.name.clone() });
        }
        Ok(Self { factor: number, values })
    }
}

/// The number of the factor called `name`.
///
/// # Errors
/// [`SweepError::UnknownFactor`] with the nearest name and all of them.
pub fn find(space: &Space, name: &str) -> Result<usize, SweepError> {
    let names = || space.factors().iter().map(|factor| factor.name.as_str());
    let name = name.trim();
    names().position(|known| known == name).ok_or_else(|| SweepError::UnknownFactor {
        name: name.to_owned(),
        nearest: nearest(name, names()),
        known: names().map(str::to_owned).collect(),
    })
}

/// Whether a factor's values are better spaced by ratio.
pub fn is_logarithmic(distribution: &Distribution) -> bool {
    matches!(distribution, Distribution::LogUniform(_) | Distribution::LogNormal(_))
}

/// The range that a sweep covers.
pub(super) fn range(distribution: &Distribution) -> (f64, f64) {
    let (low, high) = distribution.support();
    let is_open = matches!(distribution, Distribution::LogNormal(_));
    // The logarithm of a log-normal factor is unbounded below: its least value, 0, is none.
    let low = if low.is_finite() && !is_open { low } else { distribution.quantile(TAIL) };
    (low, if high.is_finite() { high } else { distribution.quantile(1.0 - TAIL) })
}

fn in_unit(quantity: &Quantity, factor: &Factor) -> Result<f64, SweepError> {
    let unit = factor.unit();
    let (name, dimension) = (factor.name.clone(), unit.dimension().to_string());
    if quantity.unit == *unit {
        Ok(quantity.value)
    } else if quantity.unit.compatible(unit) {
        Ok(unit.from_si(quantity.to_si()))
    } else if quantity.unit.symbol().is_empty() {
        Err(SweepError::MissingUnit { value: quantity.to_string(), name, dimension, example: example(factor) })
    } else {
        let (value, found) = (quantity.to_string(), quantity.unit.dimension().to_string());
        Err(SweepError::WrongUnit { value, found, name, dimension, example: example(factor) })
    }
}

fn example(factor: &Factor) -> String {
    if let Some(labels) = factor.distribution().labels() {
        return format!("\"{}={}\"", factor.name, labels.join(","));
    }
    let (low, high) = range(factor.distribution());
    let unit = match factor.unit().symbol() {
        "" | "1" => String::new(),
        symbol => format!(" {symbol}"),
    };
    format!("\"{}={low},{high}{unit}\"", factor.name)
}
