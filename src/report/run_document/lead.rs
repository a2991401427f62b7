//! What a hurried reader should take along: which factor matters most, how sure that is, and what to mind.

use std::collections::BTreeSet;

use crate::model::MANY_OUTPUTS;
use crate::report::format::{
    count, first, grouped, index, name, percent, share_of_runs, the, two_digits as half_width,
};
use crate::report::interval_widths::{widest_interval, width_after_doubling};
use crate::report::leading::{Contender, SURE, may_lead, names};
use crate::report::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile};
use crate::report::{capitalised, listed};

/// Outputs with a paragraph of their own at the top.
const OUTPUTS: usize = 6;

/// The paragraphs at the top of the page: on every series, then on the `single` outputs, which belong to none.
pub(super) fn lead(result: &ResultFile, single: &ResultFile) -> Vec<String> {
    let mut lead: Vec<String> =
        result.series.iter().take(OUTPUTS).map(|series| super::series::answer(result, series)).collect();
    let more = |more: usize, one: &str, several: &str| {
        (more > 0).then(|| format!("{} below.", count(more as u64, one, several)))
    };
    lead.extend(more(
        result.series.len().saturating_sub(OUTPUTS),
        "more series has its section",
        "more series have theirs",
    ));
    if single.outputs.len() >= MANY_OUTPUTS {
        lead.extend(super::overview::answers(single));
    } else {
        lead.extend(single.outputs.iter().take(OUTPUTS).map(|output| answer(single, output)));
        let others = single.outputs.len().saturating_sub(OUTPUTS);
        lead.extend(more(others, "more output has its section", "more outputs have theirs"));
    }
    lead.push(trust(result));
    lead
}

/// For how many outputs each factor matters most.
pub(super) struct Leads {
    /// By the place of the factor, the outputs for which it surely does.
    pub first: Vec<usize>,
    /// Outputs of which it cannot be told.
    pub open: usize,
    /// Outputs without indices.
    pub without: usize,
}

impl Leads {
    pub fn of(result: &ResultFile) -> Self {
        let mut leads = Self { first: vec![0; result.factors.len()], open: 0, without: 0 };
        for output in &result.outputs {
            match by_total(output) {
                None => leads.without += 1,
                Some(order) => match tied(&order.iter().map(|(_, index)| *index).collect::<Vec<_>>())[..] {
                    [_] => leads.first[order[0].0] += 1,
                    _ => leads.open += 1,
                },
            }
        }
        leads
    }
}

/// Which factor matters most for an output, and how much is due to interactions.
pub(super) fn answer(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(order) = by_total(output) else {
        let reason = output.reason.as_deref().unwrap_or("nothing to compare");
        return format!("There are no indices of {}: {reason}.", the(&output.name));
    };
    let order: Vec<&IndexRecord> = order.into_iter().map(|(_, index)| index).collect();
    let tied = tied(&order);
    let first = if tied.len() > 1 { tie(output, &order, &tied) } else { leader(output, &order) };
    let sentences =
        [first, others(result, &order, &tied), super::noise::sentence(result, output), interactions(output)];
    sentences.into_iter().filter(|sentence| !sentence.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The indices of an output with their places in the study, the largest total index first; `None` without any.
pub(super) fn by_total(output: &OutputRecord) -> Option<Vec<(usize, &IndexRecord)>> {
    let mut order: Vec<(usize, &IndexRecord)> = output.indices.as_ref()?.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.effect.weight().estimate.total_cmp(&a.1.effect.weight().estimate));
    (!order.is_empty()).then_some(order)
}

fn contenders(order: &[&IndexRecord]) -> Vec<Contender> {
    let contender = |index: &&IndexRecord| Contender {
        label: name(&index.factor),
        first_order: Some(index.effect.first_order),
        total: index.effect.weight(),
        probability: index.effect.probability_first,
    };
    order.iter().map(contender).collect()
}

/// The places of those that may have the largest total index.
fn tied(order: &[&IndexRecord]) -> Vec<usize> {
    may_lead(&contenders(order))
}

/// The factors of which none is sure to matter most.
fn tie(output: &OutputRecord, order: &[&IndexRecord], tied: &[usize]) -> String {
    let total = |contender: &Contender| index(contender.total);
    let names = names(&contenders(order), tied, &total);
    let by = weight_name(order);
    format!("What matters most for {} cannot be told apart, by the {by}: {names}.", the(&output.name))
}

fn leader(output: &OutputRecord, order: &[&IndexRecord]) -> String {
    let leader = order[0];
    let (total, by) = (index(leader.effect.weight()), weight_name(order));
    let output = the(&output.name);
    if order.len() == 1 {
        return format!("{} is the only factor of {output}: its {by} is {total}.", first(&leader.factor));
    }
    let share = leader.effect.share_total.map_or_else(String::new, |share| format!(", {share:.1} % of the sum of all"));
    format!("{} matters most for {output}: its {by} is {total}{share}{}.", first(&leader.factor), how_sure(order))
}

/// What factors are ranked by.
fn weight_name(order: &[&IndexRecord]) -> &'static str {
    match order.iter().any(|index| index.effect.dependent.is_some() && index.effect.shapley.is_some()) {
        true => "Shapley effect",
        false => "total index S_T",
    }
}

