//! Series of outputs in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::PlainIndexRecord;

/// Consecutive outputs that are the values of one quantity along an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct SeriesRecord {
    /// Its name.
    pub name: String,
    /// The unit of its values.
    pub unit: String,
    /// What its axis is called.
    pub axis: String,
    /// The unit of the positions; empty for none.
    pub axis_unit: String,
    /// Place of its first value in `outputs`, from 0; the others follow.
    pub first_output: usize,
    /// Where every value stands on the axis, in rising order.
    pub positions: Vec<f64>,
    /// Indices over all values together, each counted by its variance, one entry per factor; `null` where a value has none.
    pub indices: Option<Vec<PlainIndexRecord>>,
    /// Why there are none.
    pub reason: Option<String>,
}

impl SeriesRecord {
    /// Places of its values in `outputs`.
    pub fn places(&self) -> std::ops::Range<usize> {
        self.first_output..self.first_output + self.positions.len()
    }
}
