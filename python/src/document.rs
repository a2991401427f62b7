//! Results as documents: text, page, charts and files.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::LazyLock;

use apportion::StudyResult;
use apportion::result::parse_result;
use apportion::uncertainty::{Estimate, Interval};
use apportion_report::chart::ChartWidth;
use apportion_report::document::Part;
use apportion_report::given::given_document;
use apportion_report::screening::screening_document;
use apportion_report::sweep::sweep_document;
use apportion_report::{Artefacts, ChartFormat, give_or_take, run_document};
use pyo3::prelude::*;

use crate::errors::{failed, input};

type Described = apportion_report::Document;

/// What a command has to say, with the JSON that it is made from.
#[pyclass(frozen)]
pub struct Document {
    name: String,
    json: String,
    /// Made when it is asked for: of a thousand outputs it takes longer than their indices.
    document: LazyLock<Described, Box<dyn FnOnce() -> Described + Send>>,
}

impl Document {
    /// The JSON is one of the document's files.
    pub fn new(document: Described) -> Self {
        let json = document.files.iter().find(|file| file.name.ends_with(".json"));
        let json = json.map(|file| file.text.clone()).unwrap_or_default();
        Self { name: document.name.clone(), json, document: LazyLock::new(Box::new(move || document)) }
    }
}

impl From<StudyResult> for Document {
    fn from(result: StudyResult) -> Self {
        let (name, json) = (result.study.name.clone(), result.json());
        Self { name, json, document: LazyLock::new(Box::new(move || run_document(&result))) }
    }
}

#[pymethods]
impl Document {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// What decides, a sentence or two each.
    #[getter]
    fn lead(&self) -> Vec<String> {
        self.document.lead.clone()
    }

    fn json(&self) -> &str {
        &self.json
    }

    fn text(&self) -> String {
        self.document.text()
    }

    fn html(&self) -> String {
        self.document.html()
    }

    /// The charts as (title, SVG), in the order of the page.
    fn charts(&self) -> PyResult<Vec<(String, String)>> {
        let mut charts = Vec::new();
        for section in &self.document.sections {
            collect(&section.parts, &mut charts)?;
        }
        Ok(charts)
    }

    /// The tables for programs, as (name, CSV).
    fn tables(&self) -> Vec<(String, String)> {
        let files = self.document.data_files().into_iter().map(Cow::into_owned);
        files.map(|file| (file.name, file.text)).collect()
    }

    /// Writes the page, the JSON and CSV files and the charts in these formats to `folder`, `width` wide on paper; returns the path
    /// of the page.
    fn save(&self, py: Python<'_>, folder: PathBuf, formats: Vec<String>, width: Option<String>) -> PyResult<PathBuf> {
        let known = |name: String| {
            let format = ChartFormat::ALL.into_iter().find(|format| format.name() == name);
            format.ok_or_else(|| input(format!("charts: {name:?} is none of \"svg\", \"png\" and \"pdf\"")))
        };
        let formats = formats.into_iter().map(known).collect::<PyResult<_>>()?;
        let width = width.map(|width| width.parse().map(ChartWidth::Paper).map_err(input)).transpose()?;
        let artefacts = Artefacts { formats, width: width.unwrap_or_default(), ..Artefacts::new(folder) };
        let written = py.detach(|| artefacts.write(&self.document));
        written.map(|written| written.page).map_err(failed)
    }
}

fn collect(parts: &[Part], charts: &mut Vec<(String, String)>) -> PyResult<()> {
    for part in parts {
        match part {
            Part::Figure(figure) => {
                charts.push((figure.chart.title.clone(), figure.chart.svg()));
            }
            Part::Details { parts, .. } | Part::OnPage(parts) => collect(parts, charts)?,
            _ => (),
        }
    }
    Ok(())
}

/// An index with its interval as the text prints it.
#[pyfunction]
pub fn in_words(estimate: f64, low: f64, high: f64) -> String {
    let interval = Some(Interval { low, high }).filter(|interval| !interval.low.is_nan());
    give_or_take(Estimate { estimate, interval })
}

/// The document of a JSON file that was written, called `name` where the file does not say it.
#[pyfunction]
pub fn read_document(json: &str, name: &str) -> PyResult<Document> {
    let of = |error: serde_json::Error| input(error.to_string());
    let format = serde_json::from_str::<serde_json::Value>(json).map_err(of)?["format"].take();
    Ok(match format.as_str() {
        Some("apportion-screening") => Document::new(screening_document(&serde_json::from_str(json).map_err(of)?)),
        Some("apportion-sweep") => Document::new(sweep_document(&serde_json::from_str(json).map_err(of)?)),
        Some("apportion-given-data") => Document::new(given_document(&serde_json::from_str(json).map_err(of)?, name)),
        _ => parse_result(json.as_bytes()).map_err(input)?.into(),
    })
}
