//! The scatter of an output over its factors in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How an output goes with the factors of the largest total indices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct ScatterRecord {
    /// At most six factors, the largest total index first.
    pub factors: Vec<String>,
    /// At most 400 rows A, the first of every replicate: the values of `factors` in their units, then the output's in its
    /// own. Runs without a value are left out.
    pub points: Vec<Vec<f64>>,
    /// One entry for each of `factors`.
    pub conditional_means: Vec<ConditionalMeansRecord>,
}

/// Means of the output over slices of a factor: an estimate of E[Y | X_i], whose variance is the numerator of the
/// first-order index. They describe the scatter of the kept rows A and B; no index is computed from them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct ConditionalMeansRecord {
    /// The factor.
    pub factor: String,
    /// The median of each slice in the factor's unit, rising: 20 slices of equal probability, or each of the values of a
    /// discrete factor (of at most 50).
    pub x: Vec<f64>,
    /// Mean of the output over the slice in its unit; `null` without values there.
    pub mean: Vec<Option<f64>>,
    /// Mean minus 1.96 standard errors; `null` for fewer than two values.
    pub low: Vec<Option<f64>>,
    /// Mean plus 1.96 standard errors.
    pub high: Vec<Option<f64>>,
}
