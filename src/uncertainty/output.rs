//! Indices of one output with their intervals, probabilities and checks.

use std::collections::BTreeSet;

use super::by_points::{Bounds, ByPoints};
use super::concentration::{Side, interval};
use super::corrected::SurrogateEstimates;
use super::effects::{EffectChecks, EffectEstimates, OtherEstimates, OutputIndices, OutputMoments};
use super::estimates::{ErrorKind, Layout, Number, OtherNumber, Quantity, SwapNoise, quantities};
use super::influence::Influences;
use super::mean::{MeanEstimates, NoiseIndices};
use super::method::IntervalMethod;
use super::net_decay::{PartInfluences, StandardError};
use super::points::KeptPoints;
use super::ranks::{probability_above, probability_first};
use super::surrogate_use::SurrogateUse;
use super::unseen::{Unseen, half_seen, unseen};
use super::{Estimate, Interval, NORMAL_QUANTILE};
use crate::estimate::{Indices, MomentParts, Moments, Undefined, merged};

/// Maximum correlation of the two columns of a factor for which the spread of the nets shows its effect on the indices.
const MAX_CORRELATION: f64 = 0.3;

/// Options for intervals and probabilities.
#[derive(Debug, Clone, Copy)]
pub struct IntervalOptions<'a> {
    /// The kind of interval.
    pub method: IntervalMethod,
    /// The total index above which a factor counts as important.
    pub threshold: f64,
    /// Seed of the draws for the probabilities, and of the resamples of a bootstrap.
    pub seed: u64,
    /// Resamples of a bootstrap.
    pub resamples: usize,
    /// The outputs of every base point, for the methods that [keep](IntervalMethod::keeps_outputs) them. Without these
    /// the methods are approximated by batches.
    pub points: Option<KeptPoints<'a>>,
    /// Whether the probabilities of being first are computed: they take most of the time of a small design.
    pub ranks: bool,
    /// The [correlations](crate::design::Design::column_correlations) of both samples, by swap; empty if irrelevant.
    pub correlations: &'a [f64],
    /// The surrogate estimates of the outputs, which replace the plain estimates where they are more accurate.
    pub surrogate: Option<&'a SurrogateEstimates>,
}

impl<'a> IntervalOptions<'a> {
    fn by_points(&self) -> Option<ByPoints<'a>> {
        let Self { method, seed, resamples, points, .. } = *self;
        points.filter(|_| method.keeps_outputs()).map(|points| ByPoints { method, points, seed, resamples })
    }
}

/// Computes mean and variance of one output from the parts of its replicates; `None` without any base point.
pub fn output_moments(replicates: &[MomentParts], options: &IntervalOptions<'_>) -> Option<OutputMoments> {
    let of = |m: &Moments| (m.count() > 0).then(|| vec![m.mean(), m.variance()]);
    let influences = Influences::from_moments(replicates, &of)?;
    let bounds = options.by_points().map(|by_points| {
        let whole: Vec<Moments> = replicates.iter().map(MomentParts::whole).collect();
        by_points.bounds(merged(&whole).without_swaps(), &influences.whole, &of)
    });
    let judged = match bounds {
        Some(bounds) => Judged::with(influences, bounds),
        // The mean may be missed on both sides, the variance above.
        None => {
            let kinds = [Side::Both, Side::Above].map(|side| ErrorKind { side, is_pooled: true });
            Judged::from_nets(influences, options.method, &kinds)
        }
    };
    let mut estimates = [judged.estimates[0], judged.estimates[1]];
    if let Some(surrogate) =
        options.surrogate.filter(|surrogate| !surrogate.is_heavy_tailed && !surrogate.misses_levels)
    {
        for (place, (estimate, error, _)) in surrogate.moments().into_iter().enumerate() {
            if error.error < judged.errors[place].error {
                estimates[place] = estimate;
            }
        }
    }
    Some(OutputMoments { mean: estimates[0], variance: estimates[1] })
}

