//! Which factor leads, as far as the intervals show: the sentences at the top of documents.

use apportion::IndexPair;
use apportion::StudyResult;
use apportion::result::{Named, OutputResult, PairRecord};
use apportion::uncertainty::{EffectEstimates, Estimate, Interval};
use apportion_base::special::normal_quantile;
use apportion_base::text::listed;

use super::format::{chance, count, index, name, percent};
use super::output_view::{OutputView, effects, reason_in_words};
use super::precision::precision_sentence;

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
    /// Probability that it is the largest, if there is one.
    pub probability: Option<f64>,
}

impl Contender {
    /// Creates a contender whose probability to be the largest is unknown.
    pub fn new(label: impl Into<String>, total: Estimate) -> Self {
        Self { label: label.into(), total, probability: None }
    }

    /// Creates the contender of a factor with its index.
    pub fn from_index(index: &Named<EffectEstimates>) -> Self {
        let probability = index.effect.probability_first;
        Self { probability, ..Self::new(name(&index.name), index.effect.weight()) }
    }

    /// Formats its quantity with the unit.
    fn size(&self, unit: &str) -> String {
        format!("{} {unit}", index(self.total)).trim_end().to_owned()
    }
}

/// Returns the indices of an output with their positions in the study, the largest total index first, if any.
pub(super) fn by_total(output: &OutputResult) -> Option<Vec<(usize, &Named<EffectEstimates>)>> {
    let mut order: Vec<(usize, &Named<EffectEstimates>)> = output.indices.as_ref()?.iter().enumerate().collect();
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
            let likely =
                rest.iter().rposition(|&k| contenders[k].probability.is_some_and(|chance| chance >= 1.0 - SURE));
            // Not certain, and no other one is likely: the next one.
            likely.map_or(1, |last| last + 1)
        }
        (None, Some(Interval { low, .. })) => {
            let reaching =
                rest.iter().rposition(|&k| contenders[k].total.interval.is_some_and(|interval| interval.high >= low));
            reaching.map_or(0, |last| last + 1)
        }
        (None, None) => 0,
    };
    order.truncate(1 + rivals);
    order
}

/// Returns which of these interactions exist, tested together: one in forty 95 % intervals excludes 0 from below by
/// chance, so each is widened by Bonferroni's rule (Dunn 1961), with the quantiles of the normal distribution.
pub(super) fn surely_interact(pairs: &[PairRecord]) -> Vec<bool> {
    let ratio = joint_quantile(pairs.len().max(1)) / joint_quantile(1);
    let mut sure = Vec::new();
    for Estimate { estimate, interval } in pairs.iter().map(|pair| pair.index) {
        sure.push(interval.is_some_and(|Interval { low, .. }| low > 0.0 && estimate - ratio * (estimate - low) > 0.0));
    }
    sure
}

/// Returns the quantile for the interval of one of `count` estimates that are tested together.
fn joint_quantile(count: usize) -> f64 {
    normal_quantile(1.0 - (1.0 - Interval::LEVEL) / (2.0 * count as f64))
}

/// Returns the measure by which factors of an output are ranked.
pub(super) fn measure(output: &OutputResult) -> &'static str {
    match effects(output).any(|(_, effect)| effect.dependent.is_some() && effect.shapley.is_some()) {
        true => "Shapley effect",
        false => "total index S_T",
    }
}

/// Returns the factor that matters most for an output with certainty; `None` if the errors leave it open.
fn sure_leader(output: &OutputResult) -> Option<usize> {
    let order = by_total(output)?;
    let contenders: Vec<Contender> = order.iter().map(|(_, index)| Contender::from_index(index)).collect();
    // Without intervals nothing is certain.
    let is_known = contenders.len() == 1 || contenders[0].total.interval.is_some();
    (is_known && leaders(&contenders).len() == 1).then_some(order[0].0)
}

/// Counts for how many outputs each factor matters most with certainty.
pub(super) fn leads(view: &OutputView<'_>) -> Vec<usize> {
    let mut leads = vec![0; view.factors.len()];
    for factor in view.outputs.iter().filter_map(|output| sure_leader(output)) {
        leads[factor] += 1;
    }
    leads
}

