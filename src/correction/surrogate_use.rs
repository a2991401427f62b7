//! What was made of surrogates: their terms, what they explain, and whether their corrections are used.

use serde::{Deserialize, Serialize};

use crate::surrogate::SurrogateTerm;

/// Why corrected indices are not used.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// They contradict the plain ones of the same rows.
    Contradiction {
        /// Their distance relative to both errors.
        times: f64,
    },
    /// The claimed variance exceeds that over the rows too much.
    Growth {
        /// The variance by the surrogates over that in the rows.
        times: f64,
    },
}

/// The use of a low-fidelity model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "LowUseRecord"))]
#[non_exhaustive]
pub struct LowFidelityUse {
    /// Its name.
    pub name: String,
    /// Regression slope of the output of the expensive model on that of the low-fidelity model, by least squares.
    pub slope: f64,
    /// Share of the variance explained by the low-fidelity model alone, with its slope.
    pub explained: f64,
}

/// The use of a surrogate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurrogateUse {
    /// Share of the variance that the surrogates explain of the runs to which they were not fitted (Q^2).
    pub explained: f64,
    /// Mean number of terms of the surrogates.
    pub term_count: f64,
    /// The terms with the largest variance, in falling order.
    pub terms: Vec<SurrogateTerm>,
    /// Whether a few rows dominate a residual that matters: intervals then include the plain ones.
    pub is_heavy_tailed: bool,
    /// Whether the first-order indices are corrected, not plain.
    pub corrects_first_order: bool,
    /// Whether the total indices are corrected.
    pub corrects_total: bool,
    /// Variance of the plain first-order indices over that of the corrected ones: without the surrogate this many times
    /// the runs would be needed, if errors fell as those of random points do. `None` if one of them is unknown.
    pub gain_first_order: Option<f64>,
    /// The same for the total indices.
    pub gain_total: Option<f64>,
    /// Whether their distance from the plain ones of the same rows is unlikely: intervals then include both.
    pub is_doubted: bool,
    /// Why neither is corrected; `None` if the errors alone decide.
    pub refusal: Option<Refusal>,
    /// The low-fidelity model used with the surrogates, if there is one.
    pub low: Option<LowFidelityUse>,
}

impl SurrogateUse {
    /// Returns whether indices are corrected, of one kind at least.
    pub fn corrects(&self) -> bool {
        self.corrects_first_order || self.corrects_total
    }
}
