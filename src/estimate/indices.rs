//! The indices of one output by one estimator.

use super::{BaseMoments, FirstOrder, Moments, Total, Undefined};

/// Indices of one output: entry j of each list belongs to swap j of the design.
#[derive(Debug, Clone, PartialEq)]
pub struct Indices {
    /// Closed first-order index of the swapped columns: the first-order index if it is one factor.
    pub first_order: Vec<f64>,
    /// Total index of the swapped columns.
    pub total: Vec<f64>,
    /// First-order index by Janon and Monod's formula, to check the first list; NaN where neither y_B nor y_AB varies,
    /// since it divides by their variance.
    pub check: Vec<f64>,
}

impl Indices {
    /// Computes the indices by the default estimators: Saltelli et al. 2010 (b), centred, and Jansen 1999, over the
    /// variance of the rows of the swap; with rows BA those of Azzini et al. 2021.
    ///
    /// # Errors
    /// [`Undefined`] if there are fewer than two base points or the output has no usable variance.
    pub fn from_moments(moments: &Moments) -> Result<Self, Undefined> {
        if moments.count() < 2 {
            return Err(Undefined::NoRuns);
        }
        if moments.constant() {
            return Err(Undefined::ZeroVariance);
        }
        usable_variance(moments.base())?;
        for swap in (0..moments.swaps()).map(|swap| moments.swap(swap)).filter(|swap| swap.base != *moments.base()) {
            if swap.base.n < 2 {
                return Err(Undefined::NoRuns);
            }
            if swap.base.variance() == 0.0 {
                return Err(Undefined::ZeroVariance);
            }
            usable_variance(&swap.base)?;
        }
        let (swaps, has_ba) = (0..moments.swaps(), moments.has_ba());
        let (first_order, total) = (FirstOrder::default_for(has_ba), Total::default_for(has_ba));
        let indices = Self {
            first_order: swaps.clone().map(|j| first_order.estimate(moments, j)).collect(),
            total: swaps.clone().map(|j| total.estimate(moments, j)).collect(),
            check: swaps.map(|j| FirstOrder::JanonMonod2014.estimate(moments, j)).collect(),
        };
        let Self { first_order, total, .. } = &indices;
        if first_order.iter().chain(total).all(|index| index.is_finite()) {
            Ok(indices)
        } else {
            Err(Undefined::Unrepresentable)
        }
    }
}

/// Returns the variance, if it can be represented and exceeds rounding errors.
fn usable_variance(base: &BaseMoments) -> Result<f64, Undefined> {
    let variance = base.variance();
    if !variance.is_normal() {
        return Err(Undefined::Unrepresentable);
    }
    // A spread of a few units in the last place of the mean is rounding, not variation. This is relative: an output of
    // 1e-30 with a spread of 1e-31 passes like one of 1 with a spread of 0.1.
    let rounding = 4.0 * f64::EPSILON * base.mean().abs();
    if variance.sqrt() <= rounding {
        return Err(Undefined::BelowRounding);
    }
    Ok(variance)
}

#[cfg(test)]
#[path = "tests/indices.rs"]
mod tests;
