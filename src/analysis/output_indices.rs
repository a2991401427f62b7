//! Indices of one output with their intervals, probabilities and checks.

use crate::correction::{SurrogateEstimates, SurrogateUse, correct};
use crate::effect::{Effect, EffectQuantities, IndexPair, Layout, OfMean, OfPair, Quantities};
use crate::estimate::{Indices, MomentParts, Moments, Undefined, merged, quantities};
use crate::uncertainty::{
    ByPoints, EffectChecks, EffectEstimates, ErrorKind, Estimate, Influences, IntervalMethod, Judgement, KeptPoints,
    OutputMoments, Side, half_seen, largest_half_width, probability_first, unseen,
};

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
    /// Number of draws for the probabilities of being first, which take most of the time of a small design; 0 for none.
    pub draws: usize,
    /// Whether each effect, by its position, has only factors that cannot change the output; empty if none is known to.
    pub unread: &'a [bool],
    /// The surrogate estimates of the outputs, which replace the plain estimates where they are more accurate.
    pub surrogate: Option<&'a SurrogateEstimates>,
}

impl<'a> IntervalOptions<'a> {
    fn by_points(&self) -> Option<ByPoints<'a>> {
        let Self { method, seed, resamples, points, .. } = *self;
        points.filter(|_| method.keeps_outputs()).map(|points| ByPoints { method, points, seed, resamples })
    }
}

/// Indices of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputIndices {
    /// The indices of every effect, in the order of the layout.
    pub effects: Vec<EffectIndices>,
    /// Sums of the indices of the factors: 1 for an additive output; where factors interact, that of the first-order
    /// indices is less, that of the total indices more.
    pub sums: IndexPair<Estimate>,
    /// Second-order indices; empty if not requested.
    pub pairs: Vec<OfPair<Estimate>>,
    /// V(E\[y|x\])/V(y) = 1 - ST of the noise of a stochastic model: the share of the variance of a single run that is
    /// variance of the mean over the noise.
    pub mean_share: Option<Estimate>,
    /// The use of a surrogate, if there was one.
    pub surrogate: Option<SurrogateUse>,
}

/// The indices of one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectIndices {
    /// The effect.
    pub effect: Effect,
    /// Its indices.
    pub estimates: EffectEstimates,
    /// Checks of them.
    pub checks: EffectChecks,
    /// Indices of the mean over the noise, relative to its own variance: the first-order index is `None` if the runs show
    /// no variance of the mean. The indices of the noise itself refer to the variance of a single run.
    pub of_mean: Option<OfMean<Option<Estimate>>>,
    /// The plain indices, if there was a surrogate.
    pub plain: Option<IndexPair<Estimate>>,
}

impl OutputIndices {
    /// Iterates over the factors, and the noise among them.
    pub fn inputs(&self) -> impl Iterator<Item = &EffectIndices> {
        self.effects.iter().filter(|indices| indices.effect.is_input())
    }

    /// Returns the largest half width of the first-order and total indices of factors, groups and subsets, and of the
    /// Shapley effects; `None` if one of them has no interval.
    pub fn largest_half_width(&self) -> Option<f64> {
        let effects = self.effects.iter().filter(|indices| indices.effect != Effect::Dummy);
        largest_half_width(effects.flat_map(|indices| indices.estimates.indices()))
    }

    /// Returns the largest half width of the plain indices where a surrogate corrects them; `None` if one is unknown.
    pub fn plain_half_width(&self) -> Option<f64> {
        let plain = self.effects.iter().filter_map(|indices| indices.plain);
        largest_half_width(plain.flat_map(|plain| [plain.first_order, plain.total]))
    }
}

