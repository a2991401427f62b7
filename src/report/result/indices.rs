//! Indices in the result file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::uncertainty::Estimate;
#[doc(hidden)]
pub use crate::uncertainty::Interval as IntervalRecord;

/// An estimate with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct EstimateRecord {
    /// The estimate.
    pub estimate: f64,
    /// Lower bound; `null` with a single replicate.
    pub low: Option<f64>,
    /// Upper bound; `null` with a single replicate.
    pub high: Option<f64>,
}

/// An estimate with the bounds of its interval.
pub(in crate::report) fn estimate_record(Estimate { estimate, interval }: Estimate) -> EstimateRecord {
    EstimateRecord { estimate, low: interval.map(|i| i.low), high: interval.map(|i| i.high) }
}

/// The indices of one factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct IndexRecord {
    /// The factor.
    pub factor: String,
    /// The indices.
    #[serde(flatten)]
    pub effect: EffectRecord,
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
    pub effect: EffectRecord,
}

/// First-order and total index, and what they are of the sum over all factors (or groups) in percent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct EffectRecord {
    /// First-order index.
    pub first_order: EstimateRecord,
    /// Total index.
    pub total: EstimateRecord,
    /// 100 S_i / sum S_j; `null` where the sum is not positive.
    pub share_first_order: Option<f64>,
    /// 100 ST_i / sum ST_j.
    pub share_total: Option<f64>,
    /// Interval of `share_first_order`.
    pub share_first_order_interval: Option<IntervalRecord>,
    /// Interval of `share_total`.
    pub share_total_interval: Option<IntervalRecord>,
    /// Total minus first-order index: what the factor does together with others.
    #[serde(default)]
    pub interaction: Option<EstimateRecord>,
    /// Probability that its total index is the largest of all factors'; `null` for groups and subsets.
    #[serde(default)]
    pub probability_first: Option<f64>,
    /// Probability that its total index exceeds the threshold in `provenance`.
    #[serde(default)]
    pub probability_above_threshold: Option<f64>,
    /// Shapley effect of a factor, if asked for: its share of the variance, dependent on others or not; those of all factors sum to 1.
    /// Those of groups stand in `shapley_groups` of the output.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapley: Option<EstimateRecord>,
    /// Where factors depend on each other: what there is beside. The first-order index is then Var E(Y | X)/V with all that the
    /// factor tells of others, the total index E Var(Y | all others)/V without what others tell of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dependent: Option<DependentRecord>,
}

/// Indices of a factor that depends on others, or has others beside it that do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct DependentRecord {
    /// First-order index of what the factor has on its own, given all others.
    pub independent_first_order: EstimateRecord,
    /// Total index of the factor with all that it tells of others.
    pub full_total: EstimateRecord,
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
    pub shapley: EstimateRecord,
}

impl EffectRecord {
    /// What factors are ranked by: where they depend on each other the Shapley effect, if there is one; else the total index.
    pub fn weight(&self) -> EstimateRecord {
        self.shapley.filter(|_| self.dependent.is_some()).unwrap_or(self.total)
    }
}

/// The joint indices of a subset of the factors that the study lists.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct SubsetRecord {
    /// Its factors.
    pub factors: Vec<String>,
    /// The indices: the first-order one is closed, so it includes interactions inside the subset.
    #[serde(flatten)]
    pub effect: EffectRecord,
}

/// The second-order index of two factors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct PairRecord {
    /// The two factors.
    pub factors: [String; 2],
    /// Their second-order index: what they do together beyond what each does alone.
    pub index: EstimateRecord,
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

/// Indices of one factor, group or subset by an estimator besides the default ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[doc(hidden)]
pub struct OtherIndexRecord {
    /// The factor, the group, or the factors of the subset joined by " + ".
    pub name: String,
    /// First-order index; `null` if the estimator has none.
    pub first_order: Option<EstimateRecord>,
    /// Total index; `null` if the estimator has none.
    pub total: Option<EstimateRecord>,
}
