//! The document on many outputs: an overview, and a table of every output.

use apportion::result::{OutputResult, StudyResult};
use apportion_base::text::listed;

use super::figures::Figures;
use super::shared::{definitions, failed_runs, grouped_warnings};
use super::tables::{FACTORS, IN_CSV};
use crate::document::{Part, Section, Table, largest};
use crate::format::{name, or_dash, short, value};
use crate::leading::{Contender, by_total, leader_of_all, leaders, of_which};
use crate::run_charts::{map_chart, overall_order, together, together_chart};
use crate::wording::weighting;

/// Maximum numbers of factors and of outputs in the table of outputs.
const COLUMNS: usize = 8;
const OUTPUTS: usize = 200;
/// Maximum number of warnings that are shown.
const WARNINGS: usize = 10;

/// Builds the sections of all outputs.
pub(super) fn sections(figures: Figures<'_>) -> Vec<Section> {
    let result = figures.result;
    let mut sections = vec![
        Section::new("overview", "All outputs at a glance", overview(figures)),
        Section::new("warnings", "Warnings", mind(result)),
        Section::new("outputs", "Every output", vec![every_output(result)]),
    ];
    sections.retain(|section| !section.parts.is_empty());
    sections
}

fn overview(figures: Figures<'_>) -> Vec<Part> {
    let result = figures.result;
    let mut parts = definitions(result).to_vec();
    let study = &result.study.name;
    let mut text = format!("The indices of every output are in `{study}.csv`, all else in `{study}.json`.");
    if let Some(aggregate) = &result.aggregate {
        text.push_str(&format!(" In those of all outputs together, {}.", weighting(aggregate.weighting)));
    }
    parts.push(Part::Text(text));
    parts.push(figures.of_all(together_chart(result), "together", &format!("{study}-together")));
    parts.push(factors(result).into());
    parts.push(figures.of_all(map_chart(result), "map", &format!("{study}-map")));
    parts
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
fn leads(result: &StudyResult) -> Vec<usize> {
    let mut leads = vec![0; result.indexed_names().len()];
    result.outputs.iter().filter_map(sure_leader).for_each(|factor| leads[factor] += 1);
    leads
}

/// Tabulates the effect of each factor on all outputs.
pub(super) fn factors(result: &StudyResult) -> Table {
    let (leads, names) = (leads(result), result.indexed_names());
    let all = |factor: usize| together(result).iter().find(|index| index.factor == names[factor]);
    let totals = |&factor: &usize| {
        let total = |output: &'_ OutputResult| Some(output.indices.as_ref()?.get(factor)?.effect.total);
        let mut totals: Vec<_> =
            result.outputs.iter().filter_map(|output| Some((total(output)?, &output.name))).collect();
        totals.sort_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate));
        (factor, totals.get(totals.len() / 2).map(|median| median.0), totals.last().copied())
    };
    let caption = "Indices of all outputs together, number of outputs for which a factor surely matters most, median and largest of its \
                   total indices.";
    Table::from_rows(caption, overall_order(result).iter().map(totals))
        .text("factor", |(factor, ..)| name(names[factor]))
        .number("S_1 together", |(factor, ..)| all(factor).map(|all| all.first_order))
        .number("S_T together", |(factor, ..)| all(factor).map(|all| all.total))
        .number("first of", |(factor, ..)| leads[factor].to_string())
        .number("median S_T", |(_, median, _)| or_dash(median, |median| short(median.estimate)))
        .number("largest S_T", |(.., largest)| largest.map(|(total, _)| total))
        .number("at", |(.., largest)| or_dash(largest, |(_, output)| name(output)))
        .first(FACTORS, IN_CSV)
        .into()
}

/// Lists the outputs without indices, the warnings, and why runs failed.
pub(super) fn mind(result: &StudyResult) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let without = |output: &OutputResult| output.indices.is_none();
    let places: Vec<usize> = (0..result.outputs.len()).filter(|&place| without(&result.outputs[place])).collect();
    if let Some(&first) = places.first() {
        let names: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
        let reason = result.outputs[first].reason.as_deref().unwrap_or("the result has none");
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", of_which(&names, &places))));
    }
    let mut warnings = grouped_warnings(&result.outputs);
    let more = warnings.len().saturating_sub(WARNINGS);
    warnings.truncate(WARNINGS);
    warnings.extend((more > 0).then(|| format!("{more} more warnings are in the JSON file")));
    parts.extend(Part::warnings(&warnings));
    let worst = result.outputs.iter().max_by_key(|output| output.runs_failed);
    parts.extend(worst.and_then(failed_runs));
    parts
}

/// Tabulates mean, standard deviation and total indices of every output, as far as a page has room.
pub(super) fn every_output(result: &StudyResult) -> Part {
    let (names, mut factors) = (result.indexed_names(), overall_order(result));
    factors.truncate(COLUMNS);
    let number = |output: &OutputResult, x: Option<f64>| or_dash(x, |x| value(x, &output.unit));
    let all = result.outputs.len();
    let caption = format!(
        "Mean, standard deviation and total indices S_T of every output.{}{}",
        largest(factors.len(), names.len(), IN_CSV),
        if all > OUTPUTS { format!(" The first {OUTPUTS} of {all} outputs.") } else { String::new() }
    );
    let rows = Table::from_rows(caption, result.outputs.iter().take(OUTPUTS))
        .text("output", |output| name(&output.name))
        .number("mean", |output| number(output, output.mean))
        .number("standard deviation", |output| number(output, output.variance.map(f64::sqrt)));
    let table = factors.iter().fold(rows, |rows, &factor| {
        rows.number(name(names[factor]), |output| Some(output.indices.as_ref()?.get(factor)?.effect.total))
    });
    Part::OnPage(vec![Part::Details { summary: "Every output".to_owned(), parts: vec![table.into()] }])
}

/// Returns the paragraphs at the top: the leading factors of each output and over all together.
pub(super) fn answers(result: &StudyResult) -> Vec<String> {
    let (leads, names) = (leads(result), result.indexed_names());
    let mut order: Vec<usize> = (0..leads.len()).filter(|&factor| leads[factor] > 0).collect();
    order.sort_by_key(|&factor| std::cmp::Reverse(leads[factor]));
    let counted = order.iter().map(|&factor| format!("{} for {}", name(names[factor]), leads[factor]));
    let counted: Vec<String> = counted.collect();
    let all = result.outputs.len();
    let mut answers = vec![match counted.is_empty() {
        true => format!("No factor is sure to matter most for any of {all} outputs."),
        false => format!("Matters most of {all} outputs, by the total index S_T: {}.", listed(&counted)),
    }];
    answers.extend(leader_of_all(together(result), "For all outputs together"));
    answers
}
