//! The document on many outputs: an overview, and a table of every output.

use apportion::IndexPair;
use apportion::result::Named;
use apportion::uncertainty::Estimate;

use super::parts::{definitions, failed_runs, figure, grouped_warnings};
use super::tables::{FACTORS, IN_CSV};
use crate::document::{Part, Section, Table, largest};
use crate::format::{name, or_dash, short, value};
use crate::leading::{leads, of_which};
use crate::output_view::{OutputView, effect_at, reason_in_words};
use crate::run_charts::{map_chart, overall_order, together_chart};

/// Maximum numbers of factors and of outputs in the table of outputs.
const COLUMNS: usize = 8;
const OUTPUTS: usize = 200;
/// Maximum number of warnings that are shown.
const WARNINGS: usize = 10;

/// Builds the sections of all outputs.
pub(super) fn sections(view: &OutputView<'_>) -> Vec<Section> {
    vec![
        Section::new("overview", "All outputs at a glance", overview(view)),
        Section::new("warnings", "Warnings", warnings(view)),
        Section::new("outputs", "Every output", vec![every_output(view)]),
    ]
}

fn overview(view: &OutputView<'_>) -> Vec<Part> {
    let (study, stem) = (&view.result.study, &view.result.study.name);
    let mut parts = definitions(view.result).to_vec();
    let mut text = format!("The indices of every output are in `{stem}.csv`, all else in `{stem}.json`.");
    if let Some(together) = &view.together {
        text.push_str(&format!(" In those of all outputs together, {}.", together.weighting));
    }
    parts.push(Part::Text(text));
    parts.push(figure(study, together_chart(view), "together".to_owned(), format!("{stem}-together"), ".csv"));
    let caption = "Indices of all outputs together, number of outputs for which a factor surely matters most, median and largest of its \
                   total indices.";
    parts.push(factors(view, caption).into());
    parts.push(figure(study, map_chart(view), "map".to_owned(), format!("{stem}-map"), ".csv"));
    parts
}

/// A factor in the table of its effects on all outputs.
#[derive(Clone, Copy)]
struct FactorRow<'a> {
    factor: &'a str,
    together: Option<&'a Named<IndexPair<Estimate>>>,
    leads: usize,
    median: Option<Estimate>,
    largest: Option<(Estimate, &'a str)>,
}

impl<'a> FactorRow<'a> {
    fn new(view: &OutputView<'a>, number: usize, leads: usize) -> Self {
        let factor = view.factors[number];
        let outputs = view.outputs.iter();
        let mut totals: Vec<(Estimate, &str)> =
            outputs.filter_map(|output| Some((effect_at(output, number)?.total, output.name.as_str()))).collect();
        totals.sort_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate));
        Self {
            factor,
            together: view.together_indices().iter().find(|index| index.name == factor),
            leads,
            median: totals.get(totals.len() / 2).map(|(total, _)| *total),
            largest: totals.last().copied(),
        }
    }
}

/// Tabulates the effect of each factor on all outputs.
pub(super) fn factors(view: &OutputView<'_>, caption: &str) -> Table {
    let leads = leads(view);
    let order = overall_order(view).into_iter();
    Table::from_rows(caption, order.map(|factor| FactorRow::new(view, factor, leads[factor])))
        .text("factor", |row| name(row.factor))
        .number("S_1 together", |row| row.together.map(|together| together.effect.first_order))
        .number("S_T together", |row| row.together.map(|together| together.effect.total))
        .number("first of", |row| row.leads.to_string())
        .number("median S_T", |row| or_dash(row.median, |median| short(median.estimate)))
        .number("largest S_T", |row| row.largest.map(|(total, _)| total))
        .number("at", |row| or_dash(row.largest, |(_, output)| name(output)))
        .first(FACTORS, IN_CSV)
        .into()
}

/// Lists the outputs without indices, the warnings, and why runs failed.
pub(super) fn warnings(view: &OutputView<'_>) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let places: Vec<usize> = (0..view.outputs.len()).filter(|&place| view.outputs[place].indices.is_none()).collect();
    if let Some(&first) = places.first() {
        let names: Vec<&str> = view.outputs.iter().map(|output| output.name.as_str()).collect();
        let reason = reason_in_words(view.outputs[first].reason);
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", of_which(&names, &places))));
    }
    let mut warnings = grouped_warnings(&view.outputs);
    let more = warnings.len().saturating_sub(WARNINGS);
    warnings.truncate(WARNINGS);
    warnings.extend((more > 0).then(|| format!("{more} more warnings are in the JSON file")));
    parts.extend(Part::warnings(&warnings));
    let worst = view.outputs.iter().max_by_key(|output| output.runs_failed);
    parts.extend(worst.and_then(|output| failed_runs(output)));
    parts
}

/// Tabulates mean, standard deviation and total indices of every output, as far as a page has room.
pub(super) fn every_output(view: &OutputView<'_>) -> Part {
    let mut factors = overall_order(view);
    factors.truncate(COLUMNS);
    let count = view.outputs.len();
    let caption = format!(
        "Mean, standard deviation and total indices S_T of every output.{}{}",
        largest(factors.len(), view.factors.len(), IN_CSV),
        if count > OUTPUTS { format!(" The first {OUTPUTS} of {count} outputs.") } else { String::new() }
    );
    let mut rows = Table::from_rows(caption, view.outputs.iter().copied().take(OUTPUTS))
        .text("output", |output| name(&output.name))
        .number("mean", |output| or_dash(output.mean, |mean| value(mean, &output.unit)))
        .number("standard deviation", |output| or_dash(output.variance.map(f64::sqrt), |sd| value(sd, &output.unit)));
    for factor in factors {
        rows = rows.number(name(view.factors[factor]), |output| effect_at(output, factor).map(|effect| effect.total));
    }
    Part::OnPage(vec![Part::Details { summary: "Every output".to_owned(), parts: vec![rows.into()] }])
}
