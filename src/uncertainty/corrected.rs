//! Indices corrected by a surrogate in the place of the plain ones, where their errors are smaller.

use super::estimates::Layout;
use super::net_decay::{PartInfluences, StandardError};
use super::noise::Noise;
use super::{Estimate, Interval};

/// A number and what the parts of every net do to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Influenced {
    /// The number.
    pub estimate: f64,
    /// The mean influence of the points of every part, `[net][part]`.
    pub parts: PartInfluences,
}

impl Influenced {
    /// A sum of numbers with weights.
    pub fn combined(list: &[(f64, &Self)]) -> Self {
        let estimate = list.iter().map(|(weight, of)| weight * of.estimate).sum();
        let mut parts: PartInfluences =
            list.first().map_or_else(Vec::new, |(_, of)| of.parts.iter().map(|net| vec![0.0; net.len()]).collect());
        for (weight, of) in list {
            for (sums, more) in parts.iter_mut().zip(&of.parts) {
                sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += weight * more);
            }
        }
        Self { estimate, parts }
    }
}

/// What a surrogate makes of the runs of an output. Indices are those of all swaps, in the order of the layout.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateEstimates {
    /// First-order indices.
    pub first_order: Vec<Influenced>,
    /// Total indices.
    pub total: Vec<Influenced>,
    /// Second-order indices of the pairs of factors; empty if not asked for.
    pub second_order: Vec<Influenced>,
    /// The mean of the output.
    pub mean: Influenced,
    /// Its variance.
    pub variance: Influenced,
    /// Share of the variance that the surrogates explain of the runs that they were not fitted to (Q^2).
    pub explained: f64,
    /// Whether what they leave matters and is carried by a few rows: intervals then hold the plain ones too.
    pub is_heavy_tailed: bool,
    /// The terms that carry most of the variance.
    pub terms: Vec<SurrogateTerm>,
    /// Number of terms, of all surrogates on average.
    pub term_count: f64,
}

/// A term of a surrogate.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateTerm {
    /// The factors in it, by number, each with its degree.
    pub factors: Vec<(usize, usize)>,
    /// Its share of the variance.
    pub share: f64,
}

/// What was made of a surrogate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurrogateUse {
    /// Share of the variance that the surrogates explain of the runs that they were not fitted to (Q^2).
    pub explained: f64,
    /// Number of terms, of all surrogates on average.
    pub term_count: f64,
    /// The terms that carry most of the variance, the first ones first.
    pub terms: Vec<SurrogateTerm>,
    /// Whether what they leave matters and is carried by a few rows: intervals then hold the plain ones too.
    pub is_heavy_tailed: bool,
    /// Whether the first-order indices are corrected ones, and not the plain ones.
    pub corrects_first_order: bool,
    /// Whether the total indices are.
    pub corrects_total: bool,
    /// Variance of the plain first-order indices over that of the corrected ones: as many times the runs would be needed
    /// without the surrogate, if errors fell as those of random points do. `None` if one of them is unknown.
    pub gain_first_order: Option<f64>,
    /// The same for the total indices.
    pub gain_total: Option<f64>,
    /// The plain first-order indices of all swaps.
    pub plain_first_order: Vec<Estimate>,
    /// The plain total indices of all swaps.
    pub plain_total: Vec<Estimate>,
}

/// A number, its interval, its error, and its influences.
pub(super) type Replacement = (Estimate, StandardError, PartInfluences);

/// Places of a list of quantities and what belongs there.
pub(super) struct Corrections {
    pub replacements: Vec<(usize, Replacement)>,
    pub used: SurrogateUse,
}

