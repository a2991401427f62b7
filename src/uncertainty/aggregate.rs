//! Indices over several outputs together, with intervals.

use rayon::prelude::*;

use super::Estimate;
use super::concentration::Side;
use super::estimates::Layout;
use super::influence::{Influences, LeftOut};
use super::method::IntervalMethod;
use super::output::{Judged, agreeing};
use crate::estimate::{FirstOrder, Indices, MomentParts, Moments, Scaling, Total, Undefined, aggregated};

/// Aggregated indices of every swap.
#[derive(Debug, Clone, PartialEq)]
pub struct AggregateIndices {
    /// First-order (of several factors: closed first-order) indices.
    pub first_order: Vec<Estimate>,
    /// Total indices.
    pub total: Vec<Estimate>,
}

impl AggregateIndices {
    /// The indices of all effects, in the order of [`OutputIndices::effects`](super::OutputIndices::effects), from those of all
    /// swaps: the total indices of dependent factors are those of redrawn swaps.
    #[must_use]
    pub fn of_effects(self, layout: &Layout) -> Self {
        let dummy = layout.dummy.then_some(layout.swaps().wrapping_sub(1));
        let listed = || 0..layout.listed();
        let first_order = listed().chain(dummy).map(|swap| self.first_order[swap]);
        let total = listed().map(|swap| layout.redrawn(swap)).chain(dummy).map(|swap| self.total[swap]);
        Self { first_order: first_order.collect(), total: total.collect() }
    }
}

/// Aggregated indices of `outputs`, which have the parts of their replicates, by the default estimators ([`aggregated`]).
///
/// # Errors
/// [`Undefined`] if all outputs are constant, or one has no indices for another reason.
pub fn aggregate_indices(
    outputs: &[&[&MomentParts]],
    scaling: Scaling,
    method: IntervalMethod,
) -> Result<AggregateIndices, Undefined> {
    let of = |moments: &Moments| {
        let companions = moments.companions();
        let indices = Indices::by(moments, FirstOrder::of_rows(companions), Total::of_rows(companions));
        indices.map(|Indices { first_order, total, .. }| (moments.variance(), [first_order, total].concat()))
    };
    // Output by output: the sums of all at once, without each part, would fill the memory.
    let all: Vec<LeftOut<_>> = outputs.par_iter().map(|replicates| LeftOut::of(replicates, &of)).collect();
    let whole = aggregated(all.iter().map(|output| &output.whole), scaling)?;
    let largest = |of: &dyn Fn(&LeftOut<_>) -> f64| all.iter().map(of).fold(0.0, f64::max);
    let parts = all.iter().map(|output| output.without.len()).min().unwrap_or(0);
    let points: Vec<f64> = (0..parts).map(|part| largest(&|output| output.points_of_parts[part])).collect();
    let without = (0..parts).map(|part| aggregated(all.iter().map(|output| &output.without[part]), scaling).ok());
    let without: Vec<Option<Vec<f64>>> = without.collect();
    let replicates = outputs.first().ok_or(Undefined::NoRuns)?;
    let influences = Influences::new(replicates, whole, &without, (largest(&|output| output.points), &points));
    let pooled = vec![true; influences.whole.len()];
    let mut first_order = Judged::of(influences, method, &pooled, &|_| Side::Above).estimates;
    let total = first_order.split_off(first_order.len() / 2);
    let both = first_order.into_iter().zip(total).map(|(first, total)| agreeing(first, total));
    let (first_order, total) = both.map(|(first, total, _)| (first, total)).unzip();
    Ok(AggregateIndices { first_order, total })
}
