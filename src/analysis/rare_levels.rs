//! Levels of factors that are rare or absent in the rows of a design: results silently miss their effect.

use super::output_indices::OutputIndices;
use crate::design::Design;
use crate::result::{PAIRS_OF_POINT, RareLevel};
use crate::space::{Distribution, Space};
use crate::study::StudyEffect;
use crate::uncertainty::Interval;

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

/// A part of the unit interval, and the name of its values.
struct Part {
    name: String,
    low: f64,
    high: f64,
    /// Whether it is much less likely than the others of its factor.
    is_rare: bool,
}

impl Part {
    /// Creates one of `count` parts.
    fn new(name: String, low: f64, high: f64, count: usize) -> Self {
        Self { name, low, high, is_rare: (high - low) * (count as f64) < RARE }
    }

    fn probability(&self) -> f64 {
        self.high - self.low
    }
}

/// Returns the levels of the factors of `space`, and thin bins of histograms, with fewer than ten values in `design`.
pub(crate) fn rare_levels(space: &Space, design: &Design) -> Vec<RareLevel> {
    let settings = design.settings();
    let all = 2 * settings.base_samples;
    // For any sampler, a level with an expected number three times as large has enough values.
    let is_thin = |part: &Part| part.probability() * (all as f64) < 3.0 * MIN_DRAWS as f64;
    let thin = |(factor, law): (usize, &Distribution)| -> Vec<(usize, Part)> {
        parts(law).into_iter().filter(is_thin).map(|part| (factor, part)).collect()
    };
    let rarest = |(factor, law): (usize, &Distribution)| {
        let rare = parts(law).into_iter().filter(|part| part.is_rare);
        Some((factor, rare.min_by(|a, b| a.probability().total_cmp(&b.probability()))?))
    };
    let name = |factor: usize| space.factors()[factor].name.clone();
    let laws = || space.factors().iter().map(|factor| factor.distribution()).enumerate();
    let parts: Vec<(usize, Part)> = laws().flat_map(thin).collect();
    let draws = if space.copula().is_none() {
        counts(design, &parts)
    } else {
        // The expected numbers.
        parts.iter().map(|(_, part)| (part.probability() * all as f64) as u64).collect()
    };
    let pair = rarest_pair(laws().filter_map(rarest).collect()).filter(|_| space.copula().is_none());
    let pair = pair.and_then(|[(number, part), (other, and)]| {
        let (probability, values) = (part.probability() * and.probability(), PAIRS_OF_POINT * settings.base_samples);
        let draws = probability * values as f64;
        let rare = RareLevel {
            number,
            factor: name(number),
            partner: Some(other),
            level: format!("{} together with {}: {}", part.name, name(other), and.name),
            probability,
            draws: draws as u64,
            values,
        };
        (draws < MIN_MEETINGS).then_some(rare)
    });
    let level = |((number, part), draws): (&(usize, Part), u64)| RareLevel {
        number: *number,
        factor: name(*number),
        partner: None,
        level: part.name.clone(),
        probability: part.probability(),
        draws,
        values: all,
    };
    let rare = parts.iter().zip(draws).filter(|(_, draws)| *draws < MIN_DRAWS).map(level);
    rare.chain(pair).collect()
}

/// Returns the pair of levels that is rarest together, of which the more likely one is not rare itself.
fn rarest_pair(mut levels: Vec<(usize, Part)>) -> Option<[(usize, Part); 2]> {
    levels.sort_by(|a, b| a.1.probability().total_cmp(&b.1.probability()));
    let partner = levels.iter().skip(1).position(|level| level.1.probability() >= MATTERS)? + 1;
    let partner = levels.swap_remove(partner);
    Some([levels.swap_remove(0), partner])
}

/// Returns the number of base samples for which every one of `rare` is expected to have enough values.
pub(crate) fn enough_base_samples(rare: &[RareLevel]) -> f64 {
    rare.iter().map(|level| level.base_samples(MIN_DRAWS as f64)).fold(0.0, f64::max)
}

