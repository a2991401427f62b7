//! A level of a factor that the rows of a design have hardly met.

use thiserror::Error;

/// Pairs of levels of different factors that the rows A, B, A_B and B_A of a base point show.
pub(crate) const PAIRS_OF_POINT: u64 = 4;

/// A level of a factor that rows hardly met, or two that they hardly met together.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{factor}: {level} (probability {probability:.2e}) is in {} of the {values} {} drawn, so that its effect on the \
     output is not known, and the indices may be anything: some {:.0} base samples meet it once, and {:.0} ten times",
    if *draws == 0 { "none".to_owned() } else { draws.to_string() },
    if partner.is_some() { "pairs" } else { "values" },
    self.base_samples(1.0),
    self.base_samples(10.0)
)]
#[non_exhaustive]
pub struct RareLevel {
    /// The number of the factor.
    pub number: usize,
    /// The factor.
    pub factor: String,
    /// The number of the other factor, of two levels.
    pub partner: Option<usize>,
    /// The level: a value, a label, or a range; of two, both.
    pub level: String,
    /// Its probability.
    pub probability: f64,
    /// How many of the values of the factor in A and B are this level; of two, how many pairs are in the mean.
    pub draws: u64,
    /// How many values or pairs there are.
    pub values: u64,
}

impl RareLevel {
    /// Whether so few rows have it, or none, that surrogates cannot know of it.
    pub fn is_missed(&self) -> bool {
        self.draws < 3 || self.partner.is_some()
    }

    /// Base samples with which the level is drawn that often in the mean.
    pub fn base_samples(&self, draws: f64) -> f64 {
        draws / (if self.partner.is_some() { PAIRS_OF_POINT as f64 } else { 2.0 } * self.probability)
    }
}
