//! The page of one run: what came out, how sure that is, and how it was found, for reading in a browser or on paper.

mod beside;
mod figures;
mod lead;
mod output;
mod study;
mod tables;
mod words;

use beside::Beside;
pub use beside::RUN_CHARTS;
use figures::{Figures, Numbered};
use output::Topic;

use super::listed;
use super::page::{Page, Part, Section};
use super::result::{AggregateRecord, ResultFile};

/// The page of a result; `files` are the names of the files beside it, to which it links. Everything on it comes from
/// the result, so that a page can be drawn again from the JSON file. With one output every topic is a section; with
/// several every output is.
///
/// # Example
/// ```
/// use std::path::Path;
/// use apportion::report::{ResultFile, run_page};
/// use apportion::study::Study;
///
/// let study = Study::parse(include_str!("../../../studies/ishigami.toml"), Path::new("ishigami.toml"), &[])?;
/// let result = ResultFile::new(&study, &study.run()?);
/// let page = run_page(&result, &["ishigami.csv".to_owned()]);
/// assert!(page.lead[0].starts_with("x1 matters most for y"));
/// assert!(page.html()?.contains("href=\"ishigami.csv\""));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_page(result: &ResultFile, files: &[String]) -> Page {
    let beside = Beside { files, study: &result.study.name };
    let mut figures = Figures { result, beside, count: 0 };
    let mut sections = Vec::new();
    let single = result.outputs.len() == 1;
    for (place, output) in result.outputs.iter().enumerate() {
        let topics = output::topics(&mut figures, Numbered { output, number: place + 1 });
        if single {
            sections.extend(topics.into_iter().map(|Topic { id, title, parts }| section(id, title, parts)));
        } else {
            let mut parts = Vec::new();
            for Topic { title, parts: more, .. } in topics {
                parts.push(Part::Heading(title.to_owned()));
                parts.extend(more);
            }
            sections.push(section(&format!("output-{}", place + 1), &output::heading(output), parts));
        }
    }
    sections.extend(
        result.aggregate.as_ref().map(|aggregate| section("together", "All outputs together", together(aggregate))),
    );
    let whole = [
        ("validity", "Where the model holds", study::validity(result)),
        ("cost", "Cost", study::cost(result)),
        ("study", "The study", study::study(result)),
        ("provenance", "Provenance", study::provenance(result)),
        ("files", "Files", if files.is_empty() { Vec::new() } else { vec![beside.all()] }),
    ];
    sections.extend(
        whole.into_iter().filter(|(_, _, parts)| !parts.is_empty()).map(|(id, title, parts)| section(id, title, parts)),
    );
    Page {
        kicker: "Result of a study".to_owned(),
        title: result.study.title.clone().unwrap_or_else(|| result.study.name.clone()),
        lead: lead::lead(result),
        sections,
        footer: format!("Made by apportion {}.", result.provenance.apportion_version),
    }
}

fn section(id: &str, title: &str, parts: Vec<Part>) -> Section {
    Section { id: id.to_owned(), title: title.to_owned(), parts }
}

/// The indices over all outputs together, or why there are none.
fn together(aggregate: &AggregateRecord) -> Vec<Part> {
    let outputs: Vec<String> = aggregate.outputs.iter().map(|output| words::name(output)).collect();
    let mut parts = vec![Part::Text(format!("Of {}: {}.", listed(&outputs), aggregate.weighting))];
    match (&aggregate.indices, &aggregate.reason) {
        (Some(indices), _) => parts.push(tables::aggregate(indices)),
        (None, Some(reason)) => parts.push(Part::Text(format!("There are no such indices: {reason}."))),
        (None, None) => (),
    }
    parts
}

#[cfg(test)]
mod tests;