/// Computes mean and variance of one output from the parts of its replicates; `None` without any base point.
pub fn output_moments(replicates: &[&MomentParts], options: &IntervalOptions<'_>) -> Option<OutputMoments> {
    let list = |m: &Moments| (m.count() > 0).then(|| vec![m.mean(), m.variance()]);
    let of_base: Vec<MomentParts> = replicates.iter().map(|of| of.without_swaps()).collect();
    let of_base: Vec<&MomentParts> = of_base.iter().collect();
    let influences = Influences::from_moments(&of_base, &list)?;
    let judged = match options.by_points() {
        Some(by_points) => {
            let bounds = by_points.bounds(merged_parts(&of_base), &influences.estimates, &list);
            Judgement::with_bounds(influences, bounds)
        }
        // The mean may be missed on both sides, the variance above.
        None => {
            let kinds = [Side::Both, Side::Above].map(|side| ErrorKind { side, is_pooled: true });
            Judgement::from_nets(influences, options.method, &kinds)
        }
    };
    let [mean, variance] = &judged[..] else { return None };
    let corrected = options.surrogate.filter(|of| !of.is_uncertain()).map(SurrogateEstimates::moments);
    Some(match corrected {
        Some(corrected) => OutputMoments {
            mean: more_accurate(mean, &corrected.mean),
            variance: more_accurate(variance, &corrected.variance),
        },
        None => OutputMoments { mean: mean.estimate, variance: variance.estimate },
    })
}

fn more_accurate(plain: &Judgement, corrected: &Judgement) -> Estimate {
    if corrected.error.error < plain.error.error { corrected.estimate } else { plain.estimate }
}

fn merged_parts(replicates: &[&MomentParts]) -> Moments {
    merged(&replicates.iter().map(|of| of.sum()).collect::<Vec<Moments>>())
}

/// Computes the indices of one output from the parts of its replicates.
///
/// # Errors
/// [`Undefined`] if the replicates together give no indices.
pub fn output_indices(
    replicates: &[&MomentParts],
    layout: &Layout,
    options: &IntervalOptions<'_>,
) -> Result<OutputIndices, Undefined> {
    let all = merged_parts(replicates);
    Indices::from_moments(&all)?;
    let mut judged = judged(replicates, &all, layout, options).ok_or(Undefined::NoRuns)?;
    // If all rows agree, the plain indices have no noise that a surrogate could reduce.
    let mut exact = Vec::with_capacity(judged.effects.len());
    for (at, effect) in judged.effects.iter().enumerate() {
        let is_bound = effect.first_order.is_bound || effect.total.is_bound;
        exact.push(is_bound || all.swap(layout.swap(at)).inert());
    }
    let plain: Vec<IndexPair<Estimate>> = judged.effects.iter().map(EffectQuantities::index_estimates).collect();
    let mut used = None;
    if let Some(surrogate) = options.surrogate {
        let (corrected, of_surrogate) = correct(judged, layout, surrogate, &exact);
        judged = corrected;
        if of_surrogate.corrects_total && !of_surrogate.is_doubted && !surrogate.is_uncertain() {
            let rest = surrogate.largest_rest(all.count());
            for (at, effect) in judged.effects.iter_mut().enumerate() {
                if all.swap(layout.swap(at)).inert() {
                    effect.bound(surrogate.effects[at].total.estimate.max(0.0) + rest);
                }
            }
        }
        used = Some(of_surrogate);
    }
    let plain = used.as_ref().map(|_| plain);
    Ok(OutputIndices { surrogate: used, ..of_quantities(judged, plain, options) })
}

