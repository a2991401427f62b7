//! The parts that sections on one output, on many and on series share.

use std::mem::discriminant;

use apportion::result::{OutputResult, StudyRecord, StudyResult, Warning};

use crate::chart::Chart;
use crate::document::{Figure, Part, grouped_by_key};
use crate::file_stems;
use crate::leading::of_which;
use crate::output_view::OutputView;
use crate::study_sections::{failures, inputs};

/// Suffixes of the names of the files of all charts, each after a hyphen except the first.
const SUFFIXES: [&str; 8] =
    ["", "-indices", "-scatter", "-distribution", "-convergence", "-pairs", "-along", "-together"];

/// Returns the prefixes of the files of the charts: of each output, if they are few, and of each series.
pub(super) fn stems(view: &OutputView<'_>) -> (Vec<String>, Vec<String>) {
    let is_many = view.outputs.len() >= StudyResult::MIN_OUTPUTS_TOGETHER;
    // Charts of many outputs together have the names of a single series.
    let mut names: Vec<&str> =
        if is_many { vec!["outputs"] } else { view.outputs.iter().map(|output| output.name.as_str()).collect() };
    let count = names.len();
    names.extend(view.series.iter().map(|series| series.name.as_str()));
    let mut outputs = file_stems(&view.result.study.name, &names, &SUFFIXES);
    let series = outputs.split_off(count);
    (outputs, series)
}

/// Creates the figure of a chart: `anchor` is the end of its anchor, `stem` the name of its files, and the name of the
/// file with its numbers ends in `data`; empty without one.
pub(super) fn figure(study: &StudyRecord, chart: Chart, anchor: String, stem: String, data: &str) -> Part {
    let mut figure = Figure::unnumbered(chart, stem);
    figure.id = format!("figure-{anchor}");
    figure.title = figure.title_after(study.headline());
    if !data.is_empty() {
        figure.data = format!("{}{data}", study.name);
    }
    figure.into()
}

/// Defines the columns of the tables of indices, and the intervals.
pub(super) fn definitions(result: &StudyResult) -> [Part; 2] {
    let threshold = result.provenance.threshold;
    let indices = match result.study.dependences.is_empty() {
        true => format!(
            "S_1: share of the variance explained by the factor alone. S_T: share explained by the factor and all its \
             interactions. P(largest): probability that the total index of the factor is the largest. P(S_T > {threshold}): \
             probability that it exceeds {threshold}."
        ),
        false => {
            "Factors depend on each other. S_1: share of the variance explained by the factor, including what it shares with \
             others. S_T: share that remains if all other factors are known (Kucherenko, Tarantola and Annoni 2012). The other \
             two are S_1 of the part that is independent of the others, and S_T including what it shares with them (Mara, \
             Tarantola and Annoni 2015)."
                .to_owned()
        }
    };
    let intervals = match result.provenance.interval() {
        Some(words) => Part::Details {
            summary: "How the intervals are computed".to_owned(),
            parts: vec![Part::Text(format!("Intervals (±): {words}."))],
        },
        None => Part::Text("There are no intervals: one replicate gives no estimate of its error.".to_owned()),
    };
    [Part::OnPage(vec![Part::Text(indices)]), intervals]
}

/// Says why runs of an output failed.
pub(super) fn failed_runs(output: &OutputResult) -> Option<Part> {
    let failed = output.failures.iter();
    failures(
        failed.map(|f| {
            (&*f.reason, format!("row {}: {}", f.first_row.unwrap_or_default(), inputs(&f.first_inputs)), f.runs)
        }),
    )
}

/// Returns the warnings, a sentence for each kind in the order of first occurrence: the first warning of a kind, its
/// outputs if there are several in all, and the number of further ones of the kind in the file.
pub(super) fn grouped_warnings(outputs: &[&OutputResult]) -> Vec<String> {
    let places = outputs.iter().enumerate();
    let warnings = places.flat_map(|(place, output)| output.warnings.iter().map(move |warning| (place, warning)));
    let groups: Vec<(_, Vec<(usize, &Warning)>)> =
        grouped_by_key(warnings.map(|(place, warning)| (discriminant(warning), (place, warning))));
    let names: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
    let mut sentences = Vec::new();
    for (_, warnings) in groups {
        let mut text = warnings[0].1.to_string();
        let mut places: Vec<usize> = warnings.iter().map(|(place, _)| *place).collect();
        places.dedup();
        if outputs.len() > 1 {
            text.push_str(&format!(" ({})", of_which(&names, &places)));
        }
        if warnings.len() > places.len() {
            text.push_str(&format!("; {} similar warnings in the JSON file", warnings.len() - places.len()));
        }
        sentences.push(text);
    }
    sentences
}
