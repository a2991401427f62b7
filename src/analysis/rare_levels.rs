//! Levels of factors that the rows of a design have hardly met, or not at all. What they do to the output is not in the numbers,
//! and no number shows that it is missing.

use thiserror::Error;

use crate::design::Design;
use crate::space::{Distribution, Space};
use crate::uncertainty::{Interval, OutputIndices};

/// Values of a factor in A and B that a level needs for its effect to be known: with ten, to a third.
const MIN_DRAWS: u64 = 10;

/// Of numbers in order, probability of a rare one over that of an average one: others are much like their neighbours.
const RARE: f64 = 0.5;

/// Share of the variance of a histogram that a bin needs to carry weight.
const WEIGHT: f64 = 0.1;

/// Base points at a time.
const CHUNK: u64 = 1 << 12;

/// A level of a factor that rows hardly met.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "{factor}: {level} (probability {probability:.2e}) is in {} of the {values} values drawn, so that its effect on the \
     output is not known, and the indices may be anything: some {:.0} base samples meet it once, and {:.0} ten times",
    if *draws == 0 { "none".to_owned() } else { draws.to_string() },
    self.base_samples(1.0),
    self.base_samples(10.0)
)]
#[non_exhaustive]
pub struct RareLevel {
    /// The number of the factor.
    pub number: usize,
    /// The factor.
    pub factor: String,
    /// The level: a value, a label, or a range.
    pub level: String,
    /// Its probability.
    pub probability: f64,
    /// How many of the values of the factor in A and B are this level.
    pub draws: u64,
    /// How many values there are.
    pub values: u64,
}

impl RareLevel {
    /// Whether so few rows have it, or none, that surrogates cannot know of it.
    pub fn is_missed(&self) -> bool {
        self.draws < 3
    }

    /// Base samples with which the level is drawn that often in the mean.
    pub fn base_samples(&self, draws: f64) -> f64 {
        draws / (2.0 * self.probability)
    }
}

/// A part of the unit interval, and the values that it stands for.
struct Part {
    name: String,
    low: f64,
    high: f64,
}

/// The levels of the factors of `space`, and the thin bins of histograms, that fewer than ten values of A and B in `design` have.
pub(crate) fn rare_levels(space: &Space, design: &Design) -> Vec<RareLevel> {
    let settings = design.settings();
    let all = 2 * settings.base_samples;
    // No sampler is so uneven that a level of three times as many values in the mean has fewer.
    let is_thin = |part: &Part| ((part.high - part.low) * all as f64) < 3.0 * MIN_DRAWS as f64;
    let thin = |(factor, law): (usize, &Distribution)| -> Vec<(usize, Part)> {
        parts(law).into_iter().filter(is_thin).map(|part| (factor, part)).collect()
    };
    let laws = space.factors().iter().map(|factor| factor.distribution());
    let parts: Vec<(usize, Part)> = laws.enumerate().flat_map(thin).collect();
    let draws = if space.copula().is_none() { counts(design, &parts) } else { expected(all, &parts) };
    let rare = parts.into_iter().zip(draws).filter(|(_, draws)| *draws < MIN_DRAWS);
    let level = |((factor, part), draws): ((usize, Part), u64)| RareLevel {
        number: factor,
        factor: space.factors()[factor].name.clone(),
        level: part.name,
        probability: part.high - part.low,
        draws,
        values: all,
    };
    rare.map(level).collect()
}

/// Base samples with which every one of `rare` has enough values in the mean.
pub(crate) fn enough_base_samples(rare: &[RareLevel]) -> f64 {
    rare.iter().map(|level| level.base_samples(MIN_DRAWS as f64)).fold(0.0, f64::max)
}

/// Takes back what `indices` cannot say without the levels: probabilities, and of a factor of one value in all rows that it has no
/// effect.
pub(super) fn withdraw(indices: &mut OutputIndices, rare: &[RareLevel]) {
    for level in rare {
        let Some(effect) = indices.factors.get_mut(level.number) else { continue };
        effect.probability_above_threshold = None;
        if level.draws == 0 && effect.total.estimate == 0.0 {
            let anything = Some(Interval { low: 0.0, high: 1.0 });
            (effect.first_order.interval, effect.total.interval) = (anything, anything);
            (effect.share_first_order, effect.share_total) = (None, None);
            (effect.share_first_order_interval, effect.share_total_interval) = (None, None);
        }
    }
    if !rare.is_empty() {
        indices.factors.iter_mut().for_each(|effect| effect.probability_first = None);
    }
}

