//! The document of one run: the result, its precision, and its method.

mod figures;
mod lead;
mod output;
mod overview;
mod series;
mod shared;
mod tables;

use apportion::analysis::MIN_OUTPUTS_TOGETHER;
use apportion::result::{AccuracyRecord, AggregateRecord, LowFidelityRuns, StudyRecord, StudyResult};
use apportion_base::text::{capitalised, listed};
use figures::Figures;
pub use series::one_output;
use shared::grouped_warnings;
pub(crate) use tables::{FACTORS, IN_CSV};

use super::document::{DataFile, Document, Mark, Part, Section, Table};
use super::format::{grouped, name, printed, significant};
use super::study_sections::{self, study_section, validity_section};
use super::wording::{lines_to_repeat, weighting};

/// Builds the document of a result. All of it comes from the result, so that it can be rebuilt from the JSON file. With
/// one output every topic is a section; with several every output is; with 12 or more there is an overview, and the
/// parts on single outputs are folded. Series come before all other outputs, with a section each.
///
/// # Example
/// ```
/// use std::path::Path;
/// use apportion_report::run_document;
/// use apportion::Study;
///
/// let study = apportion_files::parse_study(include_str!("../../../../studies/ishigami.toml"), Path::new("ishigami.toml"), &[])?;
/// let result = study.run()?;
/// let document = run_document(&result);
/// assert!(document.lead[0].starts_with("For y, x1 matters most"));
/// assert!(document.text().contains("S_T"));
/// assert!(document.html().contains("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_document(result: &StudyResult) -> Document {
    // Series have sections of their own.
    let others = (!result.series.is_empty()).then(|| series::single_outputs(result));
    let single = others.as_ref().unwrap_or(result);
    let (stems, of_series) = figures::stems(result, single);
    let mut sections = series::sections(result, &of_series);
    let is_only = result.series.is_empty() && result.outputs.len() == 1;
    let figures = Figures { result: single, stems: &stems, series: None, is_only };
    let is_many = single.outputs.len() >= MIN_OUTPUTS_TOGETHER;
    sections.extend(if is_many { overview::sections(figures) } else { of_outputs(figures) });
    let figure = |of: &Section| of.parts.iter().position(|part| matches!(part, Part::Figure(_)));
    let first = sections.iter_mut().find_map(|of| Some((figure(of)?, of)));
    if let (Some(callout), Some((figure, of))) = (study_sections::callout(result), first) {
        of.parts.insert(figure + 1, callout);
    }
    sections.extend(validity_section(&result.validity));
    sections.extend(own_ranges(&result.study));
    sections.push(Section::new("cost", "Run time", cost(result)));
    sections.push(study_section(&result.study, &result.factors));
    sections.push(Section::new("provenance", "Provenance", vec![Part::OnPage(provenance(result))]));
    let study = &result.study;
    let mut document = Document {
        name: study.name.clone(),
        kicker: "Result of a study".to_owned(),
        title: study.headline().to_owned(),
        lead: lead::lead(result, single),
        sections,
        footer: format!("Made by apportion {}.", result.provenance.apportion_version),
        files: vec![DataFile::new(format!("{}.json", study.name), result.json())],
        ..Document::default()
    };
    let mut put = |ending: &str, text: String| {
        document.files.push(DataFile::new(format!("{}{ending}", study.name), text));
    };
    put(".csv", tables::indices_csv(result));
    if result.outputs.iter().any(|output| output.second_order.is_some()) {
        put("-second-order.csv", tables::pairs_csv(result));
    }
    if result.outputs.iter().any(|output| output.measures.is_some()) {
        put("-measures.csv", output::measures_csv(result));
    }
    if result.outputs.iter().any(|output| !output.estimators.is_empty()) {
        put("-estimators.csv", tables::estimators_csv(result));
    }
    put("-convergence.csv", tables::convergence_csv(result));
    document.number_figures();
    document
}

