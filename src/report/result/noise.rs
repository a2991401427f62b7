//! The noise of a stochastic model in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::OtherIndexRecord;
use crate::uncertainty::{EffectEstimates, Estimate};

/// The noise of a stochastic model: its indices, which are of the variance of a single run, and those of the mean over it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct NoiseRecord {
    /// The name under which the model gets its seed.
    pub name: String,
    /// Its indices. The total one is the part of the variance of a single run that would be left if all factors were known.
    #[serde(flatten)]
    pub effect: EffectEstimates,
    /// The rest of the variance, 1 minus the total index: that of the mean over the noise.
    pub mean_share: Estimate,
    /// Indices of the mean over the noise, of its own variance: of each factor, group and subset without the noise.
    pub of_mean: Vec<OtherIndexRecord>,
}
