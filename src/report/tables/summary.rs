//! A result as text for a terminal.

use super::extras::{aggregate_summary, below_zero, estimator_tables, second_order_summary};
use super::number::{chance, give_or_take, share_give_or_take, share_of_runs, significant};
use super::table;
use crate::report::result::{EffectRecord, EstimateRecord, FailureRecord, OutputRecord, ResultFile};

/// A result as text: for every output its moments, a table of indices, what else was asked for, and the warnings; then
/// what holds for all outputs.
pub fn summary(result: &ResultFile) -> String {
    let outputs: Vec<String> = result.outputs.iter().map(|output| output_summary(result, output)).collect();
    let mut text = outputs.join("\n");
    text.push_str(&aggregate_summary(result));
    text.push_str(&interval_summary(result));
    if let Some(stopping) = &result.stopping {
        text.push_str(&format!("stopped: {}\n", stopping.reason));
    }
    text + &validity_summary(result) + &effort_summary(result)
}

/// What the intervals are, in one line.
fn interval_summary(result: &ResultFile) -> String {
    if result.outputs.iter().all(|output| output.indices.is_none()) {
        return String::new();
    }
    match &result.provenance.interval {
        Some(words) => format!("intervals (±): {words}\n"),
        None => "no intervals: a single replicate says nothing about its error\n".to_owned(),
    }
}

/// Which rungs of a ladder of fidelities answered, at what cost, and how wrong they may be.
fn effort_summary(result: &ResultFile) -> String {
    let Some(effort) = &result.effort else { return String::new() };
    let rungs: Vec<String> = effort.rungs.iter().map(|rung| format!("{} {} runs", rung.rung, rung.runs)).collect();
    format!(
        "fidelity: {}; {} evaluations; largest error estimate {:.1e}\n",
        rungs.join(", "),
        effort.evaluations,
        effort.largest_error_estimate
    )
}

/// One line for each validity flag that was raised.
fn validity_summary(result: &ResultFile) -> String {
    let raised = result.validity.iter().filter(|flag| flag.runs > 0);
    raised
        .map(|flag| {
            format!("validity: {} on {} of the runs: {}\n", flag.flag, share_of_runs(flag.share), flag.description)
        })
        .collect()
}

fn output_summary(result: &ResultFile, output: &OutputRecord) -> String {
    let mut text = heading(output);
    text.push_str(&index_table(result, output));
    text.push_str(&below_zero(output));
    text.push_str(&second_order_summary(result, output));
    text.push_str(&estimator_tables(output));
    if let Some(reason) = &output.reason {
        text.push_str(&format!("no indices: {reason}\n"));
    }
    for warning in &output.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    for failure in &output.failures {
        text.push_str(&failed(failure));
    }
    text
}

/// Name, unit, moments, and the range of most values.
fn heading(output: &OutputRecord) -> String {
    let mut text = format!("{} [{}]", output.name, output.unit);
    if let (Some(mean), Some(variance)) = (output.mean, output.variance) {
        // The standard deviation of the page and of the file, by the divisor n - 1.
        let sd = output.distribution.as_ref().and_then(|distribution| distribution.sample.sd);
        let sd = sd.unwrap_or_else(|| variance.sqrt());
        text.push_str(&format!(": mean {}, standard deviation {}", significant(mean), significant(sd)));
    }
    if let Some(distribution) = &output.distribution {
        let quantile = |percent| distribution.sample.quantile(percent).map(significant);
        if let (Some(low), Some(median), Some(high)) = (quantile(2.5), quantile(50.0), quantile(97.5)) {
            text.push_str(&format!("; median {median}, 95 % of the values from {low} to {high}"));
        }
    }
    text + "\n"
}

fn index_table(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(indices) = &output.indices else { return String::new() };
    let above = format!("P(ST > {})", result.provenance.threshold);
    let header = ["factor", "first order S1", "total ST", "share S1 %", "share ST %", "P(first)", &above];
    let mut table = table(&header, &[0]);
    for index in indices {
        table.add_row(effect_row(&index.factor, &index.effect));
    }
    for group in output.groups.iter().flatten() {
        table.add_row(effect_row(&format!("group {}", group.group), &group.effect));
    }
    for subset in output.subsets.iter().flatten() {
        table.add_row(effect_row(&subset.factors.join(" + "), &subset.effect));
    }
    if let Some(effect) = &output.dummy {
        table.add_row(effect_row("dummy (does nothing)", effect));
    }
    let sum = |sum: Option<EstimateRecord>| sum.map_or_else(String::new, give_or_take);
    table.add_row(["sum of factors".to_owned(), sum(output.sum_first_order), sum(output.sum_total)]);
    format!("{table}\n")
}

fn effect_row(name: &str, effect: &EffectRecord) -> [String; 7] {
    [
        name.to_owned(),
        give_or_take(effect.first_order),
        give_or_take(effect.total),
        share_give_or_take(effect.share_first_order, effect.share_first_order_interval),
        share_give_or_take(effect.share_total, effect.share_total_interval),
        chance(effect.probability_first),
        chance(effect.probability_above_threshold),
    ]
}

fn failed(failure: &FailureRecord) -> String {
    let inputs: Vec<String> = failure.first_inputs.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    format!(
        "failed: {} runs: {} (first at row {}: {})\n",
        failure.runs,
        failure.reason,
        failure.first_row,
        inputs.join(", ")
    )
}