/// Removes results from `indices` that are not valid without the levels: probabilities, and that a factor with a single
/// value in all rows has no effect.
pub(super) fn withdraw(indices: &mut OutputIndices, rare: &[RareLevel], effects: &[StudyEffect]) {
    let place = |factor: usize| effects.iter().position(|of| of.factors.contains(&factor));
    for level in rare {
        for number in level.partner.into_iter().chain([level.number]) {
            if let Some(of) = place(number).and_then(|place| indices.effects.get_mut(place)) {
                of.estimates.probability_above_threshold = None;
            }
        }
        let of_level = place(level.number).and_then(|place| indices.effects.get_mut(place)).map(|of| &mut of.estimates);
        let Some(effect) = of_level.filter(|_| level.partner.is_none()) else { continue };
        if level.draws == 0 && effect.total.estimate == 0.0 {
            let anything = Some(Interval { low: 0.0, high: 1.0 });
            (effect.first_order.interval, effect.total.interval) = (anything, anything);
            (effect.share_first_order, effect.share_total) = (None, None);
            (effect.share_first_order_interval, effect.share_total_interval) = (None, None);
        }
    }
    if !rare.is_empty() {
        indices.effects.iter_mut().for_each(|of| of.estimates.probability_first = None);
    }
}

/// Returns the parts of a distribution that may each have an effect of their own.
fn parts(law: &Distribution) -> Vec<Part> {
    if let Distribution::Histogram(histogram) = law {
        let (mean, variance) = (law.mean(), law.sd().powi(2));
        let carries = |(low, high, [from, to]): &(f64, f64, [f64; 2])| {
            let middle = f64::midpoint(*from, *to) - mean;
            (high - low) * (middle * middle + (to - from).powi(2) / 12.0) > WEIGHT * variance
        };
        let (bins, count) = (histogram.bins().filter(carries), histogram.bins().count());
        return bins.map(|(low, high, [from, to])| Part::new(format!("{from} to {to}"), low, high, count)).collect();
    }
    let Some(levels) = law.levels() else { return Vec::new() };
    let count = levels.len();
    let mut end = 0.0;
    // Each has the quantile in its middle.
    let part = |(value, middle): (f64, f64)| {
        let low = end;
        end = 2.0 * middle - low;
        let label = if let Distribution::Categorical(law) = law { law.label(value).map(str::to_owned) } else { None };
        Part::new(label.unwrap_or_else(|| value.to_string()), low, end, count)
    };
    let parts: Vec<Part> = levels.into_iter().map(part).collect();
    let is_label = matches!(law, Distribution::Categorical(_));
    match law {
        Distribution::Discrete(_) | Distribution::Categorical(_) => {
            parts.into_iter().filter(|part| is_label || part.is_rare).collect()
        }
        // Counts are unbounded: what matters is whether there is more than one of them.
        _ => parts.into_iter().max_by(|a, b| a.probability().total_cmp(&b.probability())).map_or_else(Vec::new, others),
    }
}

/// Returns the parts below and above a part.
fn others(part: Part) -> Vec<Part> {
    let below = Part::new(format!("below {}", part.name), 0.0, part.low, 2);
    let above = Part::new(format!("above {}", part.name), part.high, 1.0, 2);
    let larger = if below.probability() > above.probability() { below } else { above };
    if larger.probability() > 0.0 { vec![larger] } else { Vec::new() }
}

/// Returns the number of values of A and B in each of `parts`.
fn counts(design: &Design, parts: &[(usize, Part)]) -> Vec<u64> {
    let mut counts = vec![0; parts.len()];
    let points = design.points_per_replicate();
    for replicate in (0..design.settings().replicates).filter(|_| !parts.is_empty()) {
        let base = design.replicate(replicate);
        for first in (0..points).step_by(CHUNK as usize) {
            let mut columns = vec![vec![0.0; CHUNK.min(points - first) as usize]; 2 * design.factors()];
            base.fill(first, &mut columns);
            for (count, (factor, part)) in counts.iter_mut().zip(parts) {
                let values = columns[*factor].iter().chain(&columns[design.factors() + factor]);
                *count += values.filter(|u| (part.low..part.high).contains(*u)).count() as u64;
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests;
