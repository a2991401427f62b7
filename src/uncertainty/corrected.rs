//! Replacement of plain indices by corrected ones, if their errors are smaller.

use std::collections::BTreeSet;

use super::estimates::{Layout, Number, Quantity};
use super::influence::Influenced;
use super::net_decay::StandardError;
use super::noise::{Noise, Replacement};
use super::surrogate_use::{ChosenTerms, LowFidelityUse, Refusal, SurrogateTerm, SurrogateUse};
use super::{Estimate, Interval, difference, mean};

/// Distance of plain and corrected indices, relative to their intervals, above which the corrected ones are refused: of
/// one index, and the root mean square over those of one kind. For smooth functions, where the corrected ones are
/// right, the largest in several hundred runs at 16 to 1024 base samples was 6.0, and 2.4 jointly.
const CONTRADICTION: f64 = 10.0;
const JOINT_CONTRADICTION: f64 = 6.0;

/// The same distance above which intervals include both.
const DOUBT: f64 = 3.0;
const JOINT_DOUBT: f64 = 1.5;

/// Maximum ratio of the variance of a factor claimed by surrogates to that over the rows: at most 3.2 for smooth
/// functions at 16 base samples and 1.5 at more; from 6 to many thousand if rows do not represent a factor.
const MAX_GROWTH: f64 = 4.0;

/// Surrogate estimates of an output. Indices are those of all swaps, in the order of the layout.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateEstimates {
    /// First-order indices.
    pub first_order: Vec<Influenced>,
    /// Total indices.
    pub total: Vec<Influenced>,
    /// Second-order indices of the pairs of factors; empty if not requested.
    pub second_order: Vec<Influenced>,
    /// The mean of the output.
    pub mean: Influenced,
    /// Its variance.
    pub variance: Influenced,
    /// Share of the variance that the surrogates explain of the runs to which they were not fitted (Q^2).
    pub explained: f64,
    /// Whether a few rows dominate a residual that matters: intervals then include the plain ones.
    pub is_heavy_tailed: bool,
    /// Whether a level of a factor is rare among the rows: intervals then include the plain ones.
    pub misses_levels: bool,
    /// The largest ratio, for all factors or one that matters, of the claimed variance to that over the rows.
    pub growth: f64,
    /// The terms with the largest variance.
    pub terms: Vec<SurrogateTerm>,
    /// All terms, for runs of some of these rows; `None` for outputs that share theirs.
    pub chosen: Option<ChosenTerms>,
    /// Mean number of terms of the surrogates.
    pub term_count: f64,
    /// The low-fidelity model used with the surrogates, if there is one.
    pub low: Option<LowFidelityUse>,
}

impl SurrogateEstimates {
    /// Returns the sum of the squared errors of all first-order and total indices.
    pub fn squared_error(&self) -> f64 {
        self.squared_errors().iter().sum()
    }

    /// Returns the contributions to it by the rows of the model, and by the runs of a low-fidelity model.
    pub fn squared_errors(&self) -> [f64; 2] {
        let of_kind = |list: &[Influenced], skewed: bool| {
            let noise = Noise::new(&list.iter().map(|of| &of.parts).collect::<Vec<_>>(), skewed);
            let squares = list.iter().map(|of| [noise.error(of), noise.error_of_parts(&of.parts)]);
            squares
                .fold([0.0; 2], |[all, own], [of_all, of_own]| [all + of_all.error.powi(2), own + of_own.error.powi(2)])
        };
        let ([all, own], [more, more_own]) = (of_kind(&self.first_order, false), of_kind(&self.total, true));
        [own + more_own, (all + more - own - more_own).max(0.0)]
    }

    /// Returns a refusal if they claim more variance than the rows show.
    pub fn refusal(&self) -> Option<Refusal> {
        (self.growth > MAX_GROWTH).then_some(Refusal::Growth { times: self.growth })
    }