/// Returns the indices by their `judged` quantities; `plain` are those without a surrogate, if there was one.
pub(super) fn of_quantities(
    judged: Quantities<Judgement>,
    plain: Option<Vec<IndexPair<Estimate>>>,
    options: &IntervalOptions<'_>,
) -> OutputIndices {
    let probabilities = probabilities_first(&judged, options);
    let mut probabilities = probabilities.into_iter().flatten();
    let mut redrawn = judged.redrawn.iter();
    let mut effects = Vec::with_capacity(judged.effects.len());
    for (at, judgements) in judged.effects.iter().enumerate() {
        let (mut estimates, mut checks) = judgements.estimates(options.threshold);
        if let Some(redrawn) = redrawn.next() {
            let (of_redrawn, checks_of_redrawn) = redrawn.estimates(options.threshold);
            estimates = estimates.of_dependent_factors(of_redrawn);
            checks = checks.of_dependent_factors(checks_of_redrawn);
        }
        if let Effect::Factor(_) = judgements.effect {
            estimates.probability_first = probabilities.next();
        }
        effects.push(EffectIndices {
            effect: judgements.effect,
            estimates,
            checks,
            of_mean: judgements.mean_estimates(),
            plain: plain.as_ref().map(|plain| plain[at]),
        });
    }
    OutputIndices {
        effects,
        sums: judged.sums.map(|sum| sum.estimate),
        pairs: judged
            .pairs
            .into_iter()
            .map(|OfPair { factors, value }| OfPair { factors, value: value.estimate })
            .collect(),
        mean_share: judged.mean_share.map(|share| share.estimate),
        surrogate: None,
    }
}

/// Computes all quantities with the errors that the plain rows show, and bounds on what they cannot show.
fn judged(
    replicates: &[&MomentParts],
    all: &Moments,
    layout: &Layout,
    options: &IntervalOptions<'_>,
) -> Option<Quantities<Judgement>> {
    let list = |moments: &Moments| quantities(layout, moments).map(Quantities::into_list);
    let values = quantities(layout, all)?;
    let influences = Influences::from_moments(replicates, &list)?;
    let unseen = unseen(layout, all, &values, options.unread).into_list();
    let mut judgements = match options.by_points() {
        Some(by_points) => {
            let bounds = by_points.bounds(all.clone(), &influences.estimates, &list);
            Judgement::with_bounds(influences, bounds)
        }
        None => {
            let mut kinds = values.clone().map(|kind, _| ErrorKind::of_kind(kind)).into_list();
            // Rounding says nothing about the decay of errors.
            for (kind, (unseen, parts)) in kinds.iter_mut().zip(unseen.iter().zip(&influences.parts)) {
                kind.is_pooled &= !unseen.applies(parts);
            }
            Judgement::from_nets(influences, options.method, &kinds)
        }
    };
    for (judgement, unseen) in judgements.iter_mut().zip(unseen) {
        judgement.allow_for_unseen(unseen);
    }
    let mut judged = values.zip(judgements).map(|_, (_, judgement)| judgement);
    for (at, effect) in judged.effects.iter().enumerate() {
        if effect.effect.is_input() && all.swap(layout.swap(at)).inert() {
            for (sum, of) in
                [(&mut judged.sums.first_order, &effect.first_order), (&mut judged.sums.total, &effect.total)]
            {
                if let (Some(sum), Some(of)) = (&mut sum.estimate.interval, of.estimate.interval) {
                    sum.high += of.high;
                }
            }
        }
    }
    let half_seen_at = judged.effects.iter_mut().enumerate().filter(|(at, _)| half_seen(all, layout.swap(*at)));
    for (_, effect) in half_seen_at {
        let more = effect.allow_for_half_seen();
        if let (Some(sum), true) = (&mut judged.sums.first_order.estimate.interval, effect.effect.is_input()) {
            sum.high += more;
        }
    }
    for (at, effect) in judged.redrawn.iter_mut().enumerate() {
        if half_seen(all, layout.redrawn_swap(at)) {
            effect.allow_for_half_seen();
        }
    }
    Some(judged)
}

/// Returns for every factor the probability that its Shapley effect, if there are any, or else its total index, is the
/// largest; the noise is no factor that could be.
fn probabilities_first(judged: &Quantities<Judgement>, options: &IntervalOptions<'_>) -> Option<Vec<f64>> {
    let alone = if judged.redrawn.is_empty() { &judged.effects } else { &judged.redrawn };
    let factors = alone.iter().zip(&judged.effects).filter(|(_, effect)| matches!(effect.effect, Effect::Factor(_)));
    let ranked: Vec<&Judgement> =
        factors.map(|(alone, effect)| effect.shapley.as_ref().unwrap_or(&alone.total)).collect();
    probability_first(&ranked, options.seed, options.draws)
}
