//! Indices of one output with the intervals that its replicates give.

use super::{Estimate, jackknife};
use crate::estimate::{Indices, Moments, Undefined, shares};

/// Indices of one output, each with its interval. Lists follow the swaps of the design: the factors first, then the
/// groups.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplicatedIndices {
    /// First-order indices of the factors.
    pub factors: Vec<EffectEstimates>,
    /// Closed first-order and total indices of the groups.
    pub groups: Vec<EffectEstimates>,
    /// Sum of the first-order indices of the factors: 1 for an additive output, less where factors interact.
    pub sum_first_order: Estimate,
    /// Sum of the total indices of the factors: 1 for an additive output, more where factors interact.
    pub sum_total: Estimate,
}

/// The indices of one factor or group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectEstimates {
    /// First-order index (of a group: closed first-order index).
    pub first_order: Estimate,
    /// Total index.
    pub total: Estimate,
    /// 100 S_i / sum S_j over the factors (of a group: over the groups); `None` where the sum is not positive.
    pub share_first_order: Option<Estimate>,
    /// 100 ST_i / sum ST_j, likewise.
    pub share_total: Option<Estimate>,
    /// First-order index minus its check by Janon and Monod's formula: 0 within the interval if all is well.
    pub check_gap: Estimate,
}

/// Mean and variance of one output, each with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplicatedMoments {
    /// Mean over the rows A and B.
    pub mean: Estimate,
    /// Variance over the rows A and B.
    pub variance: Estimate,
}

/// Mean and variance of one output from the moments of its replicates; `None` without any base point.
pub fn replicated_moments(replicates: &[Moments]) -> Option<ReplicatedMoments> {
    let quantities = |m: &Moments| vec![m.mean(), m.variance()];
    let whole = merged(replicates.iter());
    if whole.count() == 0 {
        return None;
    }
    let estimates = with_intervals(replicates, &quantities(&whole), &|m| (m.count() > 0).then(|| quantities(m)));
    Some(ReplicatedMoments { mean: estimates[0], variance: estimates[1] })
}

/// Indices of one output from the moments of its replicates; the first `factors` swaps are the factors.
///
/// # Errors
/// [`Undefined`] if the replicates together give no indices.
pub fn replicated_indices(replicates: &[Moments], factors: usize) -> Result<ReplicatedIndices, Undefined> {
    let whole = quantities(&Indices::of(&merged(replicates.iter()))?, factors);
    let without = |m: &Moments| Indices::of(m).ok().map(|indices| quantities(&indices, factors));
    let estimates = with_intervals(replicates, &whole, &without);
    let (sums, effects) = estimates.split_at(2);
    let mut effects: Vec<EffectEstimates> = effects.chunks_exact(PER_EFFECT).map(EffectEstimates::from_list).collect();
    let groups = effects.split_off(factors);
    Ok(ReplicatedIndices { factors: effects, groups, sum_first_order: sums[0], sum_total: sums[1] })
}

/// Quantities of one factor or group in the flat list that the jackknife works on.
const PER_EFFECT: usize = 5;

/// Everything reported about `indices` in one flat list: the two sums, then each effect. NaN stands for a share that
/// does not exist.
fn quantities(indices: &Indices, factors: usize) -> Vec<f64> {
    let Indices { first_order, total, check } = indices;
    let shares_of = |list: &[f64]| shares(list).unwrap_or_else(|| vec![f64::NAN; list.len()]);
    let both = |list: &[f64]| {
        let (factors, groups) = list.split_at(factors);
        [shares_of(factors), shares_of(groups)].concat()
    };
    let (share_first_order, share_total) = (both(first_order), both(total));
    let mut list = vec![first_order[..factors].iter().sum(), total[..factors].iter().sum()];
    for j in 0..first_order.len() {
        list.extend([first_order[j], total[j], share_first_order[j], share_total[j], first_order[j] - check[j]]);
    }
    list
}