    /// Returns the replacements of the `plain` numbers of `layout` with their `errors` and places, except for `settled`
    /// swaps; and the use of the surrogates.
    pub(super) fn corrections(
        &self,
        layout: &Layout,
        plain: &[Estimate],
        errors: &[StandardError],
        settled: &BTreeSet<usize>,
    ) -> (Vec<(usize, Replacement)>, SurrogateUse) {
        let real = layout.swaps() - usize::from(layout.dummy);
        let moving: Vec<usize> = (0..real).filter(|swap| !settled.contains(swap)).collect();
        let place = |swap: usize, number: Number| layout.place(Quantity::Swap(swap, number));
        let kind = |index: Number, list: &[Influenced]| {
            let known = |(swap, of): (usize, &Influenced)| {
                if settled.contains(&swap) { of.settled(plain[place(swap, index)].estimate) } else { of.clone() }
            };
            let list: Vec<Influenced> = list.iter().enumerate().map(known).collect();
            let noise =
                Noise::new(&moving.iter().map(|swap| &list[*swap].parts).collect::<Vec<_>>(), index == Number::Total);
            let plain: f64 = moving.iter().map(|swap| errors[place(*swap, index)].error.powi(2)).sum();
            let prudent = noise.prudent();
            let corrected: f64 = moving.iter().map(|swap| prudent.error(&list[*swap]).error.powi(2)).sum();
            let is_known = !moving.is_empty() && plain.is_finite() && corrected.is_finite();
            (list, noise, is_known.then(|| plain / corrected.max(f64::MIN_POSITIVE)))
        };
        let (first_order, first, gain_first_order) = kind(Number::FirstOrder, &self.first_order);
        let (all_total, total, gain_total) = kind(Number::Total, &self.total);
        let gaps = |number: Number, list: &[Influenced], noise: Noise| -> Vec<f64> {
            moving.iter().map(|&swap| gap(plain[place(swap, number)], noise.estimate(&list[swap]))).collect()
        };
        let gaps = Gaps::new(&[gaps(Number::FirstOrder, &first_order, first), gaps(Number::Total, &all_total, total)]);
        let refusal = self.refusal().or_else(|| gaps.refusal());
        let [corrects_first_order, corrects_total] =
            [gain_first_order, gain_total].map(|gain| refusal.is_none() && gain.is_some_and(|gain| gain > 1.0));
        let mut replacements = Vec::new();
        let mut put = |place: usize, noise: Noise, of: &Influenced| replacements.push((place, noise.replacement(of)));
        if corrects_first_order {
            let places = [Number::FirstOrder, Number::ShareFirstOrder];
            indices(layout, &first_order, settled, places, &mut |place, is_share, of| {
                put(place, if is_share { first.even() } else { first }, of);
            });
            let pairs = layout.pair_list().into_iter().zip(&self.second_order).enumerate();
            for (pair, (_, index)) in pairs.filter(|(_, ((j, k), _))| !settled.contains(j) && !settled.contains(k)) {
                put(layout.place(Quantity::Pair(pair)), first, index);
            }
        }
        if corrects_total {
            let places = [Number::Total, Number::ShareTotal];
            indices(layout, &all_total, settled, places, &mut |place, is_share, of| {
                put(place, if is_share { total.even() } else { total }, of);
            });
        }
        for swap in (0..layout.swaps()).filter(|swap| !settled.contains(swap)) {
            let [plain_first, plain_total] =
                [Number::FirstOrder, Number::Total].map(|number| plain[place(swap, number)]);
            let place = place(swap, Number::Interaction);
            let (of_first, of_total) = (&first_order[swap], &all_total[swap]);
            match (corrects_first_order, corrects_total) {
                (true, true) => {
                    let interaction = Influenced::combined(&[(1.0, of_total), (-1.0, of_first)]);
                    replacements.push((place, total.even().replacement(&interaction)));
                }
                (true, false) => {
                    // Their joint distribution is unknown, except that the errors are of independent kinds.
                    let first = first.estimate(of_first);
                    replacements.push((place, (difference(first, plain_total), errors[place], Vec::new())));
                }
                (false, true) => {
                    let total = total.estimate(of_total);
                    replacements.push((place, (difference(plain_first, total), errors[place], Vec::new())));
                }
                (false, false) => (),
            }
        }
        let kinds = mean::Corrected {
            first_order: corrects_first_order.then_some((&first_order, first)),
            total: corrects_total.then_some((&all_total, total)),
        };
        mean::corrected(layout, &kinds, plain, errors, &mut |place, of| replacements.push((place, of)));
        if self.is_heavy_tailed || self.misses_levels || gaps.is_doubt() {
            for (place, (estimate, error, parts)) in &mut replacements {
                estimate.interval = hull(estimate.interval, plain[*place].interval);
                (*error, *parts) = (errors[*place], Vec::new());
            }
        }
        let plain_of = |number| (0..layout.swaps()).map(|swap| plain[place(swap, number)]).collect();
        let used = SurrogateUse {
            explained: self.explained,
            term_count: self.term_count,
            terms: self.terms.clone(),
            is_heavy_tailed: self.is_heavy_tailed,
            corrects_first_order,
            corrects_total,
            gain_first_order,
            gain_total,
            is_doubted: (corrects_first_order || corrects_total) && gaps.is_doubt(),
            refusal,
            plain_first_order: plain_of(Number::FirstOrder),
            plain_total: plain_of(Number::Total),
            low: self.low.clone(),
        };
        (replacements, used)
    }