/// Computes the indices of one output from the parts of its replicates.
///
/// # Errors
/// [`Undefined`] if the replicates together give no indices.
pub fn output_indices(
    replicates: &[MomentParts],
    layout: &Layout,
    options: &IntervalOptions<'_>,
) -> Result<OutputIndices, Undefined> {
    let whole: Vec<Moments> = replicates.iter().map(MomentParts::whole).collect();
    let whole = merged(&whole);
    Indices::from_moments(&whole)?;
    let influences =
        Influences::from_moments(replicates, &|moments| quantities(layout, moments)).ok_or(Undefined::NoRuns)?;
    let unseen = unseen(layout, &whole, &influences.whole);
    let half_seen: Vec<usize> = (0..layout.swaps()).filter(|&swap| half_seen(&whole, swap)).collect();
    let inert: BTreeSet<usize> = (0..layout.swaps()).filter(|&swap| whole.swap(swap).inert()).collect();
    let mut judged = match options.by_points() {
        Some(by_points) => {
            let bounds = by_points.bounds(whole, &influences.whole, &|moments| quantities(layout, moments));
            Judged::with(influences, bounds)
        }
        None => {
            // Rounding says nothing about the decay of errors.
            let mut kinds = layout.error_kinds();
            for (kind, (unseen, parts)) in kinds.iter_mut().zip(unseen.iter().zip(&influences.parts)) {
                kind.is_pooled &= !unseen.applies(parts);
            }
            Judged::from_nets(influences, options.method, &kinds)
        }
    };
    let allowed = judged.allow_for_unseen(&unseen);
    judged.allow_for_half_seen(layout, &half_seen);
    if !layout.dependent {
        judged.allow_for_correlated(layout, options.correlations);
    }
    // If all rows agree, the plain indices have no noise that a surrogate could reduce.
    let is_settled = |swap: &usize| {
        let mut indices = [Number::FirstOrder, Number::Total].into_iter().map(|number| Quantity::Swap(*swap, number));
        inert.contains(swap) || indices.any(|index| allowed.contains(&layout.place(index)))
    };
    let settled: BTreeSet<usize> = (0..layout.swaps()).filter(is_settled).collect();
    let surrogate = options.surrogate.map(|surrogate| judged.correct(layout, surrogate, &settled));
    let first = if options.ranks { judged.first(layout, options.seed) } else { None };
    let of_swap = |swap: usize| {
        let (mut effect, checks) = judged.effect(layout, swap, options.threshold);
        let noise = layout.noise.as_ref().map(|noise| noise.factor);
        let place = if noise.is_some_and(|noise| noise < swap) { swap - 1 } else { swap };
        let known = first.as_ref().filter(|_| noise != Some(swap) && swap < layout.factors);
        effect.probability_first = known.and_then(|first| first.get(place).copied());
        (effect, checks)
    };
    let mut all: Vec<(EffectEstimates, EffectChecks)> = (0..layout.swaps()).map(of_swap).collect();
    let dummy = if layout.dummy { all.pop() } else { None };
    if layout.dependent {
        let redrawn = all.split_off(layout.listed());
        let both = all.into_iter().zip(redrawn);
        let joined = both.map(|((effect, checks), (effect_alone, checks_alone))| {
            (effect.of_dependent_factors(effect_alone), checks.of_dependent_factors(checks_alone))
        });
        all = joined.collect();
    }
    let (mut effects, mut checks): (Vec<EffectEstimates>, Vec<EffectChecks>) = all.into_iter().unzip();
    let dummy = dummy.map(|(effect, of_dummy)| {
        checks.push(of_dummy);
        effect
    });
    let subsets = effects.split_off(layout.factors + layout.groups);
    for (effect, shapley) in effects.iter_mut().zip(&judged.estimates[layout.place(Quantity::Shapley(0))..]) {
        effect.shapley = Some(*shapley);
    }
    let groups = effects.split_off(layout.factors);
    let [sum_first_order, sum_total, ..] = judged.estimates[..] else { return Err(Undefined::NoRuns) };
    let second_order = judged.estimates[layout.place(Quantity::Pair(0))..layout.place(Quantity::MeanShare)].to_vec();
    let (factors, noise) = (effects, judged.noise(layout));
    Ok(OutputIndices {
        factors,
        groups,
        subsets,
        dummy,
        sum_first_order,
        sum_total,
        second_order,
        surrogate,
        noise,
        checks,
    })
}

/// A list of quantities with all known facts about their errors.
pub(super) struct Judged {
    pub estimates: Vec<Estimate>,
    errors: Vec<StandardError>,
    parts: Vec<PartInfluences>,
}

