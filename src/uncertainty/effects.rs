//! The indices of one effect with their intervals, from its judged quantities.

use serde::{Deserialize, Serialize};

use super::judgement::Judgement;
use super::ranks::probability_above;
use super::{Estimate, Interval};
use crate::effect::{EffectQuantities, IndexPair, OfMean, OtherQuantities};

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
    pub interaction: Option<Estimate>,
    /// Probability that the total index (the Shapley effect, if all factors have one) is the largest of all factors';
    /// `None` for other effects than factors, and if errors are unknown or ranks were not
    /// requested. If several total indices are truly equal, any value is equally likely.
    pub probability_first: Option<f64>,
    /// Probability that the total index is above the threshold.
    pub probability_above_threshold: Option<f64>,
    /// Shapley effect of a factor, if requested: its share of the variance, for dependent factors too. Players are the
    /// factors, or the groups and the factors that have none; the effects of all players sum to 1 (Owen 2014; Song,
    /// Nelson and Staum 2016).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shapley: Option<Estimate>,
    /// Further indices of a factor, group or subset of dependent factors; `None` if factors are independent.
    #[serde(skip_serializing_if = "Option::is_none")]
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
    pub others: Vec<OtherQuantities<Option<Estimate>>>,
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

    /// Iterates over the first-order and the total index, and the Shapley effect if there is one.
    pub(crate) fn indices(&self) -> impl Iterator<Item = Estimate> + use<> {
        [Some(self.first_order), Some(self.total), self.shapley].into_iter().flatten()
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
    pub(crate) fn of_dependent_factors(self, alone: Self) -> Self {
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
    pub(crate) fn of_dependent_factors(self, alone: Self) -> Self {
        let others = self.others.iter().zip(&alone.others).map(|(with_others, alone)| OtherQuantities {
            total: alone.total,
            total_gap: alone.total_gap,
            ..*with_others
        });
        let is_contradictory = self.is_contradictory || alone.is_contradictory;
        Self { is_contradictory, others: others.collect(), ..self }
    }
}

impl EffectQuantities<Judgement> {
    /// Returns the first-order and the total index.
    pub(crate) fn index_estimates(&self) -> IndexPair<Estimate> {
        IndexPair { first_order: self.first_order.estimate, total: self.total.estimate }
    }

    /// Returns the indices of the mean over the noise, if there is one.
    pub(crate) fn mean_estimates(&self) -> Option<OfMean<Option<Estimate>>> {
        let OfMean { first_order, total } = self.of_mean.as_ref()?;
        Some(OfMean { first_order: defined(first_order), total: total.as_ref().map(defined) })
    }

    /// Returns the indices with the probability that the total one is above `threshold`, and their checks.
    pub(crate) fn estimates(&self, threshold: f64) -> (EffectEstimates, EffectChecks) {
        let (first_order, total, is_contradictory) = agreeing(self.first_order.estimate, self.total.estimate);
        let interaction = self.interaction.estimate;
        let share_first_order = defined(&self.shares.first_order);
        let share_total = defined(&self.shares.total);
        let estimates = EffectEstimates {
            first_order,
            total,
            share_first_order: share_first_order.map(|share| share.estimate),
            share_total: share_total.map(|share| share.estimate),
            share_first_order_interval: share_first_order.and_then(|share| share.interval?.finite()),
            share_total_interval: share_total.and_then(|share| share.interval?.finite()),
            interaction: Some(interaction),
            probability_first: None,
            probability_above_threshold: probability_above(total, self.total.error, threshold),
            shapley: self.shapley.as_ref().map(|shapley| shapley.estimate),
            dependent: None,
        };
        let others = self.others.iter().map(|other| OtherQuantities {
            first_order: defined(&other.first_order),
            total: defined(&other.total),
            first_order_gap: defined(&other.first_order_gap),
            total_gap: defined(&other.total_gap),
        });
        let gap = self.check_gap.estimate;
        (estimates, EffectChecks { gap, interaction, is_contradictory, others: others.collect() })
    }
}

/// Returns the same indices with intervals that can both be true: a first-order index is at most the total index, so an
/// interval wholly above the total's shows that both errors are larger than estimated, at least their distance.
pub(crate) fn agreeing(first_order: Estimate, total: Estimate) -> (Estimate, Estimate, bool) {
    match (first_order.interval, total.interval) {
        (Some(first), Some(all)) if first.low > all.high => {
            let first = Interval { low: total.estimate, ..first };
            let all = Interval { high: first_order.estimate, ..all };
            (Estimate { interval: Some(first), ..first_order }, Estimate { interval: Some(all), ..total }, true)
        }
        _ => (first_order, total, false),
    }
}

fn defined(judgement: &Judgement) -> Option<Estimate> {
    Some(judgement.estimate).filter(|e| e.estimate.is_finite())
}

/// Returns whether an interval excludes 0 by more than its own width: by chance at most 1 in 1000; a 5 % test would
/// raise a false warning in most studies of eight factors.
pub(crate) fn differs_clearly(gap: Estimate) -> bool {
    gap.interval.is_some_and(|interval| gap.estimate.abs() > interval.width())
}

#[cfg(test)]
#[path = "tests/effects.rs"]
mod tests;
