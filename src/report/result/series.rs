//! Series of outputs in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{AggregateIndexRecord, EstimateRecord};

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
    pub indices: Option<Vec<AggregateIndexRecord>>,
    /// Why there are none.
    pub reason: Option<String>,
    /// Its main directions, principal components of its values, the one with the largest share of the variance first; `null`
    /// if there are none.
    pub directions: Option<Vec<DirectionRecord>>,
    /// Why there are none.
    pub no_directions: Option<String>,
}

/// A main direction of a series.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct DirectionRecord {
    /// Its share of the variance of all values together, in percent.
    pub share: f64,
    /// What one standard deviation of the score adds to every value, in the unit of the series.
    pub loadings: Vec<f64>,
    /// Sum of the first-order indices of the score.
    pub sum_first_order: Option<EstimateRecord>,
    /// Indices of the score, one entry per factor; `null` where they are undefined.
    pub indices: Option<Vec<AggregateIndexRecord>>,
    /// Why there are none.
    pub reason: Option<String>,
}

impl SeriesRecord {
    /// Places of its values in `outputs`.
    pub fn places(&self) -> std::ops::Range<usize> {
        self.first_output..self.first_output + self.positions.len()
    }
}