/// How sure it is that the first is the first.
fn how_sure(order: &[&IndexRecord]) -> String {
    let Some(probability) = order[0].effect.probability_first else { return String::new() };
    if probability > 0.999 {
        return "; that it is the largest is beyond doubt, as far as the error goes".to_owned();
    }
    let rival = order[1..].iter().max_by(|a, b| chance(a).total_cmp(&chance(b)));
    let rival =
        rival.map_or_else(String::new, |rival| format!(", that of {} with {:.2}", name(&rival.factor), chance(rival)));
    format!("; it is the largest with a probability of {probability:.2}{rival}")
}

fn chance(index: &IndexRecord) -> f64 {
    index.effect.probability_first.unwrap_or(0.0)
}

/// Who comes next, and how many factors matter at all.
fn others(result: &ResultFile, order: &[&IndexRecord], tied: &[usize]) -> String {
    if order.len() < 2 {
        return String::new();
    }
    let next = |index: &&IndexRecord| match index.effect.weight().estimate {
        total if total < 0.005 => format!("{} (below 0.01)", name(&index.factor)),
        total => format!("{} ({total:.2})", name(&index.factor)),
    };
    let rest = order.iter().enumerate().filter(|(place, _)| !tied.contains(place)).map(|(_, index)| index);
    let next: Vec<String> = rest.take(2).map(next).collect();
    let mut sentence = match next.len() {
        0 => String::new(),
        1 => format!("Next comes {}", listed(&next)),
        _ => format!("Next come {}", listed(&next)),
    };
    // Of dependent factors nothing follows from a total index alone.
    let above =
        |index: &&IndexRecord| index.effect.probability_above_threshold.filter(|_| index.effect.dependent.is_none());
    let chances: Vec<f64> = order.iter().filter_map(above).collect();
    if order.len() > 3 && chances.len() == order.len() {
        let yes = chances.iter().filter(|chance| **chance > SURE).count();
        let no = chances.iter().filter(|chance| **chance < 1.0 - SURE).count();
        let open = chances.len() - yes - no;
        let threshold = result.provenance.threshold;
        sentence.push_str(if sentence.is_empty() { "Of" } else { "; of" });
        sentence.push_str(&format!(
            " the {} factors, {yes} surely {} S_T = {threshold}, {no} surely {}",
            chances.len(),
            if yes == 1 { "exceeds" } else { "exceed" },
            if no == 1 { "does not" } else { "do not" }
        ));
        if open > 0 {
            sentence.push_str(&format!(", and {open} may"));
        }
    }
    if sentence.is_empty() { sentence } else { sentence + "." }
}

/// A share of the variance that an interval must exclude before interactions count as absent.
const VISIBLE: f64 = 0.1;

/// How much of the variance no factor, nor the noise, accounts for alone.
pub(super) fn interactions(output: &OutputRecord) -> String {
    let text = of_interactions(output.sum_first_order);
    match &output.noise {
        None => text,
        Some(_) => text
            .replace(
                "Interactions of the factors account",
                "Interactions of the factors with each other or the noise account",
            )
            .replace("first-order indices sum", "first-order indices, that of the noise among them, sum"),
    }
}

