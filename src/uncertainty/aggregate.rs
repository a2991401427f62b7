//! Indices over several outputs together, with intervals.

use super::Estimate;
use super::concentration::Side;
use super::influence::{Influences, Outputs};
use super::method::IntervalMethod;
use super::output::{Judged, agreeing};
use crate::design::Companions;
use crate::estimate::{FirstOrder, MomentParts, Moments, Scaling, Total, Undefined, aggregated, merged};

/// Aggregated indices of every swap.
#[derive(Debug, Clone, PartialEq)]
pub struct AggregateIndices {
    /// First-order (of several factors: closed first-order) indices.
    pub first_order: Vec<Estimate>,
    /// Total indices.
    pub total: Vec<Estimate>,
}

/// Aggregated indices of `outputs` by the default estimators ([`aggregated`]).
///
/// # Errors
/// [`Undefined`] if all outputs are constant, or one has no indices for another reason.
pub fn aggregate_indices(
    outputs: Outputs<'_>,
    scaling: Scaling,
    method: IntervalMethod,
) -> Result<AggregateIndices, Undefined> {
    let of = |outputs: &[Moments]| {
        let companions = outputs.first().map_or(Companions::NONE, Moments::companions);
        let outputs: Vec<&Moments> = outputs.iter().collect();
        aggregated(&outputs, FirstOrder::of_rows(companions), Total::of_rows(companions), scaling)
    };
    let whole: Vec<Moments> = outputs
        .iter()
        .map(|replicates| merged(&replicates.iter().map(MomentParts::whole).collect::<Vec<_>>()))
        .collect();
    of(&whole)?;
    let list = |outputs: &[Moments]| of(outputs).ok().map(|indices| [indices.first_order, indices.total].concat());
    let influences = Influences::of(outputs, &list).ok_or(Undefined::NoRuns)?;
    let pooled = vec![true; influences.whole.len()];
    let mut first_order = Judged::of(influences, method, &pooled, &|_| Side::Above).estimates;
    let total = first_order.split_off(first_order.len() / 2);
    let both = first_order.into_iter().zip(total).map(|(first, total)| agreeing(first, total));
    let (first_order, total) = both.map(|(first, total, _)| (first, total)).unzip();
    Ok(AggregateIndices { first_order, total })
}
