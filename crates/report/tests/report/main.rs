//! What results are made into: texts, tables, charts, pages, files.

mod artefacts;
mod atomic_write;
mod chart;
mod comparison;
mod estimates;
mod factor_bars;
mod format;
mod leading;
mod page;
mod run_charts;
mod run_document;
mod study_section;
mod symbols;

use std::path::Path;

use apportion::result::StudyResult;
use apportion::uncertainty::{Estimate, Interval};
use apportion_report::document::{Document, Part, Table};

/// The result of a study.
fn result(text: &str) -> StudyResult {
    let study =
        apportion_files::parse_study(text, Path::new("small.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.runner().threads(1).run().unwrap()
}

/// A result with so many factors x1, x2 and so on, whose numbers a test replaces.
fn of_factors(count: usize) -> StudyResult {
    result(&format!("model = \"linear\"\n[function]\nc = {:?}\n[design]\nbase_samples = 64\n", vec![1.0; count]))
}

/// An estimate in the middle of its interval.
fn between(low: f64, high: f64) -> Estimate {
    Estimate { estimate: (low + high) / 2.0, interval: Some(Interval { low, high }) }
}

/// An estimate with the half width of its interval.
fn about(estimate: f64, half: f64) -> Estimate {
    Estimate { estimate, interval: Some(Interval::about(estimate, half)) }
}

/// The tables of a section, nested ones included.
fn tables<'a>(document: &'a Document, id: &str) -> Vec<&'a Table> {
    fn nested(parts: &[Part]) -> Vec<&Table> {
        let mut tables = Vec::new();
        for part in parts {
            match part {
                Part::Table(table) => tables.push(table),
                Part::Details { parts, .. } | Part::OnPage(parts) => tables.extend(nested(parts)),
                _ => (),
            }
        }
        tables
    }
    let section = document.sections.iter().find(|section| section.id == id).unwrap_or_else(|| panic!("no {id}"));
    nested(&section.parts)
}
