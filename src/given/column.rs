//! Columns of a table, and an output prepared for sums.

use std::fmt;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use apportion_base::sum;
use apportion_base::text::cut;

/// A named column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its header.
    pub name: String,
    /// Its values, one per row, finite.
    pub values: Vec<f64>,
}

/// Why there are no indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NoVariance {
    /// All values are equal.
    #[error("the output is constant")]
    Constant,
    /// The values differ by rounding errors only.
    #[error("the output varies by less than the rounding errors of its values")]
    Rounding,
}

/// Values whose spread is below this many units in the last place of the largest one are taken for rounding errors.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Returns the values minus their mean, times a power of two that makes the largest about 1: their squares neither
/// overflow nor underflow, and no digit is lost.
///
/// # Errors
/// [`NoVariance`] if only zeros or rounding errors remain.
pub(crate) fn centred(values: &[f64]) -> Result<Vec<f64>, NoVariance> {
    if values.windows(2).all(|pair| pair[0] == pair[1]) {
        return Err(NoVariance::Constant);
    }
    let (scaled, _) = sum::rescaled(values);
    let mean = sum::mean(&scaled);
    let centred: Vec<f64> = scaled.iter().map(|v| v - mean).collect();
    let spread = centred.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // The largest of `scaled` lies between 1 and 2.
    if spread < ROUNDING { Err(NoVariance::Rounding) } else { Ok(sum::rescaled(&centred).0) }
}

#[cfg(test)]
#[path = "tests/column.rs"]
mod tests;

/// A column that cannot be an input because its cells are not numbers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextColumn {
    /// Its name.
    pub name: String,
    /// Its first cell that is not a number, among those examined; `null` if the file states that there are none.
    pub example: Option<String>,
}

impl TextColumn {
    /// How to turn a table with text into one of numbers.
    pub const REMEDY: &str = "write numbers with a point (1.5, not 1,5), their unit into the name of the column, and a number in the \
                              place of each word";

    /// Returns why it cannot be an input.
    pub fn reason(&self) -> String {
        let example = self.example.as_ref().map_or_else(String::new, |cell| format!(" ({})", cut(cell, 24)));
        format!("the column `{}` holds text{example}", self.name)
    }
}

impl fmt::Display for TextColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (reason, remedy) = (self.reason(), Self::REMEDY);
        write!(f, "{reason}, and was left out: the indices are those of the other inputs alone; {remedy}")
    }
}
