//! Indices in the result file, and the use of surrogates.

use serde::{Deserialize, Serialize};

use crate::correction::LowFidelityUse;
use crate::effect::IndexPair;
use crate::surrogate::NamedTerm;
use crate::uncertainty::{EffectEstimates, Estimate};

/// The indices of a factor, a group or a subset, under its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "Named_{T}"))]
pub struct Named<T> {
    /// The factor, the group, or the factors of the subset joined by " + ".
    #[serde(rename = "factor")]
    pub name: String,
    /// The factors of a group or subset; empty (in JSON absent) for a factor, and for a group in place of its factors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub factors: Vec<String>,
    /// The indices; the first-order one of several factors is closed, so it includes their interactions.
    #[serde(flatten)]
    pub effect: T,
}

/// The second-order index of two factors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PairRecord {
    /// The two factors.
    pub factors: [String; 2],
    /// Their second-order index: their joint effect beyond their individual effects.
    pub index: Estimate,
}

/// Indices by one estimator in addition to the default ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EstimatorRecord {
    /// Its name in study files.
    pub estimator: String,
    /// Source of its first-order formula; `null` if it has none.
    pub first_order_source: Option<String>,
    /// Source of its total formula; `null` if it has none.
    pub total_source: Option<String>,
    /// One entry per factor, then per group, then per subset, in the order of the lists above; `null` without a formula.
    pub indices: Vec<Named<IndexPair<Option<Estimate>>>>,
}

/// The noise of a stochastic model: its indices, relative to the variance of a single run, and those of the mean.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseRecord {
    /// The name under which the model receives its seed.
    pub name: String,
    /// Its indices. The total one is the part of the variance of a run that is left if all factors are known.
    #[serde(flatten)]
    pub effect: EffectEstimates,
    /// The rest of the variance, 1 minus the total index: that of the mean over the noise.
    pub mean_share: Estimate,
    /// Indices of the mean over the noise, relative to its own variance: for factors, groups and subsets without it.
    /// First-order ones are `null` if the runs show no variance of the mean, total ones without the joint index with
    /// the noise (`mean_totals = true`).
    pub of_mean: Vec<Named<IndexPair<Option<Estimate>>>>,
}

/// The surrogates of an output: polynomials fitted to all replicates but one, which correct the indices of that one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SurrogateRecord {
    /// Share of the variance that they explain of runs to which they were not fitted, Q^2.
    pub explained: f64,
    /// Mean number of terms of each.
    pub terms: f64,
    /// Whether the first-order indices are corrected by them.
    pub corrects_first_order: bool,
    /// Whether the total indices are corrected by them.
    pub corrects_total: bool,
    /// Variance of the plain first-order indices over that of the corrected ones; `null` if one is unknown.
    pub gain_first_order: Option<f64>,
    /// The same of the total indices.
    pub gain_total: Option<f64>,
    /// The terms with the largest variance.
    pub leading_terms: Vec<NamedTerm>,
    /// The plain indices of everything that has indices: factors, groups, subsets, dummy.
    pub plain: Vec<Named<IndexPair<Option<Estimate>>>>,
    /// The low-fidelity model used with them, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<LowFidelityUse>,
}
