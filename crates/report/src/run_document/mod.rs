//! The document of a run: the result, its precision, and its method.

mod method;
mod output;
mod overview;
mod parts;
mod series;
mod tables;

use apportion::result::StudyResult;
pub use method::lines_to_repeat;
pub(crate) use tables::{FACTORS, IN_CSV};

use super::document::{Document, Report, ReportedStudy, Section};
use super::leading;
use super::output_view::{OutputView, Subject};

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
    let report = report(&OutputView::new(result));
    Report { json: result.json(), files: tables::data_files(result), ..report }.document()
}

/// Builds the document on a single output or series of a result, without data files.
pub fn output_document(result: &StudyResult, subject: Option<Subject<'_>>) -> Document {
    report(&OutputView::one(result, subject)).document()
}

fn report<'a>(view: &OutputView<'a>) -> Report<'a> {
    let result = view.result;
    let study = &result.study;
    let (stems, series_stems) = parts::stems(view);
    let mut report = Report {
        name: study.name.clone(),
        kicker: "Result of a study",
        title: study.headline().to_owned(),
        lead: leading::lead(view),
        first: series::sections(view, &series_stems),
        validity: &result.validity,
        failed_runs: (
            view.all_outputs().map(|output| output.runs_failed).max().unwrap_or(0),
            result.provenance.model_runs,
        ),
        has_callout: true,
        method: vec![Section::new("cost", "Run time", method::cost(result))],
        study: Some(ReportedStudy { record: study, factors: &result.factors, sha256: &result.provenance.study_sha256 }),
        version: &result.provenance.apportion_version,
        citation: method::CITATION,
        provenance: method::provenance(result),
        ..Report::default()
    };
    if view.outputs.len() >= StudyResult::MIN_OUTPUTS_TOGETHER {
        report.first.extend(overview::sections(view));
    } else if view.is_single_output() {
        report.first.extend(output::topics(view, 0, &stems[0]));
        report.then.extend(output::together(view));
    } else {
        report.first.extend(output::warnings_section(view));
        report.outputs = output::reports(view, &stems);
        report.then.extend(output::together(view));
    }
    report
}