/// Builds the sections of a few outputs: one for each, then those of all together.
fn of_outputs(figures: Figures<'_>) -> Vec<Section> {
    let result = figures.result;
    let mut sections = Vec::new();
    if !figures.is_only {
        let warnings = Part::warnings(&grouped_warnings(&result.outputs));
        sections.extend(warnings.map(|part| Section::new("warnings", "Warnings", vec![part])));
    }
    for (number, output) in (1..).zip(&result.outputs) {
        let topics = output::topics(figures, number);
        if figures.is_only {
            sections.extend(topics);
        } else {
            let heading = super::format::heading(&output.name, &output.unit);
            sections.push(Section::new(&format!("output-{number}"), &heading, under_headings(topics)));
        }
    }
    let together = result
        .aggregate
        .as_ref()
        .map(|record| Section::new("together", "All outputs together", together(result, record)));
    sections.extend(together);
    sections
}

/// Joins the parts of all topics, each under its title.
fn under_headings(topics: Vec<Section>) -> Vec<Part> {
    let under = |Section { title, parts, .. }: Section| std::iter::once(Part::Heading(title)).chain(parts);
    topics.into_iter().flat_map(under).collect()
}

/// Describes the indices over all outputs together, or why there are none.
fn together(result: &StudyResult, aggregate: &AggregateRecord) -> Vec<Part> {
    let names: Vec<String> = aggregate.outputs.iter().map(|output| name(output)).collect();
    let mut parts = vec![Part::Text(format!("Of {}: {}.", listed(&names), weighting(aggregate.weighting)))];
    match (&aggregate.indices, &aggregate.reason) {
        (Some(indices), _) => {
            parts.push(tables::aggregate_of(result, &aggregate.outputs, indices, aggregate.noise.as_ref()).into())
        }
        (None, Some(reason)) => parts.push(Part::no_indices(format!("There are no such indices: {reason}."))),
        (None, None) => (),
    }
    parts
}

/// Describes the cost of the run.
fn cost(result: &StudyResult) -> Vec<Part> {
    let provenance = &result.provenance;
    let seconds = provenance.wall_seconds;
    let mut rows = vec![
        ("model runs", grouped(provenance.model_runs)),
        ("base points", format!("{} in {} replicates", grouped(provenance.base_samples), provenance.replicates)),
        ("time", format!("{} s", printed(seconds))),
        ("threads", provenance.threads.to_string()),
    ];
    if provenance.plain_rows > 0 {
        rows.insert(2, ("plain rows of each, for surrogates", provenance.plain_rows.to_string()));
    }
    if seconds > 0.0 {
        let rate = (provenance.model_runs as f64 / seconds).round() as u64;
        rows.push(("runs per second", grouped(rate)));
    }
    let mut parts = vec![Part::OnPage(vec![Table::pairs("Cost of the run.", rows).into()])];
    if let Some(effort) = &result.effort {
        let rungs: Vec<String> = effort.rungs.iter().map(|r| format!("{} {}", r.rung, grouped(r.runs))).collect();
        let rows = [
            ("runs by fidelity", rungs.join(", ")),
            ("evaluations", grouped(effort.evaluations)),
            ("largest error estimate", format!("{:.1e} (relative)", effort.largest_error_estimate)),
        ];
        parts.push(Table::pairs("Fidelities used.", rows).into());
    }
    let low = |low: &LowFidelityRuns| {
        format!(
            "{} ({} at the rows of the model, {} at additional points)",
            low.name,
            grouped(low.shared_runs),
            grouped(low.own_runs)
        )
    };
    if !result.low_fidelity.is_empty() {
        let low_fidelity: Vec<String> = result.low_fidelity.iter().map(low).collect();
        parts.push(Part::Text(format!("Low-fidelity models: {}.", low_fidelity.join(", "))));
    }
    if let Some(spending) = &result.spending {
        parts.push(Part::Notice {
            mark: Mark::Plain,
            kind: "What the run chose".to_owned(),
            texts: chosen(result, spending),
        });
        parts.extend(lines_to_repeat(result).map(Part::Code));
    }
    if let Some(stopping) = &result.stopping {
        let (kind, mark) = match stopping.target_met {
            Some(true) => ("Target met", Mark::Good),
            Some(false) => ("Target not met", Mark::Mixed),
            None => ("Why the run ended", Mark::Plain),
        };
        parts.push(Part::Notice { mark, kind: kind.to_owned(), texts: vec![format!("{}.", stopping.reason)] });
    }
    parts
}

