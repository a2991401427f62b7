//! Which factor leads, as far as the intervals show, and how wide these are.

use apportion::result::{IndexRecord, OutputResult, PairRecord, PlainIndexRecord, StudyResult};
use apportion::uncertainty::{Estimate, Interval, LEVEL};
use apportion_base::special::normal_quantile;
use apportion_base::text::listed;

use super::format::{chance, count, index, name, printed_half_width};

/// Probability from which on a lead counts as certain.
const SURE: f64 = 0.95;
/// Maximum number of names in a sentence.
pub(super) const NAMES: usize = 6;

/// A factor or input that may lead.
#[derive(Debug, Clone)]
pub(super) struct Contender {
    /// Its name in a sentence.
    pub label: String,
    /// The quantity it is ranked by: the total index, or another measure.
    pub total: Estimate,
    /// Probability that it is the largest, where it is known.
    pub probability: Option<f64>,
}

impl Contender {
    /// Creates a contender whose probability to be the largest is unknown.
    pub fn new(label: impl Into<String>, total: Estimate) -> Self {
        Self { label: label.into(), total, probability: None }
    }

    /// Creates the contender of a factor with its index.
    pub fn from_index(index: &IndexRecord) -> Self {
        let probability = index.effect.probability_first;
        Self { probability, ..Self::new(name(&index.factor), index.effect.weight()) }
    }
}

/// Returns the indices of an output with their positions in the study, the largest total index first, if any.
pub(super) fn by_total(output: &OutputResult) -> Option<Vec<(usize, &IndexRecord)>> {
    let mut order: Vec<(usize, &IndexRecord)> = output.indices.as_ref()?.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.effect.weight().estimate.total_cmp(&a.1.effect.weight().estimate));
    (!order.is_empty()).then_some(order)
}

/// Returns the positions of `keys`, the largest key first.
pub(super) fn falling(keys: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|&a, &b| keys[b].total_cmp(&keys[a]));
    order
}

/// Returns the numbers of the contenders that may be the largest, the largest estimate first. One alone is the largest
/// with a probability of 0.95 or more, or the errors are unknown; several are tied. A contender is tied with the largest
/// estimate if its own probability is 0.05 or more, or, where probabilities are unknown, if the intervals overlap. Every
/// contender with a larger estimate is tied too.
pub(super) fn leaders(contenders: &[Contender]) -> Vec<usize> {
    let estimates: Vec<f64> = contenders.iter().map(|contender| contender.total.estimate).collect();
    let mut order = falling(&estimates);
    let Some((&lead, rest)) = order.split_first() else { return order };
    let rivals = match (contenders[lead].probability, contenders[lead].total.interval) {
        (Some(probability), _) if probability >= SURE => 0,
        (Some(_), _) => {
            let is_likely = |&k: &usize| contenders[k].probability.is_some_and(|chance| chance >= 1.0 - SURE);
            // Not certain, and no other one is likely: the next one.
            rest.iter().rposition(is_likely).map_or(1, |last| last + 1)
        }
        (None, Some(Interval { low, .. })) => {
            let reaches = |&k: &usize| contenders[k].total.interval.is_some_and(|interval| interval.high >= low);
            rest.iter().rposition(reaches).map_or(0, |last| last + 1)
        }
        (None, None) => 0,
    };
    order.truncate(1 + rivals);
    order
}

/// Returns which of these interactions exist, tested together: one in forty 95 % intervals excludes 0 from below by
/// chance, so each is widened by Bonferroni's rule (Dunn 1961), with the quantiles of the normal distribution.
pub(super) fn surely_interact(pairs: &[PairRecord]) -> Vec<bool> {
    let quantile = |number: f64| normal_quantile(1.0 - (1.0 - LEVEL) / (2.0 * number));
    let ratio = quantile(pairs.len().max(1) as f64) / quantile(1.0);
    let is_sure = |Estimate { estimate, interval }: Estimate| {
        interval.is_some_and(|Interval { low, .. }| low > 0.0 && estimate - ratio * (estimate - low) > 0.0)
    };
    pairs.iter().map(|pair| is_sure(pair.index)).collect()
}

/// Returns the measure by which factors of an output are ranked.
pub(super) fn measure(output: &OutputResult) -> &'static str {
    let is_shapley = |index: &IndexRecord| index.effect.dependent.is_some() && index.effect.shapley.is_some();
    if output.indices.iter().flatten().any(is_shapley) { "Shapley effect" } else { "total index S_T" }
}