impl Judged {
    /// Computes errors of these kinds from the nets.
    pub fn from_nets(influences: Influences, method: IntervalMethod, kinds: &[ErrorKind]) -> Self {
        let Influences { whole, parts } = influences;
        let errors = method.errors(&parts, kinds);
        let of_quantity = |(place, &estimate): (usize, &f64)| {
            let interval = interval(estimate, errors[place], &parts[place], kinds[place].side);
            Estimate { estimate, interval }
        };
        let estimates = whole.iter().enumerate().map(of_quantity).collect();
        Self { estimates, errors, parts }
    }

    /// Sets the errors that the rows cannot show for the quantities with equal parts, and those whose nets agree to
    /// rounding; returns their places.
    fn allow_for_unseen(&mut self, unseen: &[Unseen]) -> BTreeSet<usize> {
        let mut allowed = BTreeSet::new();
        for (place, unseen) in unseen.iter().enumerate().filter(|(_, unseen)| unseen.half_width > 0.0) {
            let Estimate { estimate, interval } = &mut self.estimates[place];
            let error = &mut self.errors[place].error;
            let is_equal = unseen.applies(&self.parts[place]) || *error <= unseen.rounding;
            if !(estimate.is_finite() && error.is_finite() && is_equal) {
                continue;
            }
            *interval = Some(Interval::about(*estimate, unseen.half_width));
            *error = unseen.half_width / NORMAL_QUANTILE;
            allowed.insert(place);
        }
        allowed
    }

    /// Replaces the plain estimates by those corrected by the surrogate where their errors are smaller; the indices of
    /// `settled` swaps stay.
    fn correct(&mut self, layout: &Layout, surrogate: &SurrogateEstimates, settled: &BTreeSet<usize>) -> SurrogateUse {
        let (replacements, used) = surrogate.corrections(layout, &self.estimates, &self.errors, settled);
        for (place, (estimate, error, parts)) in replacements {
            self.estimates[place] = estimate;
            self.errors[place] = error;
            if !parts.is_empty() {
                self.parts[place] = parts;
            }
        }
        used
    }

    /// Combines estimates with errors and intervals from elsewhere.
    pub fn with(influences: Influences, bounds: Vec<Bounds>) -> Self {
        let Influences { whole, parts } = influences;
        let (errors, intervals): (Vec<StandardError>, Vec<Option<Interval>>) = bounds.into_iter().unzip();
        let estimates = whole.into_iter().zip(intervals).map(|(estimate, interval)| Estimate { estimate, interval });
        Self { estimates: estimates.collect(), errors, parts }
    }

    /// Bounds the first-order indices of the swaps that are `half_seen` from above only by their total indices, and the
    /// derived quantities accordingly.
    fn allow_for_half_seen(&mut self, layout: &Layout, half_seen: &[usize]) {
        for &swap in half_seen {
            let [first, total, interaction] = [Number::FirstOrder, Number::Total, Number::Interaction]
                .map(|number| layout.place(Quantity::Swap(swap, number)));
            let (Some(total), Some(first)) = (self.estimates[total].interval, &mut self.estimates[first].interval)
            else {
                continue;
            };
            let more = total.high - first.high;
            if more <= 0.0 {
                continue;
            }
            first.high = total.high;
            if let Some(interaction) = &mut self.estimates[interaction].interval {
                interaction.low -= more;
            }
            let sum = layout.place(Quantity::SumFirstOrder);
            if let (Some(sum), true) = (&mut self.estimates[sum].interval, swap < layout.factors) {
                sum.high += more;
            }
        }
    }

    /// Extends the intervals of factors whose columns of the two samples are correlated by r: for an output monotone in
    /// the factor, rows that differ only in it show a part 1 - r, in all nets alike if r is.
    fn allow_for_correlated(&mut self, layout: &Layout, correlations: &[f64]) {
        use Number::{FirstOrder, Interaction, ShareFirstOrder, ShareTotal, Total};
        for (factor, r) in
            correlations.iter().take(layout.factors).enumerate().filter(|(_, r)| r.abs() > MAX_CORRELATION)
        {
            for number in [FirstOrder, Total, ShareFirstOrder, ShareTotal, Interaction] {
                let place = layout.place(Quantity::Swap(factor, number));
                let estimate = self.estimates[place].estimate;
                let full = estimate / (1.0 - r).max(f64::EPSILON);
                if let Some(interval) = &mut self.estimates[place].interval {
                    *interval = Interval { low: interval.low.min(full), high: interval.high.max(full) };
                    let error = &mut self.errors[place].error;
                    *error = error.max((full - estimate).abs() / NORMAL_QUANTILE);
                }
            }
        }
    }

