//! The results for one output: indices of factors, groups and subsets, each with its interval.

use serde::{Deserialize, Serialize};

use super::mean::NoiseIndices;
use super::surrogate_use::SurrogateUse;
use super::{Estimate, Interval, largest_half_width};

/// Indices of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputIndices {
    /// Indices of the factors.
    pub factors: Vec<EffectEstimates>,
    /// Closed first-order and total indices of the groups.
    pub groups: Vec<EffectEstimates>,
    /// Closed first-order and total indices of the subsets that the study lists.
    pub subsets: Vec<EffectEstimates>,
    /// Indices of the dummy factor, if requested.
    pub dummy: Option<EffectEstimates>,
    /// Sum of the first-order indices of the factors: 1 for an additive output, less where factors interact.
    pub sum_first_order: Estimate,
    /// Sum of the total indices of the factors: 1 for an additive output, more where factors interact.
    pub sum_total: Estimate,
    /// Second-order indices, in the order of [`Layout::pair_list`](super::Layout::pair_list); empty if not requested.
    pub second_order: Vec<Estimate>,
    /// The use of a surrogate, if there was one.
    pub surrogate: Option<SurrogateUse>,
    /// Indices of the mean over the noise, for a stochastic model.
    pub noise: Option<NoiseIndices>,
    /// Checks of the indices, in the order of [`effects`](Self::effects).
    pub checks: Vec<EffectChecks>,
}

impl OutputIndices {
    /// Iterates over all effects in the order of the swaps: of factors, groups, subsets and the dummy.
    pub fn effects(&self) -> impl Iterator<Item = &EffectEstimates> {
        self.factors.iter().chain(&self.groups).chain(&self.subsets).chain(&self.dummy)
    }

    /// Returns the largest half width of the first-order and total indices of factors, groups and subsets, and of the
    /// Shapley effects; `None` if one of them has no interval.
    pub fn largest_half_width(&self) -> Option<f64> {
        let effects = self.factors.iter().chain(&self.groups).chain(&self.subsets);
        let indices =
            effects.flat_map(|effect| [Some(effect.first_order), Some(effect.total), effect.shapley]).flatten();
        largest_half_width(indices)
    }
}

/// The indices of one factor, group or subset, and their percentages of the sum over all factors (or groups).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "EffectRecord"))]
pub struct EffectEstimates {
    /// First-order index (of several factors: closed first-order index).
    pub first_order: Estimate,
    /// Total index.
    pub total: Estimate,
    /// 100 S_i / sum S_j over the factors (of a group: over the groups); `None` if the sum is not positive.
    pub share_first_order: Option<f64>,
    /// 100 ST_i / sum ST_j, likewise.
    pub share_total: Option<f64>,
    /// Interval of `share_first_order`.
    pub share_first_order_interval: Option<Interval>,
    /// Interval of `share_total`.
    pub share_total_interval: Option<Interval>,
    /// Total minus first-order index, the interaction of the factor with others: not negative, within the interval,
    /// unless an estimate is wrong. `None` for dependent factors.
    #[serde(default)]
    pub interaction: Option<Estimate>,
    /// Probability that the total index (the Shapley effect, if all factors have one) is the largest of all factors';
    /// `None` for other effects than factors, and if errors are unknown or [ranks](super::IntervalOptions::ranks) were
    /// not requested. If several total indices are truly equal, any value is equally likely.
    #[serde(default)]
    pub probability_first: Option<f64>,
    /// Probability that the total index is above the threshold.
    #[serde(default)]
    pub probability_above_threshold: Option<f64>,
    /// Shapley effect of a factor, if requested: its share of the variance, for dependent factors too. Players are the
    /// factors, or the groups and the factors that have none; the effects of all players sum to 1 (Owen 2014; Song,
    /// Nelson and Staum 2016).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapley: Option<Estimate>,
    /// Further indices of a factor, group or subset of dependent factors; `None` if factors are independent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dependent: Option<DependentEstimates>,
}

/// Checks of the indices of one factor, group or subset.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectChecks {
    /// First-order index minus its check by Janon and Monod's formula: 0 within the interval unless one is wrong.
    pub gap: Estimate,
    /// Total minus first-order index; for dependent factors with the full total index.
    pub interaction: Estimate,
    /// Whether the interval of the first-order index was wholly above that of the total index, which is impossible for
    /// true indices: both were then extended until they met.
    pub is_contradictory: bool,
    /// The indices by each of the other requested estimators.
    pub others: Vec<OtherEstimates>,
}

/// Indices of dependent factors in addition to the first-order index Var E(Y | X_i)/V, which includes the dependence of
/// others on X_i, and the total index E Var(Y | all but X_i)/V, which excludes the dependence of X_i on others and so
/// may be smaller (Kucherenko, Tarantola and Annoni 2012, Comput. Phys. Commun. 183, 937-946); these two are those of
/// Mara, Tarantola and Annoni (2015), Environ. Model. Softw. 72, 173-183.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "DependentRecord"))]
pub struct DependentEstimates {
    /// First-order index of the part of the factor that is independent of all others.
    pub independent_first_order: Estimate,
    /// Total index of the factor including the dependence of others on it.
    pub full_total: Estimate,
}

/// Indices by another estimator than the default one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherEstimates {
    /// First-order index, if it estimates one.
    pub first_order: Option<Estimate>,
    /// Total index, if it estimates one.
    pub total: Option<Estimate>,
    /// First-order index minus the default one.
    pub first_order_gap: Option<Estimate>,
    /// Total index minus the default one.
    pub total_gap: Option<Estimate>,
}

/// Mean and variance of one output, each with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputMoments {
    /// Mean over the rows A and B.
    pub mean: Estimate,
    /// Variance over the rows A and B.
    pub variance: Estimate,
}

impl EffectEstimates {
    /// Returns the value that ranks factors: for dependent ones the Shapley effect, if any; else the total index.
    pub fn weight(&self) -> Estimate {
        self.shapley.filter(|_| self.dependent.is_some()).unwrap_or(self.total)
    }

    /// Returns 100 S_i / sum S_j with its interval.
    pub fn first_order_percent(&self) -> Option<Estimate> {
        self.share_first_order.map(|estimate| Estimate { estimate, interval: self.share_first_order_interval })
    }

    /// Returns 100 ST_i / sum ST_j with its interval.
    pub fn total_percent(&self) -> Option<Estimate> {
        self.share_total.map(|estimate| Estimate { estimate, interval: self.share_total_interval })
    }

    /// Returns the indices of dependent factors, from those of a swap that others follow, and of a redrawn one.
    pub(super) fn of_dependent_factors(self, alone: Self) -> Self {
        Self {
            total: alone.total,
            interaction: None,
            probability_above_threshold: alone.probability_above_threshold,
            dependent: Some(DependentEstimates { independent_first_order: alone.first_order, full_total: self.total }),
            ..self
        }
    }
}

impl EffectChecks {
    /// Returns the checks of dependent factors, likewise.
    pub(super) fn of_dependent_factors(self, alone: Self) -> Self {
        let others = self.others.iter().zip(&alone.others).map(|(with_others, alone)| OtherEstimates {
            total: alone.total,
            total_gap: alone.total_gap,
            ..*with_others
        });
        let is_contradictory = self.is_contradictory || alone.is_contradictory;
        Self { is_contradictory, others: others.collect(), ..self }
    }
}