/// The parts that a distribution consists of, as far as each may do something of its own.
fn parts(law: &Distribution) -> Vec<Part> {
    if let Distribution::Histogram(histogram) = law {
        let (mean, variance) = (law.mean(), law.sd().powi(2));
        let carries = |(low, high, [from, to]): &(f64, f64, [f64; 2])| {
            let middle = f64::midpoint(*from, *to) - mean;
            (high - low) * (middle * middle + (to - from).powi(2) / 12.0) > WEIGHT * variance
        };
        let bins = histogram.bins().filter(carries);
        return bins.map(|(low, high, [from, to])| Part { name: format!("{from} to {to}"), low, high }).collect();
    }
    let Some(levels) = law.levels() else { return Vec::new() };
    let count = levels.len();
    let mut end = 0.0;
    // Each comes with the quantile in its middle.
    let part = |(value, middle): (f64, f64)| {
        let low = end;
        end = 2.0 * middle - low;
        let label = if let Distribution::Categorical(law) = law { law.label(value).map(str::to_owned) } else { None };
        Part { name: label.unwrap_or_else(|| value.to_string()), low, high: end }
    };
    let parts: Vec<Part> = levels.into_iter().map(part).collect();
    let is_label = matches!(law, Distribution::Categorical(_));
    match law {
        Distribution::Discrete(_) | Distribution::Categorical(_) => {
            let is_rare = |part: &Part| is_label || (part.high - part.low) * (count as f64) < RARE;
            parts.into_iter().filter(is_rare).collect()
        }
        // Counts go on beyond any number: whether there is more than one of them is what matters.
        _ => {
            parts.into_iter().max_by(|a, b| (a.high - a.low).total_cmp(&(b.high - b.low))).map_or_else(Vec::new, others)
        }
    }
}

/// What is below a part, and above it.
fn others(part: Part) -> Vec<Part> {
    let below = Part { name: format!("below {}", part.name), low: 0.0, high: part.low };
    let above = Part { name: format!("above {}", part.name), low: part.high, high: 1.0 };
    let larger = if below.high - below.low > above.high - above.low { below } else { above };
    if larger.high > larger.low { vec![larger] } else { Vec::new() }
}

/// How many values of A and B lie in each of `parts`.
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

/// The same in the mean.
fn expected(all: u64, parts: &[(usize, Part)]) -> Vec<u64> {
    parts.iter().map(|(_, part)| ((part.high - part.low) * all as f64) as u64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{DesignSettings, Rows};
    use crate::quantity::Unit;
    use crate::space::Factor;

    fn found(law: Distribution, base_samples: u64) -> Vec<RareLevel> {
        let factor = Factor::new("d", Unit::dimensionless(), law).unwrap();
        let space = Space::new(vec![factor]);
        let settings = DesignSettings { base_samples, ..DesignSettings::default() };
        rare_levels(&space, &Design::new(settings, 1, Rows::plain(vec![vec![0]])).unwrap())
    }

    #[test]
    fn levels_are_counted_by_their_probabilities() {
        let rare = found(Distribution::boolean(0.03).unwrap(), 128);
        assert_eq!(rare.len(), 1);
        assert_eq!((rare[0].level.as_str(), rare[0].values), ("true", 256));
        assert!((rare[0].probability - 0.03).abs() < 1e-12 && (4..10).contains(&rare[0].draws), "{rare:?}");
        assert!((enough_base_samples(&rare) - 166.7).abs() < 0.1);
        assert!(found(Distribution::boolean(0.03).unwrap(), 512).is_empty());
        // The same level from the other side.
        assert_eq!(found(Distribution::boolean(0.999).unwrap(), 64)[0].level, "false");
    }

    #[test]
    fn numbers_in_order_are_no_levels_of_their_own() {
        let values: Vec<f64> = (0..200).map(f64::from).collect();
        assert!(found(Distribution::discrete(&values, None).unwrap(), 64).is_empty());
        assert!(found(Distribution::poisson(3.0).unwrap(), 64).is_empty());
        assert_eq!(found(Distribution::poisson(0.001).unwrap(), 64)[0].level, "above 0");
        let rare = found(Distribution::discrete(&[0.0, 1.0, 2.0], Some(&[0.499, 0.499, 0.002])).unwrap(), 128);
        assert_eq!(rare.iter().map(|rare| rare.level.as_str()).collect::<Vec<_>>(), ["2"]);
    }

    #[test]
    fn thin_bins_count_where_they_carry_the_variance() {
        let law = |edges: &[f64]| Distribution::histogram(edges, &[0.999, 0.001]).unwrap();
        assert_eq!(found(law(&[0.0, 1.0, 1000.0]), 128)[0].level, "1 to 1000");
        assert!(found(law(&[0.0, 1.0, 1.1]), 128).is_empty());
    }
}
