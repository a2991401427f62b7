//! Indices over several outputs together, with intervals.

use rayon::prelude::*;

use crate::correction::{CorrectionError, EstimateWithInfluences, SurrogateEstimates, hull};
use crate::effect::{Effect, IndexPair, Layout};
use crate::estimate::{Indices, MomentParts, Moments, Scaling, Undefined, aggregated};
use crate::uncertainty::{
    ErrorKind, Estimate, Influences, Interval, IntervalMethod, Judgement, LeftOut, Side, agreeing,
};

/// The indices of every effect over several outputs together, in the order of the layout.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AggregateIndices {
    pub effects: Vec<Effect>,
    pub indices: Vec<IndexPair<Estimate>>,
}

/// Computes aggregated indices of `outputs`, given the parts of replicates, by the default estimators ([`aggregated`]).
///
/// # Errors
/// [`Undefined`] if all outputs are constant, or one has no indices for another reason.
pub(super) fn aggregate_indices(
    outputs: &[Vec<&MomentParts>],
    layout: &Layout,
    scaling: Scaling,
    method: IntervalMethod,
) -> Result<AggregateIndices, Undefined> {
    // Output by output: the sums of all outputs at once, without each part, would fill the memory.
    let all: Vec<LeftOut<_>> =
        outputs.par_iter().map(|replicates| LeftOut::new(replicates, &variance_and_indices)).collect();
    let estimates = aggregated(all.iter().map(|output| &output.of_all), scaling)?;
    let parts = all.iter().map(|output| output.without.len()).min().unwrap_or(0);
    let points_of_parts: Vec<f64> =
        (0..parts).map(|part| all.iter().map(|output| output.points_of_parts[part]).fold(0.0, f64::max)).collect();
    let points = all.iter().map(|output| output.points).fold(0.0, f64::max);
    let without: Vec<Option<Vec<f64>>> =
        (0..parts).map(|part| aggregated(all.iter().map(|output| &output.without[part]), scaling).ok()).collect();
    let replicates = outputs.first().ok_or(Undefined::NoRuns)?;
    let influences = Influences::new(replicates, estimates, &without, points, &points_of_parts);
    let kinds = vec![ErrorKind { side: Side::Above, is_pooled: true }; influences.estimates.len()];
    let judged = Judgement::from_nets(influences, method, &kinds);
    let (first_order, total) = judged.split_at(judged.len() / 2);
    let both = first_order.iter().zip(total).map(|(first_order, total)| agreeing(first_order.estimate, total.estimate));
    let of_swaps: Vec<IndexPair<Estimate>> =
        both.map(|(first_order, total, _)| IndexPair { first_order, total }).collect();
    // The total indices of dependent factors are those of redrawn swaps.
    let indices = (0..layout.effects.len()).map(|at| IndexPair {
        first_order: of_swaps[layout.swap(at)].first_order,
        total: of_swaps[layout.redrawn_swap(at)].total,
    });
    Ok(AggregateIndices { effects: layout.effects.clone(), indices: indices.collect() })
}

/// Returns the variance of an output, and the first-order indices of all swaps followed by the total ones.
fn variance_and_indices(moments: &Moments) -> Result<(f64, Vec<f64>), Undefined> {
    let Indices { first_order, total, .. } = Indices::from_moments(moments)?;
    Ok((moments.variance(), [first_order, total].concat()))
}

impl AggregateIndices {
    /// Replaces these plain indices by those of surrogates of the same outputs where their errors are smaller: the sum
    /// of the numerators over the sum of the variances, each with its influences. The outputs are those that vary;
    /// unless every one of them has a surrogate, the plain ones stay.
    #[must_use]
    pub fn corrected(mut self, surrogates: &[&SurrogateEstimates], scaling: Scaling) -> Self {
        if surrogates.iter().any(|of_output| of_output.refusal().is_some()) {
            return self;
        }
        let Some(corrected) = by_surrogates(surrogates, scaling) else { return self };
        let is_doubted = surrogates.iter().any(|of_output| of_output.is_heavy_tailed || of_output.misses_levels);
        let first_order: Vec<&EstimateWithInfluences> = corrected.iter().map(|of| &of.first_order).collect();
        let total: Vec<&EstimateWithInfluences> = corrected.iter().map(|of| &of.total).collect();
        let mut plain: Vec<&mut Estimate> = self.indices.iter_mut().map(|of| &mut of.first_order).collect();
        replace(&mut plain, &first_order, false, is_doubted);
        let mut plain: Vec<&mut Estimate> = self.indices.iter_mut().map(|of| &mut of.total).collect();
        replace(&mut plain, &total, true, is_doubted);
        self
    }
}

