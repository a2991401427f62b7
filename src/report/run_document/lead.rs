//! What a hurried reader should take along: which factor matters most, how sure that is, and what to mind.

use crate::model::MANY_OUTPUTS;
use crate::report::format::{chance, count, grouped, index, name, two_digits as half_width};
use crate::report::interval_widths::{WIDE, indices_measured, widest_interval, widest_of, width_after_doubling};
use crate::report::leading::{Contender, SURE, by_total, may_lead, names, of_which};
use crate::report::listed;
use crate::report::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile};
use crate::report::validity;

use super::interactions::interactions;
use super::warnings::{folded, output_names};

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
    // What is warned of says nothing of where the model holds.
    let warnings: Vec<&String> = result.outputs.iter().flat_map(|output| &output.warnings).collect();
    let is_warned = |flag: &str| warnings.iter().any(|text| text.starts_with(&format!("{flag} (")));
    let flags = result.validity.iter().filter(|record| !is_warned(&record.flag)).cloned();
    let validity = validity::sentence(&flags.collect::<Vec<_>>());
    match &mut lead[..] {
        // Of one output all is one paragraph.
        [only] => only.push_str(&format!(" {validity}")),
        _ => lead.push(validity),
    }
    let series = result.series.iter().map(|series| &result.outputs[series.places()]);
    let warned: Vec<&[OutputRecord]> = series.chain([&single.outputs[..]]).collect();
    lead.push(trust(result, &warned));
    lead
}

/// Which factor matters most for an output, and how much is due to interactions.
pub(super) fn answer(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(order) = by_total(output) else {
        let reason = output.reason.as_deref().unwrap_or("nothing to compare");
        return format!("There are no indices of {}: {reason}.", name(&output.name));
    };
    let order: Vec<&IndexRecord> = order.into_iter().map(|(_, index)| index).collect();
    let largest = order[0].effect.weight();
    if largest.estimate == 0.0 && largest.high == Some(0.0) {
        let nothing = format!("No factor acts on {}: every {} is 0.", name(&output.name), weight_name(&order));
        return [nothing, super::noise::sentence(result, output)].join(" ").trim_end().to_owned();
    }
    let tied = tied(&order);
    let first = if tied.len() > 1 { tie(output, &order, &tied) } else { leader(output, &order) };
    let sentences =
        [first, others(result, &order, &tied), super::noise::sentence(result, output), interactions(result, output)];
    sentences.into_iter().filter(|sentence| !sentence.is_empty()).collect::<Vec<_>>().join(" ")
}

fn contenders(order: &[&IndexRecord]) -> Vec<Contender> {
    order.iter().map(|index| Contender::of(index)).collect()
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
    format!("What matters most for {} cannot be told apart, by the {by}: {names}.", name(&output.name))
}

fn leader(output: &OutputRecord, order: &[&IndexRecord]) -> String {
    let leader = order[0];
    let (total, by) = (index(leader.effect.weight()), weight_name(order));
    let (factor, output) = (name(&leader.factor), name(&output.name));
    if order.len() == 1 {
        return format!("For {output}, {factor} is the only factor: its {by} is {total}.");
    }
    format!("For {output}, {factor} matters most: its {by} is {total}{}.", how_sure(order))
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
    match order[0].effect.probability_first {
        None => "; how sure it is that no other is larger, is unknown without intervals".to_owned(),
        // Intervals bear no certainty.
        Some(probability) if probability > 0.999 => ", the largest with a probability of more than 0.999".to_owned(),
        Some(probability) => format!(", the largest with a probability of {}", chance(Some(probability))),
    }
}

/// Who comes next, and how many factors matter at all.
fn others(result: &ResultFile, order: &[&IndexRecord], tied: &[usize]) -> String {
    if order.len() < 2 {
        return String::new();
    }
    let next = |other: &&IndexRecord| format!("{} ({})", name(&other.factor), index(other.effect.weight()));
    let rest: Vec<&IndexRecord> =
        order.iter().enumerate().filter(|(place, _)| !tied.contains(place)).map(|(_, index)| *index).collect();
    let named: Vec<String> = rest.iter().take(2).map(next).collect();
    let mut sentence = match named.len() {
        0 => String::new(),
        1 => format!("Next comes {}", listed(&named)),
        _ if overlap(rest[0], rest[1]) => format!("Next come {}, which cannot be told apart", listed(&named)),
        _ => format!("Next come {}", listed(&named)),
    };
    // Of dependent factors nothing follows from a total index alone.
    let above =
        |index: &IndexRecord| index.effect.probability_above_threshold.filter(|_| index.effect.dependent.is_none());
    let chances: Vec<(f64, EstimateRecord)> =
        order.iter().filter_map(|index| Some((above(index)?, index.effect.total))).collect();
    if order.len() > 3 && chances.len() == order.len() {
        let threshold = result.provenance.threshold;
        // The interval beside the sentence must bear it too.
        let exceeds =
            |(chance, total): &&(f64, EstimateRecord)| *chance > SURE && total.low.is_some_and(|low| low > threshold);
        let stays = |(chance, total): &&(f64, EstimateRecord)| {
            *chance < 1.0 - SURE && total.high.is_some_and(|high| high < threshold)
        };
        let yes = chances.iter().filter(exceeds).count();
        let no = chances.iter().filter(stays).count();
        let open = chances.len() - yes - no;
        let verb = |number: usize, one: &'static str, several: &'static str| if number == 1 { one } else { several };
        let mut parts = Vec::new();
        if yes > 0 {
            parts.push(format!("{yes} surely {} S_T = {threshold}", verb(yes, "exceeds", "exceed")));
        }
        if no > 0 {
            let what = if yes > 0 { String::new() } else { format!(" exceed S_T = {threshold}") };
            parts.push(format!("{no} surely {} not{what}", verb(no, "does", "do")));
        }
        if open > 0 {
            let what = if yes + no > 0 { String::new() } else { format!(" exceed S_T = {threshold}") };
            parts.push(format!("{}{open} may{what}", if parts.is_empty() { "" } else { "and " }));
        }
        sentence.push_str(if sentence.is_empty() { "Of" } else { "; of" });
        sentence.push_str(&format!(" the {} factors, {}", chances.len(), parts.join(", ")));
    }
    if sentence.is_empty() { sentence } else { sentence + "." }
}