impl SurrogateEstimates {
    /// What replaces the `plain` numbers of `layout` with the errors `errors`.
    pub(super) fn corrections(&self, layout: &Layout, plain: &[Estimate], errors: &[StandardError]) -> Corrections {
        let real = layout.swaps() - usize::from(layout.dummy);
        let noise = |list: &[Influenced], skewed| {
            Noise::new(&list[..real].iter().map(|index| &index.parts).collect::<Vec<_>>(), skewed)
        };
        let (first, total) = (noise(&self.first_order, false), noise(&self.total, true));
        let gain = |kind: usize, list: &[Influenced], noise: Noise| -> Option<f64> {
            let plain: f64 = (0..real).map(|swap| errors[layout.swap(swap) + kind].error.powi(2)).sum();
            let corrected: f64 = list[..real].iter().map(|index| noise.error(&index.parts).error.powi(2)).sum();
            (plain.is_finite() && corrected.is_finite()).then(|| plain / corrected.max(f64::MIN_POSITIVE))
        };
        let gains = [gain(0, &self.first_order, first), gain(1, &self.total, total)];
        let [corrects_first_order, corrects_total] = gains.map(|gain| gain.is_some_and(|gain| gain > 1.0));
        let mut replacements = Vec::new();
        let mut put = |place: usize, noise: Noise, of: &Influenced| {
            replacements.push((place, replacement(noise, of)));
        };
        let factors = 0..layout.factors;
        if corrects_first_order {
            put(0, first, &sum(&self.first_order[factors.clone()]));
            for (swap, index) in self.first_order.iter().enumerate() {
                put(layout.swap(swap), first, index);
            }
            for (place, index) in self.second_order.iter().enumerate() {
                put(layout.pairs() + place, first, index);
            }
        }
        if corrects_total {
            put(1, total, &sum(&self.total[factors]));
            for (swap, index) in self.total.iter().enumerate() {
                put(layout.swap(swap) + 1, total, index);
            }
        }
        for (offset, list, noise, corrects) in
            [(2, &self.first_order, first, corrects_first_order), (3, &self.total, total, corrects_total)]
        {
            // Shares are differences.
            let noise = noise.even();
            for (range, all) in [(0..layout.factors), (layout.factors..layout.factors + layout.groups)]
                .map(|range| (range.clone(), sum(&list[range])))
                .into_iter()
                .filter(|(_, all)| corrects && all.estimate > 0.0)
            {
                for swap in range {
                    put(layout.swap(swap) + offset, noise, &share(&list[swap], &all));
                }
            }
        }
        if corrects_first_order && corrects_total {
            for swap in 0..layout.swaps() {
                let interaction = Influenced::combined(&[(1.0, &self.total[swap]), (-1.0, &self.first_order[swap])]);
                put(layout.swap(swap) + 5, total.even(), &interaction);
            }
        } else if corrects_first_order || corrects_total {
            for swap in 0..layout.swaps() {
                let place = layout.swap(swap);
                let (mut of_first, mut of_total) = (plain[place], plain[place + 1]);
                if corrects_first_order {
                    of_first = first.estimate(self.first_order[swap].estimate, &self.first_order[swap].parts);
                } else {
                    of_total = total.estimate(self.total[swap].estimate, &self.total[swap].parts);
                }
                replacements.push((place + 5, (difference(of_total, of_first), errors[place + 5], Vec::new())));
            }
        }
        if self.is_heavy_tailed {
            for (place, (estimate, error, parts)) in &mut replacements {
                let plain = plain[*place];
                estimate.interval = hull(estimate.interval, plain.interval);
                (*error, *parts) = (errors[*place], Vec::new());
            }
        }
        let plain_of = |kind: usize| (0..layout.swaps()).map(|swap| plain[layout.swap(swap) + kind]).collect();
        let used = SurrogateUse {
            explained: self.explained,
            term_count: self.term_count,
            terms: self.terms.clone(),
            is_heavy_tailed: self.is_heavy_tailed,
            corrects_first_order,
            corrects_total,
            gain_first_order: gains[0],
            gain_total: gains[1],
            plain_first_order: plain_of(0),
            plain_total: plain_of(1),
        };
        Corrections { replacements, used }
    }

    /// Mean and variance with their errors.
    pub(super) fn moments(&self) -> [Replacement; 2] {
        let of = |of: &Influenced, skewed| {
            // In units of the largest influence, so that nothing under- or overflows when squared.
            let largest = of.parts.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
            let size = if largest > 0.0 { largest } else { 1.0 };
            let scaled = Influenced { estimate: of.estimate / size, ..Influenced::combined(&[(1.0 / size, of)]) };
            let (estimate, error, _) = replacement(Noise::of_moment(&scaled.parts, skewed), &scaled);
            let interval = estimate.interval.map(|i| Interval { low: i.low * size, high: i.high * size });
            let error = StandardError { error: error.error * size, ..error };
            (Estimate { estimate: of.estimate, interval }, error, of.parts.clone())
        };
        [of(&self.mean, false), of(&self.variance, true)]
    }
}

fn replacement(noise: Noise, of: &Influenced) -> Replacement {
    (noise.estimate(of.estimate, &of.parts), noise.error(&of.parts), of.parts.clone())
}

fn sum(list: &[Influenced]) -> Influenced {
    Influenced::combined(&list.iter().map(|of| (1.0, of)).collect::<Vec<_>>())
}

/// 100 part/all.
fn share(part: &Influenced, all: &Influenced) -> Influenced {
    let percent = 100.0 * part.estimate / all.estimate;
    let Influenced { parts, .. } =
        Influenced::combined(&[(100.0 / all.estimate, part), (-percent / all.estimate, all)]);
    Influenced { estimate: percent, parts }
}

/// The interval that holds both, or nothing if one of them is unknown.
fn hull(a: Option<Interval>, b: Option<Interval>) -> Option<Interval> {
    a.zip(b).map(|(a, b)| Interval { low: a.low.min(b.low), high: a.high.max(b.high) })
}

/// The difference of two numbers of which nothing is known together but that their errors are of independent kinds.
fn difference(a: Estimate, b: Estimate) -> Estimate {
    let estimate = a.estimate - b.estimate;
    let interval = a.interval.zip(b.interval).map(|(of_a, of_b)| Interval {
        low: estimate - (a.estimate - of_a.low).hypot(of_b.high - b.estimate),
        high: estimate + (of_a.high - a.estimate).hypot(b.estimate - of_b.low),
    });
    Estimate { estimate, interval }
}
