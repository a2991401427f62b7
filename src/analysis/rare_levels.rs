//! Levels of factors that are rare or absent in the rows of a design: results silently miss their effect.

use super::output_indices::OutputIndices;
use crate::design::Design;
use crate::result::{PAIRS_OF_POINT, RareLevel};
use crate::space::{Distribution, Space};
use crate::study::StudyEffect;
use crate::uncertainty::{EffectEstimates, Interval};

/// Expected number of joint draws of two rare levels for their joint effect to be seen: one of 150 designs has none.
const MIN_MEETINGS: f64 = 5.0;

/// Probability of the more likely of two levels above which their joint effect may matter next to that of the other.
const MATTERS: f64 = 0.025;

/// Values of a factor in A and B that a level needs for its effect to be estimated: with ten, to a third.
const MIN_DRAWS: u64 = 10;

/// For ordered numbers, ratio of the probability of a rare one to the average: others are similar to their neighbours.
const RARE: f64 = 0.5;

/// Share of the variance of a histogram above which a bin matters.
const WEIGHT: f64 = 0.1;

/// Base points processed at a time.
const CHUNK: u64 = 1 << 12;

/// A part of the unit interval of a factor, and the name of its values.
#[derive(Clone)]
struct Part {
    factor: usize,
    name: String,
    low: f64,
    high: f64,
    /// Whether it is much less likely than the others of its factor.
    is_rare: bool,
}

impl Part {
    /// Creates one of the `count` parts of a factor.
    fn new(factor: usize, name: String, (low, high): (f64, f64), count: usize) -> Self {
        Self { factor, name, low, high, is_rare: (high - low) * (count as f64) < RARE }
    }

    fn probability(&self) -> f64 {
        self.high - self.low
    }
}

/// Returns the levels of the factors of `space`, and thin bins of histograms, with fewer than ten values in `design`.
pub(crate) fn rare_levels(space: &Space, design: &Design) -> Vec<RareLevel> {
    let base_samples = design.settings().base_samples;
    let values = 2 * base_samples;
    let (mut thin, mut rarest) = (Vec::new(), Vec::new());
    for (number, factor) in space.factors().iter().enumerate() {
        let parts = parts(number, factor.distribution());
        let rare = parts.iter().filter(|part| part.is_rare);
        rarest.extend(rare.min_by(|a, b| a.probability().total_cmp(&b.probability())).cloned());
        // For any sampler, a level with an expected number three times as large has enough values.
        let is_thin = parts.into_iter().filter(|part| part.probability() * (values as f64) < 3.0 * MIN_DRAWS as f64);
        thin.extend(is_thin);
    }
    let is_independent = space.copula().is_none();
    let draws = match is_independent {
        true => counts(design, &thin),
        // The expected numbers.
        false => thin.iter().map(|part| (part.probability() * values as f64) as u64).collect(),
    };
    let mut rare = Vec::new();
    for (part, draws) in thin.into_iter().zip(draws) {
        if draws < MIN_DRAWS {
            rare.push(RareLevel {
                number: part.factor,
                factor: space.factors()[part.factor].name.clone(),
                partner: None,
                probability: part.probability(),
                level: part.name,
                draws,
                values,
            });
        }
    }
    if is_independent {
        rare.extend(rarest_pair(rarest).and_then(|pair| rare_pair(space, &pair, base_samples)));
    }
    rare
}

/// Levels of two factors.
struct RarePair {
    /// The less likely one.
    level: Part,
    partner: Part,
}

/// Returns the pair of levels that is rarest together, of which the more likely one is not rare itself.
fn rarest_pair(mut levels: Vec<Part>) -> Option<RarePair> {
    levels.sort_by(|a, b| a.probability().total_cmp(&b.probability()));
    let partner = levels.iter().skip(1).position(|level| level.probability() >= MATTERS)? + 1;
    let partner = levels.swap_remove(partner);
    Some(RarePair { level: levels.swap_remove(0), partner })
}

/// Returns two levels if they are expected together too rarely.
fn rare_pair(space: &Space, RarePair { level, partner }: &RarePair, base_samples: u64) -> Option<RareLevel> {
    let [factor, other] = [level, partner].map(|part| &space.factors()[part.factor].name);
    let (probability, values) = (level.probability() * partner.probability(), PAIRS_OF_POINT * base_samples);
    let draws = probability * values as f64;
    (draws < MIN_MEETINGS).then(|| RareLevel {
        number: level.factor,
        factor: factor.clone(),
        partner: Some(partner.factor),
        level: format!("{} together with {other}: {}", level.name, partner.name),
        probability,
        draws: draws as u64,
        values,
    })
}