    fn first(&self, layout: &Layout, seed: u64) -> Option<Vec<f64>> {
        // The noise is no factor that could be the first.
        let noise = layout.noise.as_ref().map(|noise| noise.factor);
        let factors = (0..layout.factors).filter(|factor| Some(*factor) != noise);
        let ranked = |factor: usize| match layout.shapley {
            true => Quantity::Shapley(factor),
            false => Quantity::Swap(layout.redrawn(factor), Number::Total),
        };
        let places: Vec<usize> = factors.map(|factor| layout.place(ranked(factor))).collect();
        let estimates: Vec<f64> = places.iter().map(|&place| self.estimates[place].estimate).collect();
        let errors: Vec<StandardError> = places.iter().map(|&place| self.errors[place]).collect();
        let parts: Vec<&PartInfluences> = places.iter().map(|&place| &self.parts[place]).collect();
        probability_first(&estimates, &errors, &parts, seed)
    }

    fn noise(&self, layout: &Layout) -> Option<NoiseIndices> {
        let noise = layout.noise.as_ref()?;
        let of_mean = |(swap, beside): (usize, &SwapNoise)| {
            let [first_order, total] = [Quantity::MeanFirstOrder(swap), Quantity::MeanTotal(swap)]
                .map(|name| defined(self.estimates[layout.place(name)]));
            (*beside != SwapNoise::Holds).then_some(MeanEstimates { first_order, total })
        };
        let of_mean = noise.swaps.iter().enumerate().map(of_mean).collect();
        let mean_share = self.estimates[layout.place(Quantity::MeanShare)];
        Some(NoiseIndices { factor: noise.factor, mean_share, of_mean })
    }

    fn effect(&self, layout: &Layout, swap: usize, threshold: f64) -> (EffectEstimates, EffectChecks) {
        let number = |number| self.estimates[layout.place(Quantity::Swap(swap, number))];
        let [first_order, total, share_first_order, share_total, gap, interaction] = Number::ALL.map(number);
        let (first_order, total, is_contradictory) = agreeing(first_order, total);
        let [share_first_order, share_total] = [share_first_order, share_total].map(defined);
        let total_error = self.errors[layout.place(Quantity::Swap(swap, Number::Total))];
        let others = (0..layout.estimators.len()).map(|estimator| {
            let [first_order, total, first_order_gap, total_gap] = OtherNumber::ALL
                .map(|number| defined(self.estimates[layout.place(Quantity::Other(estimator, swap, number))]));
            OtherEstimates { first_order, total, first_order_gap, total_gap }
        });
        let checks = EffectChecks { gap, interaction, is_contradictory, others: others.collect() };
        let effect = EffectEstimates {
            first_order,
            total,
            share_first_order: share_first_order.map(|share| share.estimate),
            share_total: share_total.map(|share| share.estimate),
            share_first_order_interval: share_first_order.and_then(|share| share.interval?.finite()),
            share_total_interval: share_total.and_then(|share| share.interval?.finite()),
            interaction: Some(interaction),
            probability_first: None,
            probability_above_threshold: probability_above(total, total_error, threshold),
            shapley: None,
            dependent: None,
        };
        (effect, checks)
    }
}

/// Returns the same indices with intervals that can both be true: a first-order index is at most the total index, so an
/// interval wholly above the total's shows that both errors are larger than estimated, at least their distance.
pub(super) fn agreeing(first_order: Estimate, total: Estimate) -> (Estimate, Estimate, bool) {
    match (first_order.interval, total.interval) {
        (Some(first), Some(all)) if first.low > all.high => {
            let first = Interval { low: total.estimate, ..first };
            let all = Interval { high: first_order.estimate, ..all };
            (Estimate { interval: Some(first), ..first_order }, Estimate { interval: Some(all), ..total }, true)
        }
        _ => (first_order, total, false),
    }
}

fn defined(estimate: Estimate) -> Option<Estimate> {
    Some(estimate).filter(|e| e.estimate.is_finite())
}

/// Returns whether an interval excludes 0 by more than its own width: by chance at most 1 in 1000; a 5 % test would
/// raise a false warning in most studies of eight factors.
pub fn differs_clearly(gap: Estimate) -> bool {
    gap.interval.is_some_and(|interval| gap.estimate.abs() > interval.width())
}

#[cfg(test)]
mod tests;