/// Describes what a run with a target accuracy chose, why, and what it saved.
fn chosen(result: &StudyResult, spending: &AccuracyRecord) -> Vec<String> {
    let mut texts: Vec<String> = spending.reasons.iter().map(|reason| format!("{}.", capitalised(reason))).collect();
    let spent = grouped(spending.runs);
    let saved = spending.plain_runs.filter(|plain| *plain > result.provenance.model_runs);
    texts.push(match saved {
        Some(plain) => format!(
            "An accuracy of {} took {spent} runs of the model, trials included; without surrogates and cheaper models it would \
             take {} or more.",
            significant(spending.accuracy),
            grouped(format!("{plain:.1e}", plain = plain as f64).parse::<f64>().unwrap_or_default() as u64)
        ),
        None => format!("An accuracy of {} took {spent} runs of the model, trials included.", significant(spending.accuracy)),
    });
    texts.push("These lines instead of `accuracy` repeat the same run exactly.".to_owned());
    texts
}

/// The anchor of the section on how to try other ranges.
pub const TRY: &str = "try";

/// Explains how to try other ranges: for a study in a single file, with a model that can be computed in a page.
fn own_ranges(study: &StudyRecord) -> Option<Section> {
    let runs_elsewhere = ["command", "external", "custom"].contains(&&*study.model);
    let texts = || std::iter::once(&study.source).chain(&study.overrides);
    let names_files = texts().any(|text| text.replace(' ', "").contains("file="));
    if study.source.is_empty() || runs_elsewhere || names_files {
        return None;
    }
    let changes = if study.overrides.is_empty() { "" } else { ", with the changes of this run," };
    let text = format!(
        "How do the indices change if the factors vary less, or more? `apportion live {}.toml`{changes} makes a page that recomputes them \
         while a range is dragged; it contains the engine of this program and needs no network.",
        study.name
    );
    Some(Section::new(TRY, "Try your own ranges", vec![Part::OnPage(vec![Part::Text(text)])]))
}

/// Describes how the result was computed.
fn provenance(result: &StudyResult) -> Vec<Part> {
    let provenance = &result.provenance;
    let interval = provenance.interval().unwrap_or_else(|| "none: a single replicate".to_owned());
    let rows = [
        ("program", format!("apportion {}", provenance.apportion_version)),
        ("sampler", provenance.sampler.name().to_owned()),
        ("seed", provenance.seed.to_string()),
        ("base points", grouped(provenance.base_samples)),
        ("replicates", provenance.replicates.to_string()),
        ("first-order indices", provenance.first_order_estimator.clone()),
        ("total indices", provenance.total_estimator.clone()),
        ("intervals", interval),
        ("study file, SHA-256", format!("`{}`", provenance.study_sha256)),
    ];
    let files = &provenance.model_files;
    let files = (!files.is_empty()).then(|| ("files of the model that a journal depends on", files.join(", ")));
    let rows = rows.into_iter().chain(files);
    let text = "The same study file, seed and version give the same numbers, on any number of threads. Cite the result by these three, \
                with the digest (SHA-256) for the study file; CITATION.cff in the sources of the program says how to cite the program.";
    vec![Part::Text(text.to_owned()), Table::pairs("How the result was computed.", rows).into()]
}