fn of_interactions(sum_first_order: Option<EstimateRecord>) -> String {
    let Some(sum) = sum_first_order else { return String::new() };
    let rest = EstimateRecord {
        estimate: 1.0 - sum.estimate,
        low: sum.high.map(|high| 1.0 - high),
        high: sum.low.map(|low| 1.0 - low),
    };
    match (rest.low, rest.high) {
        (Some(low), _) if low > 0.0 => {
            format!("Interactions of the factors account for {} of the variance.", percent(rest))
        }
        (_, Some(high)) if high < 0.0 => {
            format!("The first-order indices sum to {}, beyond 1 by more than their error.", index(sum))
        }
        (Some(_), Some(high)) if high > VISIBLE => {
            format!("How much of the variance is interaction is open: the first-order indices sum to {}.", index(sum))
        }
        (Some(_), Some(_)) => format!(
            "No interactions are seen: the first-order indices sum to {}, which is 1 to within the error.",
            index(sum)
        ),
        _ if rest.estimate <= 0.0 => format!(
            "No interactions are seen: the first-order indices sum to {}; without intervals, how sure that is, is unknown.",
            index(sum)
        ),
        _ => format!(
            "Interactions account for some {} of the variance; without intervals, how sure that is, is unknown.",
            percent(rest)
        ),
    }
}

/// How settled the numbers are, and what to mind.
fn trust(result: &ResultFile) -> String {
    let mut sentences = vec![settled(result)];
    let failed = result.outputs.iter().map(|output| output.runs_failed).max().unwrap_or(0);
    if failed > 0 {
        let share = share_of_runs(failed as f64 / result.provenance.model_runs.max(1) as f64);
        sentences.push(format!("{} failed ({share} of all).", capitalised(&count(failed, "run", "runs"))));
    }
    let warnings = result.outputs.iter().flat_map(|output| &output.warnings);
    // Of many outputs each is said once.
    let warnings = match result.outputs.len() {
        ..MANY_OUTPUTS => warnings.count(),
        _ => warnings.collect::<BTreeSet<_>>().len(),
    };
    sentences.push(match warnings {
        0 => "There are no warnings.".to_owned(),
        _ => format!(
            "Mind the {} below.",
            if warnings == 1 { "warning".to_owned() } else { format!("{warnings} warnings") }
        ),
    });
    sentences.join(" ")
}

fn settled(result: &ResultFile) -> String {
    let runs = grouped(result.provenance.model_runs);
    let Some(widest) = widest_interval(result) else {
        let found = result.outputs.iter().any(|output| output.indices.is_some());
        let error = if found { "; nothing is known of the error of the indices" } else { "" };
        return format!("The study took {runs} model runs{error}.");
    };
    let mut sentence = format!("After {runs} model runs every index is known to ± {} or better", half_width(widest));
    if let Some(met) = result.stopping.as_ref().and_then(|stopping| stopping.target_met) {
        sentence.push_str(if met { "; the target is met" } else { "; the target is not met" });
    }
    let doubled = result.outputs.iter().filter_map(|output| width_after_doubling(&output.convergence));
    if let Some(doubled) = doubled.reduce(f64::max) {
        sentence.push_str(&format!("; twice the runs would bring about ± {}", half_width(doubled)));
    }
    sentence + "."
}

/// Largest half width of an output's indices at the end.
pub(super) fn widest(output: &OutputRecord) -> Option<f64> {
    output.convergence.last()?.largest_half_width
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(low: f64, high: f64) -> Option<EstimateRecord> {
        Some(EstimateRecord { estimate: (low + high) / 2.0, low: Some(low), high: Some(high) })
    }

    #[test]
    fn interactions_are_what_the_factors_alone_leave() {
        assert_eq!(
            of_interactions(sum(0.60, 0.62)),
            "Interactions of the factors account for 39 % (38 to 40 %) of the variance."
        );
        assert!(of_interactions(sum(0.99, 1.01)).starts_with("No interactions are seen"));
        assert!(of_interactions(sum(1.01, 1.03)).contains("beyond 1"));
        assert!(of_interactions(sum(0.01, 1.0)).starts_with("How much of the variance is interaction is open"));
        let alone = Some(EstimateRecord { estimate: 0.6, low: None, high: None });
        assert!(of_interactions(alone).contains("some 40.0 % of the variance"));
        let beyond = Some(EstimateRecord { estimate: 1.127, low: None, high: None });
        assert!(of_interactions(beyond).starts_with("No interactions are seen: the first-order indices sum to 1.127;"));
        assert_eq!(of_interactions(None), "");
    }
}
