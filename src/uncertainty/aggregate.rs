//! Indices over several outputs together, with intervals.

use rayon::prelude::*;

use super::Estimate;
use super::concentration::Side;
use super::corrected::{SurrogateEstimates, hull};
use super::estimates::{ErrorKind, Layout};
use super::influence::{Influenced, Influences, LeftOut};
use super::method::IntervalMethod;
use super::noise::Noise;
use super::output::{Judged, agreeing};
use crate::estimate::{Indices, MomentParts, Moments, Scaling, Undefined, aggregated};

/// Aggregated indices of every swap.
#[derive(Debug, Clone, PartialEq)]
pub struct AggregateIndices {
    /// First-order (of several factors: closed first-order) indices.
    pub first_order: Vec<Estimate>,
    /// Total indices.
    pub total: Vec<Estimate>,
}

/// Computes aggregated indices of `outputs`, given the parts of replicates, by the default estimators ([`aggregated`]).
///
/// # Errors
/// [`Undefined`] if all outputs are constant, or one has no indices for another reason.
pub fn aggregate_indices(
    outputs: &[&[&MomentParts]],
    scaling: Scaling,
    method: IntervalMethod,
) -> Result<AggregateIndices, Undefined> {
    let of = |moments: &Moments| {
        Indices::from_moments(moments)
            .map(|Indices { first_order, total, .. }| (moments.variance(), [first_order, total].concat()))
    };
    // Output by output: the sums of all outputs at once, without each part, would fill the memory.
    let all: Vec<LeftOut<_>> = outputs.par_iter().map(|replicates| LeftOut::new(replicates, &of)).collect();
    let whole = aggregated(all.iter().map(|output| &output.whole), scaling)?;
    let largest = |of: &dyn Fn(&LeftOut<_>) -> f64| all.iter().map(of).fold(0.0, f64::max);
    let parts = all.iter().map(|output| output.without.len()).min().unwrap_or(0);
    let points: Vec<f64> = (0..parts).map(|part| largest(&|output| output.points_of_parts[part])).collect();
    let without = (0..parts).map(|part| aggregated(all.iter().map(|output| &output.without[part]), scaling).ok());
    let without: Vec<Option<Vec<f64>>> = without.collect();
    let replicates = outputs.first().ok_or(Undefined::NoRuns)?;
    let influences = Influences::new(replicates, whole, &without, largest(&|output| output.points), &points);
    let kinds = vec![ErrorKind { side: Side::Above, is_pooled: true }; influences.whole.len()];
    let mut first_order = Judged::from_nets(influences, method, &kinds).estimates;
    let total = first_order.split_off(first_order.len() / 2);
    let both = first_order.into_iter().zip(total).map(|(first, total)| agreeing(first, total));
    let (first_order, total) = both.map(|(first, total, _)| (first, total)).unzip();
    Ok(AggregateIndices { first_order, total })
}

impl AggregateIndices {
    /// Returns the indices of all effects, in the order of [`OutputIndices::effects`](super::OutputIndices::effects),
    /// from those of all swaps: the total indices of dependent factors are those of redrawn swaps.
    #[must_use]
    pub fn of_effects(self, layout: &Layout) -> Self {
        let dummy = layout.dummy.then_some(layout.swaps().wrapping_sub(1));
        let listed = || 0..layout.listed();
        let first_order = listed().chain(dummy).map(|swap| self.first_order[swap]);
        let total = listed().map(|swap| layout.redrawn(swap)).chain(dummy).map(|swap| self.total[swap]);
        Self { first_order: first_order.collect(), total: total.collect() }
    }

    /// Replaces these plain indices by those of surrogates of the same outputs where their errors are smaller: the sum
    /// of the numerators over the sum of the variances, each with its influences. The outputs are those that vary;
    /// unless every one of them has a surrogate, the plain ones stay.
    #[must_use]
    pub fn corrected(self, surrogates: &[&SurrogateEstimates]) -> Self {
        if surrogates.iter().any(|of_output| of_output.refusal().is_some()) {
            return self;
        }
        let Some((first_order, total)) = Self::by_surrogates(surrogates) else { return self };
        let is_heavy_tailed = surrogates.iter().any(|of_output| of_output.is_heavy_tailed || of_output.misses_levels);
        let better = |plain: Vec<Estimate>, numbers: &[Influenced], skewed: bool| -> Vec<Estimate> {
            // A factor that changes no row keeps its indices.
            let settled = |plain: &Estimate| plain.interval.is_some_and(|interval| interval.low == interval.high);
            let moving = || plain.iter().zip(numbers).filter(|(plain, _)| !settled(plain));
            let parts: Vec<_> = moving().map(|(_, number)| &number.parts).collect();
            let noise = Noise::new(&parts, skewed);
            let width =
                |estimate: Estimate| estimate.interval.map_or(f64::INFINITY, |interval| interval.width().powi(2));
            let of_plain: f64 = moving().map(|(plain, _)| width(*plain)).sum();
            let of_corrected: f64 = moving().map(|(_, number)| width(noise.estimate(number))).sum();
            if parts.is_empty() || of_corrected >= of_plain {
                return plain;
            }
            let corrected = |(plain, number): (&Estimate, &Influenced)| {
                if settled(plain) {
                    return *plain;
                }
                let found = noise.estimate(number);
                let interval = if is_heavy_tailed { hull(found.interval, plain.interval) } else { found.interval };
                Estimate { interval, ..found }
            };
            plain.iter().zip(numbers).map(corrected).collect()
        };
        Self { first_order: better(self.first_order, &first_order, false), total: better(self.total, &total, true) }
    }

    /// Computes first-order and total indices of all outputs together, each weighted by its variance.
    fn by_surrogates(surrogates: &[&SurrogateEstimates]) -> Option<(Vec<Influenced>, Vec<Influenced>)> {
        let first = surrogates.first()?;
        let shape = |of: &SurrogateEstimates| -> [Vec<usize>; 2] {
            [&of.variance.parts, &of.variance.low].map(|parts| parts.iter().map(Vec::len).collect())
        };
        let swaps = first.total.len();
        let fits = |of: &&SurrogateEstimates| {
            let alike = shape(of) == shape(first) && of.first_order.len() == swaps && of.total.len() == swaps;
            alike && of.variance.estimate > 0.0
        };
        if !surrogates.iter().all(fits) {
            return None;
        }
        // Relative to the largest, as in `aggregated`.
        let largest = surrogates.iter().map(|of| of.variance.estimate).fold(0.0, f64::max);
        let all: f64 = surrogates.iter().map(|of| of.variance.estimate / largest).sum();
        let index = |swap: usize, of: fn(&SurrogateEstimates) -> &[Influenced]| {
            let weight = |output: &SurrogateEstimates| output.variance.estimate / largest / all;
            let estimate: f64 = surrogates.iter().map(|output| weight(output) * of(output)[swap].estimate).sum();
            let terms = surrogates.iter().flat_map(|output| {
                let number = &of(output)[swap];
                [(weight(output), number), ((number.estimate - estimate) / largest / all, &output.variance)]
            });
            Influenced::linear(estimate, &terms.collect::<Vec<_>>())
        };
        let list = |of: fn(&SurrogateEstimates) -> &[Influenced]| (0..swaps).map(|swap| index(swap, of)).collect();
        Some((list(|of| &of.first_order), list(|of| &of.total)))
    }
}
