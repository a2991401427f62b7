//! What a surrogate did to the indices, in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::OtherIndexRecord;
use crate::uncertainty::{LowFidelityUse, NamedTerm};

/// The surrogates of an output: polynomials fitted to the runs of all replicates but one, which correct the indices of that
/// one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct SurrogateRecord {
    /// Share of the variance that they explain of runs that they were not fitted to, Q^2.
    pub explained: f64,
    /// Terms of each, on average.
    pub terms: f64,
    /// Whether the first-order indices are corrected by them.
    pub corrects_first_order: bool,
    /// Whether the total indices are.
    pub corrects_total: bool,
    /// Variance of the plain first-order indices over that of the corrected ones; `null` if one is unknown.
    pub gain_first_order: Option<f64>,
    /// The same of the total indices.
    pub gain_total: Option<f64>,
    /// The terms that carry most of the variance.
    pub leading_terms: Vec<NamedTerm>,
    /// The plain indices of everything that has indices: factors, groups, subsets, dummy.
    pub plain: Vec<OtherIndexRecord>,
    /// The cheaper model that stands in beside them, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<LowFidelityUse>,
}