/// Replaces the `plain` indices of one kind by the `corrected` ones if these have the smaller errors; if they
/// `is_doubted`, the intervals contain both.
fn replace(plain: &mut [&mut Estimate], corrected: &[&EstimateWithInfluences], is_total: bool, is_doubted: bool) {
    // A factor that changes no row keeps its indices.
    let is_moving = |at: &usize| plain[*at].interval.is_none_or(|interval| interval.low != interval.high);
    let moving: Vec<usize> = (0..plain.len()).filter(is_moving).collect();
    let error = CorrectionError::new(moving.iter().map(|at| &corrected[*at].parts), is_total);
    let of_plain: f64 = moving.iter().map(|at| squared_width(*plain[*at])).sum();
    let of_corrected: f64 = moving.iter().map(|at| squared_width(error.estimate(corrected[*at]))).sum();
    if moving.is_empty() || of_corrected >= of_plain {
        return;
    }
    for at in moving {
        let Estimate { estimate, interval } = error.estimate(corrected[at]);
        let interval = if is_doubted { hull(interval, plain[at].interval) } else { interval };
        *plain[at] = Estimate { estimate, interval };
    }
}

fn squared_width(estimate: Estimate) -> f64 {
    estimate.interval.map_or(f64::INFINITY, Interval::width).powi(2)
}

/// Computes first-order and total indices of all outputs together, each weighted by its variance in this scaling.
fn by_surrogates(
    surrogates: &[&SurrogateEstimates],
    scaling: Scaling,
) -> Option<Vec<IndexPair<EstimateWithInfluences>>> {
    let first = surrogates.first()?;
    let effects = first.effects.len();
    let fits = |of: &&SurrogateEstimates| {
        shape(of) == shape(first) && of.effects.len() == effects && of.variance.estimate > 0.0
    };
    if !surrogates.iter().all(fits) {
        return None;
    }
    let together = (0..effects).map(|at| IndexPair {
        first_order: weighted(surrogates, scaling, |of| &of.effects[at].first_order),
        total: weighted(surrogates, scaling, |of| &of.effects[at].total),
    });
    Some(together.collect())
}

/// Returns the numbers of parts of every net.
fn shape(of: &SurrogateEstimates) -> [Vec<usize>; 2] {
    [&of.variance.parts, &of.variance.low].map(|parts| parts.iter().map(Vec::len).collect())
}

/// Returns the mean of the indices `of` each output, weighted by the variances of the outputs, which are 1 if
/// standardised.
fn weighted(
    surrogates: &[&SurrogateEstimates],
    scaling: Scaling,
    of: impl Fn(&SurrogateEstimates) -> &EstimateWithInfluences,
) -> EstimateWithInfluences {
    // Relative to the largest, as in `aggregated`.
    let variance = |of: &&SurrogateEstimates| if scaling == Scaling::Plain { of.variance.estimate } else { 1.0 };
    let largest = surrogates.iter().map(variance).fold(0.0, f64::max);
    let all: f64 = surrogates.iter().map(|of| variance(of) / largest).sum();
    let weights: Vec<f64> = surrogates.iter().map(|of| variance(of) / largest / all).collect();
    let estimate: f64 = surrogates.iter().zip(&weights).map(|(output, weight)| weight * of(output).estimate).sum();
    let mut terms = Vec::with_capacity(2 * surrogates.len());
    for (output, weight) in surrogates.iter().zip(weights) {
        terms.push((weight, of(output)));
        if scaling == Scaling::Plain {
            terms.push(((of(output).estimate - estimate) / largest / all, &output.variance));
        }
    }
    EstimateWithInfluences::linear(estimate, &terms)
}
