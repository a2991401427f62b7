//! The noise of a stochastic model in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{EffectRecord, EstimateRecord};

/// The noise of a stochastic model: its indices, which are of the variance of a single run, and those of the mean over it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct NoiseRecord {
    /// The name under which the model gets its seed.
    pub name: String,
    /// Its indices. The total one is the part of the variance of a single run that would be left if all factors were known.
    #[serde(flatten)]
    pub effect: EffectRecord,
    /// The rest of the variance, 1 minus the total index: that of the mean over the noise.
    pub mean_share: EstimateRecord,
    /// Indices of the mean over the noise, of its own variance: of each factor, group and subset without the noise.
    pub of_mean: Vec<MeanIndexRecord>,
}

/// The indices of a factor, group or subset of the mean over the noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct MeanIndexRecord {
    /// The factor, the group, or the factors of the subset joined by " + ".
    pub name: String,
    /// (Closed) first-order index; `null` where the runs show no variance of the mean.
    pub first_order: Option<EstimateRecord>,
    /// Total index; `null` without the joint index with the noise (`mean_totals = true`).
    pub total: Option<EstimateRecord>,
}
