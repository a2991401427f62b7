//! Indices in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::uncertainty::{EffectEstimates, Estimate};

/// The indices of one factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct IndexRecord {
    /// The factor.
    pub factor: String,
    /// The indices.
    #[serde(flatten)]
    pub effect: EffectEstimates,
}

/// First-order and total index of one factor at a stage of a run, or over several outputs together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct PlainIndexRecord {
    /// The factor.
    pub factor: String,
    /// First-order index.
    pub first_order: Estimate,
    /// Total index.
    pub total: Estimate,
}

/// The indices of one group of factors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct GroupRecord {
    /// The group.
    pub group: String,
    /// Its factors.
    pub factors: Vec<String>,
    /// The indices: the first-order one is closed, so it includes interactions inside the group.
    #[serde(flatten)]
    pub effect: EffectEstimates,
}

/// The Shapley effect of a group, or of a factor that has none, where groups share out the variance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct PlayerRecord {
    /// The name of the group, or of the factor.
    pub player: String,
    /// Its factors.
    pub factors: Vec<String>,
    /// Its share of the variance; those of all players sum to 1.
    pub shapley: Estimate,
}

/// The joint indices of a subset of the factors that the study lists.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct SubsetRecord {
    /// Its factors.
    pub factors: Vec<String>,
    /// The indices: the first-order one is closed, so it includes interactions inside the subset.
    #[serde(flatten)]
    pub effect: EffectEstimates,
}

/// The second-order index of two factors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct PairRecord {
    /// The two factors.
    pub factors: [String; 2],
    /// Their second-order index: what they do together beyond what each does alone.
    pub index: Estimate,
}

/// Indices by one estimator besides the default ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct EstimatorRecord {
    /// Its name in study files.
    pub estimator: String,
    /// Source of its first-order formula; `null` if it has none.
    pub first_order_source: Option<String>,
    /// Source of its total formula; `null` if it has none.
    pub total_source: Option<String>,
    /// One entry per factor, then per group, then per subset, in the order of the lists above.
    pub indices: Vec<OtherIndexRecord>,
}

/// Indices of one factor, group or subset besides the default ones, or of the mean over the noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct OtherIndexRecord {
    /// The factor, the group, or the factors of the subset joined by " + ".
    pub name: String,
    /// (Closed) first-order index; `null` if the estimator has none, or the runs show no variance of the mean.
    pub first_order: Option<Estimate>,
    /// Total index; `null` if the estimator has none, or without the joint index with the noise (`mean_totals = true`).
    pub total: Option<Estimate>,
}
