//! Outputs that are a series: the values of one quantity along an axis, such as time.

use std::ops::Range;

use thiserror::Error;

use super::Output;
use apportion_base::quantity::Unit;

/// Errors in an axis.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SeriesError {
    /// Too few values, or too many.
    #[error("a series has 2 to {} values, not {found}", OutputSeries::MAX_VALUES)]
    Length {
        /// The number of values.
        found: usize,
    },
    /// A position that is not finite, or not above the previous one.
    #[error("the positions of a series are finite numbers in rising order; position {place} is {found}")]
    Position {
        /// Its index, from 0.
        place: usize,
        /// The position.
        found: f64,
    },
}

/// The axis of a series: its name, its unit, and the positions of the values.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesAxis {
    label: String,
    unit: String,
    positions: Vec<f64>,
}

impl SeriesAxis {
    /// Creates an axis called `label`; `positions` are in `unit`, which may be any text, or empty.
    ///
    /// # Errors
    /// [`SeriesError`] unless there are 2 to 10,000 positions, finite and in rising order.
    pub fn new(label: &str, unit: &str, positions: Vec<f64>) -> Result<Self, SeriesError> {
        let found = positions.len();
        if !(2..=OutputSeries::MAX_VALUES).contains(&found) {
            return Err(SeriesError::Length { found });
        }
        let mut before = f64::NEG_INFINITY;
        for (place, &position) in positions.iter().enumerate() {
            if !position.is_finite() || position <= before {
                return Err(SeriesError::Position { place, found: position });
            }
            before = position;
        }
        Ok(Self { label: label.to_owned(), unit: unit.to_owned(), positions })
    }

    /// Creates an axis of `length` positions from `start` on, `step` apart.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn even(label: &str, unit: &str, length: usize, start: f64, step: f64) -> Result<Self, SeriesError> {
        if length > OutputSeries::MAX_VALUES {
            return Err(SeriesError::Length { found: length });
        }
        Self::new(label, unit, (0..length).map(|place| start + step * place as f64).collect())
    }

    /// Returns its name.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Returns the unit of the positions; empty for none.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Returns the positions of the values, in rising order.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }
}

/// Consecutive outputs of a model that are the values of one quantity along an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSeries {
    /// Its name.
    pub name: String,
    /// Index of its first value among the outputs.
    pub first: usize,
    /// The positions of the values.
    pub axis: SeriesAxis,
}

impl OutputSeries {
    /// Maximum number of values of a series: each is an output, with its own sums.
    pub const MAX_VALUES: usize = 10_000;

    /// Returns the list and the index in it for a name such as `infected[12]`.
    pub fn item_of_list(name: &str) -> Option<(&str, usize)> {
        let (list, place) = name.strip_suffix(']')?.rsplit_once('[')?;
        let place = plain_number(place).filter(|_| !list.is_empty())?;
        Some((list, place))
    }

    /// Iterates over the names in a header such as `infected[0..365]`: those of the items from the first index to the
    /// second, exclusive. `None` for any other header, and for more than 10,000 items.
    pub fn items_of_header(header: &str) -> Option<impl Iterator<Item = String> + use<>> {
        let (list, range) = header.strip_suffix(']')?.rsplit_once('[')?;
        let (first, end) = range.split_once("..")?;
        let (first, end) = (plain_number(first)?, plain_number(end)?);
        let items = end.checked_sub(first)?;
        let is_list = !list.is_empty() && (1..=OutputSeries::MAX_VALUES).contains(&items);
        let list = list.to_owned();
        is_list.then(|| (first..end).map(move |place| format!("{list}[{place}]")))
    }

    /// Returns the indices of its values among the outputs.
    pub fn places(&self) -> Range<usize> {
        self.first..self.first + self.axis.positions.len()
    }

    /// Iterates over the names of the values of the series called `name`: `name[0]`, `name[1]` and so on.
    pub fn value_names(name: &str, length: usize) -> impl Iterator<Item = String> {
        (0..length).map(move |place| format!("{name}[{place}]"))
    }

    /// Iterates over its values as outputs in `unit`.
    pub fn outputs(&self, unit: &Unit, description: &'static str) -> impl Iterator<Item = Output> {
        let names = Self::value_names(&self.name, self.axis.positions.len());
        names.map(move |name| Output::new(name, unit.clone(), description))
    }

    /// Returns those of `all` whose values are all in `chosen` and in order, with their places in `chosen`.
    pub fn chosen(all: &[Self], chosen: &[usize]) -> Vec<Self> {
        let series = all.iter().filter_map(|series| {
            let first = chosen.iter().position(|place| *place == series.first)?;
            let values = chosen.get(first..first + series.axis.positions.len())?;
            series.places().eq(values.iter().copied()).then(|| Self { first, ..series.clone() })
        });
        series.collect()
    }
}

/// Reads a number that consists of digits alone.
fn plain_number(digits: &str) -> Option<usize> {
    digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok())?
}

#[cfg(test)]
#[path = "tests/series.rs"]
mod tests;