/// Returns the number of base samples for which every one of `rare` is expected to have enough values.
pub(crate) fn enough_base_samples(rare: &[RareLevel]) -> f64 {
    rare.iter().map(|level| level.base_samples(MIN_DRAWS as f64)).fold(0.0, f64::max)
}

/// Removes results from `indices` that are not valid without the levels: probabilities, and that a factor with a single
/// value in all rows has no effect.
pub(super) fn withdraw(indices: &mut OutputIndices, rare: &[RareLevel], effects: &[StudyEffect]) {
    for level in rare {
        for number in level.partner.into_iter().chain([level.number]) {
            if let Some(estimates) = estimates_of(indices, effects, number) {
                estimates.probability_above_threshold = None;
            }
        }
        let Some(effect) = estimates_of(indices, effects, level.number) else { continue };
        if level.partner.is_none() && level.draws == 0 && effect.total.estimate == 0.0 {
            let anything = Some(Interval { low: 0.0, high: 1.0 });
            (effect.first_order.interval, effect.total.interval) = (anything, anything);
            (effect.share_first_order, effect.share_total) = (None, None);
            (effect.share_first_order_interval, effect.share_total_interval) = (None, None);
        }
    }
    if !rare.is_empty() {
        for of in &mut indices.effects {
            of.estimates.probability_first = None;
        }
    }
}

/// Returns the indices of the factor of that number, or of its group.
fn estimates_of<'a>(
    indices: &'a mut OutputIndices,
    effects: &[StudyEffect],
    number: usize,
) -> Option<&'a mut EffectEstimates> {
    let place = effects.iter().position(|of| of.factors.contains(&number))?;
    indices.effects.get_mut(place).map(|of| &mut of.estimates)
}

/// Returns the parts of the distribution of a factor that may each have a separate effect.
fn parts(factor: usize, law: &Distribution) -> Vec<Part> {
    let mut parts = Vec::new();
    if let Distribution::Histogram(histogram) = law {
        let (mean, variance, count) = (law.mean(), law.sd().powi(2), histogram.bins().count());
        for (low, high, [from, to]) in histogram.bins() {
            let middle = f64::midpoint(from, to) - mean;
            if (high - low) * (middle * middle + (to - from).powi(2) / 12.0) > WEIGHT * variance {
                parts.push(Part::new(factor, format!("{from} to {to}"), (low, high), count));
            }
        }
        return parts;
    }
    let levels = law.levels().unwrap_or_default();
    let mut low = 0.0;
    for &(value, middle) in &levels {
        let high = 2.0 * middle - low;
        let name = law.label(value).map_or_else(|| value.to_string(), str::to_owned);
        parts.push(Part::new(factor, name, (low, high), levels.len()));
        low = high;
    }
    match law {
        Distribution::Categorical(_) => parts,
        Distribution::Discrete(_) => parts.into_iter().filter(|part| part.is_rare).collect(),
        // Counts are unbounded: what matters is whether there is more than one of them.
        _ => parts.iter().max_by(|a, b| a.probability().total_cmp(&b.probability())).map_or_else(Vec::new, others),
    }
}

/// Returns the more likely one of the parts below and above a part.
fn others(part: &Part) -> Vec<Part> {
    let below = Part::new(part.factor, format!("below {}", part.name), (0.0, part.low), 2);
    let above = Part::new(part.factor, format!("above {}", part.name), (part.high, 1.0), 2);
    let larger = if below.probability() > above.probability() { below } else { above };
    if larger.probability() > 0.0 { vec![larger] } else { Vec::new() }
}

/// Returns the number of values of A and B in each of `parts`.
fn counts(design: &Design, parts: &[Part]) -> Vec<u64> {
    let mut counts = vec![0; parts.len()];
    let points = design.points_per_replicate();
    for replicate in (0..design.settings().replicates).filter(|_| !parts.is_empty()) {
        let base = design.replicate(replicate);
        for first in (0..points).step_by(CHUNK as usize) {
            let mut columns = vec![vec![0.0; CHUNK.min(points - first) as usize]; 2 * design.factors()];
            base.fill(first, &mut columns);
            for (count, part) in counts.iter_mut().zip(parts) {
                let values = columns[part.factor].iter().chain(&columns[design.factors() + part.factor]);
                *count += values.filter(|u| (part.low..part.high).contains(*u)).count() as u64;
            }
        }
    }
    counts
}

#[cfg(test)]
#[path = "tests/rare_levels.rs"]
mod tests;
