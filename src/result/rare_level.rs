//! A level of a factor that is rare among the rows of a design.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Number of pairs of levels of two factors in the rows A, B, A_B and B_A of a base point.
pub(crate) const PAIRS_OF_POINT: u64 = 4;

/// A level of a factor that is rare among the rows, or two that rarely occur together.
#[derive(Debug, Clone, PartialEq, Error, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[error(
    "{factor}: {level} (probability {probability:.2e}) occurs in {} of the {values} {} drawn, so its effect on the \
     output is unknown and the indices may be far off: about {:.0} base samples contain it once, and {:.0} ten times",
    if *draws == 0 { "none".to_owned() } else { draws.to_string() },
    if partner.is_some() { "pairs" } else { "values" },
    self.base_samples(1.0),
    self.base_samples(10.0)
)]
#[non_exhaustive]
pub struct RareLevel {
    /// The index of the factor.
    pub number: usize,
    /// The factor.
    pub factor: String,
    /// The index of the other factor, for two levels.
    pub partner: Option<usize>,
    /// The level: a value, a label, or a range; for two levels, both.
    pub level: String,
    /// Its probability.
    pub probability: f64,
    /// The number of values of the factor in A and B at this level; for two levels, the expected number of pairs.
    pub draws: u64,
    /// The total number of values or pairs.
    pub values: u64,
}

impl RareLevel {
    /// Returns whether so few rows have it, or none, that surrogates cannot represent it.
    pub fn is_missed(&self) -> bool {
        self.draws < 3 || self.partner.is_some()
    }

    /// Returns the base samples with which the level is expected to be drawn that often.
    pub fn base_samples(&self, draws: f64) -> f64 {
        draws / (if self.partner.is_some() { PAIRS_OF_POINT as f64 } else { 2.0 } * self.probability)
    }
}