/// Says which contender leads by a `measure`, in a sentence that begins with `of`, such as `For y`; `None` for none.
pub(super) fn leader(contenders: &[Contender], of: &str, measure: &str, unit: &str) -> Option<String> {
    let size = |contender: &Contender| format!("{} {unit}", index(contender.total)).trim_end().to_owned();
    let leaders = leaders(contenders);
    let largest = &contenders[*leaders.first()?];
    if largest.total.estimate <= 0.0 {
        return Some(format!("{of}, no {measure} is greater than 0."));
    }
    if leaders.len() == 1 {
        // An estimated probability is never certain.
        let chance = |p: f64| chance(Some(p)).replace("> ", "more than ");
        let sure = largest.probability.map(|p| format!(", the largest with a probability of {}", chance(p)));
        let sure = sure.unwrap_or_default();
        return Some(format!("{of}, {} matters most: its {measure} is {}{sure}.", largest.label, size(largest)));
    }
    let tied = leaders.iter().map(|&k| format!("{} ({})", contenders[k].label, size(&contenders[k])));
    let tied = first_names(tied);
    Some(format!("{of}, the most important factors cannot be distinguished by the {measure}: {tied}."))
}

/// Says the same for the indices of an output, or why it has none.
pub(super) fn leader_of(output: &OutputResult) -> String {
    let contenders: Vec<Contender> = output.indices.iter().flatten().map(Contender::from_index).collect();
    let sentence = leader(&contenders, &format!("For {}", name(&output.name)), measure(output), "");
    sentence.unwrap_or_else(|| no_indices(output))
}

/// Says the same for several outputs together.
pub(super) fn leader_of_all(indices: &[PlainIndexRecord], of: &str) -> Option<String> {
    let contenders: Vec<Contender> =
        indices.iter().map(|index| Contender::new(name(&index.factor), index.total)).collect();
    leader(&contenders, of, "total index S_T", "")
}

/// Says why an output has no indices.
pub(super) fn no_indices(output: &OutputResult) -> String {
    let reason = output.reason.as_deref().unwrap_or("the result has none");
    format!("There are no indices of {}: {reason}.", name(&output.name))
}

/// Returns the first of these sentences, one for each output, and the number of the others.
pub(super) fn first_answers(mut answers: Vec<String>) -> Vec<String> {
    let more = answers.len().saturating_sub(NAMES);
    answers.truncate(NAMES);
    answers.extend((more > 0).then(|| format!("{} below.", count(more as u64, "more output", "more outputs"))));
    answers
}

/// Lists names as in prose, the first ones of many.
fn first_names(mut names: impl ExactSizeIterator<Item = String>) -> String {
    let mut shown: Vec<String> = names.by_ref().take(NAMES).collect();
    shown.extend((names.len() > 0).then(|| format!("{} more", names.len())));
    listed(&shown)
}

/// Lists the outputs at these positions by name, the first ones of many.
pub(super) fn of_which(outputs: &[&str], places: &[usize]) -> String {
    let names = first_names(places.iter().map(|&place| name(outputs[place])));
    match places.len() {
        1 => names,
        all if all == outputs.len() => format!("all {all} outputs"),
        several => format!("{several} outputs: {names}"),
    }
}

/// Half width from which an interval says nothing of a share of the variance: it may be as long as the whole range.
pub const WIDE: f64 = 0.5;

/// Returns the largest half width of any first-order or total index of a result at its end, those of several outputs
/// together included; `None` without intervals.
pub fn widest_interval(result: &StudyResult) -> Option<f64> {
    let together = result.aggregate.iter().filter_map(|aggregate| aggregate.indices.as_ref());
    let together = together.chain(result.series.iter().filter_map(|series| series.indices.as_ref())).flatten();
    let together = together.flat_map(|index| [index.first_order, index.total]).filter_map(printed_half_width);
    let widest = result.outputs.iter().filter_map(widest_of).reduce(f64::max)?;
    Some(together.fold(widest, f64::max))
}

/// Returns the same for an output, not less than any half width in its table: that of the longer side, rounded.
pub fn widest_of(output: &OutputResult) -> Option<f64> {
    let widest = output.convergence.last()?.largest_half_width?;
    let indices = output.indices.iter().flatten();
    let all = indices.flat_map(|index| [index.effect.first_order, index.effect.total]);
    Some(all.filter_map(printed_half_width).fold(widest, f64::max))
}

/// Names the indices that these half widths include: not second order, and not the mean over the noise.
pub fn indices_measured(outputs: &[OutputResult]) -> &'static str {
    let pairs = outputs.iter().any(|output| output.second_order.is_some());
    let noise = outputs.iter().any(|output| output.noise.is_some());
    match (pairs, noise) {
        (false, false) => "every index",
        (true, false) => "every first-order and total index",
        (false, true) => "every index of the values",
        (true, true) => "every first-order and total index of the values",
    }
}