    /// Returns the mean and variance with their errors.
    pub(super) fn moments(&self) -> [Replacement; 2] {
        let of = |of: &Influenced, skewed| {
            // In units of the largest influence, so that squares neither underflow nor overflow.
            let influences = of.parts.iter().chain(&of.low).flatten();
            let largest = influences.fold(0.0, |largest: f64, x| largest.max(x.abs()));
            let size = if largest > 0.0 { largest } else { 1.0 };
            let scaled = Influenced::linear(of.estimate / size, &[(1.0 / size, of)]);
            let (estimate, error, _) = Noise::of_moment(&scaled.parts, skewed).replacement(&scaled);
            let interval = estimate.interval.map(|i| Interval { low: i.low * size, high: i.high * size });
            let error = StandardError { error: error.error * size, ..error };
            (Estimate { estimate: of.estimate, interval }, error, of.parts.clone())
        };
        [of(&self.mean, false), of(&self.variance, true)]
    }
}

/// Calls `put` with the indices of one kind: their sum, those of every swap, and the shares of factors and groups,
/// except those of `settled` swaps.
fn indices(
    layout: &Layout,
    list: &[Influenced],
    settled: &BTreeSet<usize>,
    [index, share_of]: [Number; 2],
    put: &mut dyn FnMut(usize, bool, &Influenced),
) {
    let factors = 0..layout.factors;
    let sum_of = if index == Number::Total { Quantity::SumTotal } else { Quantity::SumFirstOrder };
    put(layout.place(sum_of), false, &sum(list[factors.clone()].iter()));
    for (swap, of) in list.iter().enumerate().filter(|(swap, _)| !settled.contains(swap)) {
        put(layout.place(Quantity::Swap(swap, index)), false, of);
    }
    for range in [factors, layout.factors..layout.factors + layout.groups] {
        // The noise of a stochastic model has no share.
        let noise = layout.noise.as_ref().map(|noise| noise.factor);
        let sharing = range.filter(|swap| Some(*swap) != noise);
        let all = sum(sharing.clone().map(|swap| &list[swap]));
        if all.estimate > 0.0 {
            let moving = sharing.filter(|swap| !settled.contains(swap));
            moving.for_each(|swap| put(layout.place(Quantity::Swap(swap, share_of)), true, &share(&list[swap], &all)));
        }
    }
}

/// Distances of plain and corrected indices, relative to both errors.
struct Gaps {
    /// The largest distance of one index.
    largest: f64,
    /// The root mean square distance of the indices of one kind.
    joint: f64,
}

impl Gaps {
    /// Computes them from the distances of each kind.
    fn new(kinds: &[Vec<f64>]) -> Self {
        let joint = |gaps: &Vec<f64>| (gaps.iter().map(|gap| gap * gap).sum::<f64>() / gaps.len().max(1) as f64).sqrt();
        Self {
            largest: kinds.iter().flatten().copied().fold(0.0, f64::max),
            joint: kinds.iter().map(joint).fold(0.0, f64::max),
        }
    }

    /// Returns a refusal if both cannot be true.
    fn refusal(&self) -> Option<Refusal> {
        let is_contradiction = self.largest > CONTRADICTION || self.joint > JOINT_CONTRADICTION;
        is_contradiction.then_some(Refusal::Contradiction { times: self.largest })
    }

    /// Returns whether one of them may be wrong.
    fn is_doubt(&self) -> bool {
        self.largest > DOUBT || self.joint > JOINT_DOUBT
    }
}

/// Returns the distance of two estimates of the same number, relative to their intervals; 0 if one of them has none.
fn gap(plain: Estimate, corrected: Estimate) -> f64 {
    let (lower, upper) = if plain.estimate < corrected.estimate { (plain, corrected) } else { (corrected, plain) };
    let (Some(of_lower), Some(of_upper)) = (lower.interval, upper.interval) else { return 0.0 };
    let allowed = (of_lower.high - lower.estimate) + (upper.estimate - of_upper.low);
    if allowed > 0.0 { (upper.estimate - lower.estimate) / allowed } else { 0.0 }
}

fn sum<'a>(list: impl Iterator<Item = &'a Influenced>) -> Influenced {
    Influenced::combined(&list.map(|of| (1.0, of)).collect::<Vec<_>>())
}

/// Returns 100 part/all.
fn share(part: &Influenced, all: &Influenced) -> Influenced {
    let percent = 100.0 * part.estimate / all.estimate;
    Influenced::linear(percent, &[(100.0 / all.estimate, part), (-percent / all.estimate, all)])
}

/// Returns the interval that contains both, or `None` if one of them is unknown.
pub(super) fn hull(a: Option<Interval>, b: Option<Interval>) -> Option<Interval> {
    a.zip(b).map(|(a, b)| Interval { low: a.low.min(b.low), high: a.high.max(b.high) })
}

#[cfg(test)]
mod tests;