/// Says which contender leads by a `measure`, in a sentence that begins with `of`, such as `For y`; `None` for none.
pub(super) fn leader(contenders: &[Contender], of: &str, measure: &str, unit: &str) -> Option<String> {
    let leaders = leaders(contenders);
    let largest = &contenders[*leaders.first()?];
    if largest.total.estimate <= 0.0 {
        return Some(format!("{of}, no {measure} is greater than 0."));
    }
    if leaders.len() == 1 {
        // An estimated probability is never certain.
        let sure = largest.probability.map_or_else(String::new, |probability| {
            let chance = chance(Some(probability)).replace("> ", "more than ");
            format!(", the largest with a probability of {chance}")
        });
        return Some(format!("{of}, {} matters most: its {measure} is {}{sure}.", largest.label, largest.size(unit)));
    }
    let tied = leaders.iter().map(|&k| format!("{} ({})", contenders[k].label, contenders[k].size(unit)));
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
pub(super) fn leader_of_all(indices: &[Named<IndexPair<Estimate>>], of: &str) -> Option<String> {
    let contenders: Vec<Contender> =
        indices.iter().map(|index| Contender::new(name(&index.name), index.effect.total)).collect();
    leader(&contenders, of, "total index S_T", "")
}

/// Says why an output has no indices.
pub(super) fn no_indices(output: &OutputResult) -> String {
    format!("There are no indices of {}: {}.", name(&output.name), reason_in_words(output.reason))
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

/// Returns the paragraphs at the top of the page: on every series, then on the outputs outside series.
pub(super) fn lead(view: &OutputView<'_>) -> Vec<String> {
    let series = view.series.iter().map(|series| series_answer(&view.values(series)));
    let mut lead = first_answers(series.collect());
    lead.extend(match view.outputs.len() {
        ..StudyResult::MIN_OUTPUTS_TOGETHER => {
            first_answers(view.outputs.iter().map(|output| answer(output)).collect())
        }
        _ => answer_on_all(view),
    });
    lead.push(precision_sentence(view));
    lead
}

/// Says which factor matters most for an output, and how much is noise, or which factors follow.
fn answer(output: &OutputResult) -> String {
    let order = by_total(output).unwrap_or_default();
    let contenders: Vec<Contender> = order.iter().map(|(_, index)| Contender::from_index(index)).collect();
    let tied = leaders(&contenders).len();
    let next: Vec<String> = contenders
        .iter()
        .skip(tied)
        .take(2)
        .map(|contender| format!("{} ({})", contender.label, index(contender.total)))
        .collect();
    let verb = if next.len() == 1 { "comes" } else { "come" };
    let next = (!next.is_empty()).then(|| format!("Next {verb} {}.", listed(&next)));
    let sentences = [Some(leader_of(output)), noise_sentence(output).or(next)];
    sentences.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// Says which factor matters most over all values of a series.
fn series_answer(values: &OutputView<'_>) -> String {
    let subject = format!("For {} ({} values)", values.label, values.outputs.len());
    let sentence = leader_of_all(values.together_indices(), &subject);
    sentence.unwrap_or_else(|| format!("There are no indices of {}: {}.", values.label, values.reason()))
}

/// Says for how many of many outputs each factor matters most, and which one does over all together.
fn answer_on_all(view: &OutputView<'_>) -> Vec<String> {
    let leads = leads(view);
    let mut order: Vec<usize> = (0..leads.len()).filter(|&factor| leads[factor] > 0).collect();
    order.sort_by_key(|&factor| std::cmp::Reverse(leads[factor]));
    let counted: Vec<String> =
        order.iter().map(|&factor| format!("{} for {}", name(view.factors[factor]), leads[factor])).collect();
    let count = view.outputs.len();
    let mut answers = vec![match counted.is_empty() {
        true => format!("No factor is sure to matter most for any of {count} outputs."),
        false => format!("Matters most of {count} outputs, by the total index S_T: {}.", listed(&counted)),
    }];
    answers.extend(leader_of_all(view.together_indices(), "For all outputs together"));
    answers
}

/// States the share of the variance of a stochastic model's output that no factor explains.
pub(super) fn noise_sentence(output: &OutputResult) -> Option<String> {
    let total = output.noise.as_ref()?.effect.total;
    Some(format!("Of the variance, {} is noise that no factor explains.", percent(total)))
}