impl EffectEstimates {
    fn from_list(list: &[Estimate]) -> Self {
        let defined = |estimate: Estimate| Some(estimate).filter(|e| e.estimate.is_finite());
        Self {
            first_order: list[0],
            total: list[1],
            share_first_order: defined(list[2]),
            share_total: defined(list[3]),
            check_gap: list[4],
        }
    }
}

/// Jackknife intervals around `whole`; none where leaving out a replicate leaves a quantity undefined.
fn with_intervals(
    replicates: &[Moments],
    whole: &[f64],
    quantities: &dyn Fn(&Moments) -> Option<Vec<f64>>,
) -> Vec<Estimate> {
    // before[r] holds the replicates before r, `after` (from the back) those after it: two passes instead of R.
    let mut before = vec![Moments::default()];
    for moments in replicates {
        let mut sum = before[before.len() - 1].clone();
        sum.merge(moments);
        before.push(sum);
    }
    let mut after = Moments::default();
    let mut without = Vec::with_capacity(replicates.len());
    for (moments, before) in replicates.iter().zip(&before).rev() {
        let mut rest = before.clone();
        rest.merge(&after);
        without.push(quantities(&rest));
        let mut sum = moments.clone();
        sum.merge(&after);
        after = sum;
    }
    let without: Option<Vec<_>> = without.into_iter().rev().collect();
    let mut estimates = jackknife(whole, &without.unwrap_or_default());
    for estimate in &mut estimates {
        estimate.interval = estimate.interval.filter(|i| i.low.is_finite() && i.high.is_finite());
    }
    estimates
}

fn merged<'a>(replicates: impl Iterator<Item = &'a Moments>) -> Moments {
    replicates.fold(Moments::default(), |mut sum, moments| {
        sum.merge(moments);
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::{BlockOutputs, Workspace};

    fn replicate(salt: f64) -> Moments {
        let column = |k: f64| (0..64).map(|i| (f64::from(i) * 0.7 + k + salt).sin()).collect::<Vec<f64>>();
        let (a, b) = (column(0.0), column(1.3));
        let ab: Vec<f64> = b.iter().zip(&a).map(|(b, a)| 0.8 * b + 0.1 * a).collect();
        let ab: [&[f64]; 3] = [&ab, &a, &ab];
        Moments::of_block(BlockOutputs { a: &a, b: &b, ab: &ab, ..BlockOutputs::default() }, &mut Workspace::default())
    }

    #[test]
    fn shares_of_factors_and_of_groups_each_sum_to_100() {
        let got = replicated_indices(&[replicate(0.0), replicate(0.4), replicate(2.0)], 2).unwrap();
        let sum =
            |effects: &[EffectEstimates]| -> f64 { effects.iter().map(|e| e.share_total.unwrap().estimate).sum() };
        assert_eq!((got.factors.len(), got.groups.len()), (2, 1));
        assert!((sum(&got.factors) - 100.0).abs() < 1e-12);
        assert!((sum(&got.groups) - 100.0).abs() < 1e-12);
        let interval = got.factors[0].total.interval.unwrap();
        assert!(interval.low < got.factors[0].total.estimate && got.factors[0].total.estimate < interval.high);
    }

    #[test]
    fn one_replicate_has_estimates_and_no_intervals() {
        let got = replicated_indices(&[replicate(0.0)], 3).unwrap();
        assert!(got.factors.iter().all(|e| e.total.interval.is_none() && e.total.estimate.is_finite()));
    }

    #[test]
    fn empty_replicates_are_named_and_do_not_break_the_rest() {
        assert_eq!(replicated_indices(&[Moments::empty(3)], 3), Err(Undefined::NoRuns));
        assert_eq!(replicated_moments(&[Moments::empty(3)]), None);
        let got = replicated_indices(&[replicate(0.0), Moments::empty(3)], 3).unwrap();
        assert!(got.factors[0].total.interval.is_none());
    }
}