/// Whether the intervals of two factors have values in common.
fn overlap(larger: &IndexRecord, smaller: &IndexRecord) -> bool {
    let (a, b) = (larger.effect.weight(), smaller.effect.weight());
    a.low.zip(b.high).is_some_and(|(low, high)| high >= low && (a.estimate, low) != (b.estimate, high))
}

/// How settled the numbers are, and what to mind: outputs are `warned` of in these parts.
fn trust(result: &ResultFile, warned: &[&[OutputRecord]]) -> String {
    let mut sentences = vec![settled(result)];
    let failed = result.outputs.iter().map(|output| output.runs_failed).max().unwrap_or(0);
    let failing: Vec<usize> = result
        .outputs
        .iter()
        .enumerate()
        .filter(|(_, output)| output.runs_failed > 0)
        .map(|(place, _)| place)
        .collect();
    let which = (failing.len() < result.outputs.len()).then(|| of_which(&output_names(&result.outputs), &failing));
    sentences.extend(validity::of_failures(failed, result.provenance.model_runs, which.as_deref()));
    let is_corrected = |output: &&OutputRecord| {
        let used = output.surrogate.as_ref();
        output.runs_failed > 0 && used.is_some_and(|used| used.corrects_first_order || used.corrects_total)
    };
    if let Some(output) = result.outputs.iter().find(is_corrected) {
        sentences.push(format!(
            "Indices of {} corrected by surrogates take the failed runs as missing by chance.",
            name(&output.name)
        ));
    }
    let warnings: usize = warned.iter().map(|outputs| folded(outputs).len()).sum();
    sentences.push(match warnings {
        0 => "There are no warnings.".to_owned(),
        1 => "Mind the warning below.".to_owned(),
        _ => format!("Mind the {warnings} warnings below."),
    });
    let lacks = result.series.is_empty() && result.outputs.iter().any(|output| output.indices.is_none());
    if warnings == 0 && (lacks || failed > 0 || result.validity.iter().any(|flag| flag.runs > 0)) {
        sentences.pop();
    }
    sentences.join(" ")
}

fn settled(result: &ResultFile) -> String {
    let runs = grouped(result.provenance.model_runs);
    let Some(widest) = widest_interval(result) else {
        let found = result.outputs.iter().any(|output| output.indices.is_some());
        let error = if found { "; nothing is known of the error of the indices" } else { "" };
        return format!("The study took {runs} model runs{error}.");
    };
    let mut sentence = match widest < WIDE {
        true => {
            let which = indices_measured(&result.outputs);
            format!("After {runs} model runs {which} is known to ± {} or better", half_width(widest))
        }
        false => format!("After {runs} model runs the intervals are too wide to tell the indices"),
    };
    if let Some(met) = result.stopping.as_ref().and_then(|stopping| stopping.target_met) {
        sentence.push_str(if met { "; the target is met" } else { "; the target is not met" });
    }
    let of_widest =
        result.outputs.iter().max_by(|a, b| widest_of(a).unwrap_or(0.0).total_cmp(&widest_of(b).unwrap_or(0.0)));
    let goes_on = of_widest.is_some_and(|output| width_after_doubling(&output.convergence).is_some());
    let doubled = result.outputs.iter().filter_map(|output| width_after_doubling(&output.convergence));
    // What is known better than it is printed, or better than what rests on no surrogate, needs no word on more runs.
    let is_told = |width: &f64| *width < WIDE && *width > widest / 10.0;
    if let Some(doubled) = doubled.reduce(f64::max).filter(is_told).filter(|_| goes_on) {
        sentence.push_str(&format!("; twice the runs would bring about ± {}", half_width(doubled)));
    }
    sentence + "."
}
