//! The content of a command's document, and its conversion to a document.

use apportion::StudyResult;
use apportion::result::{FactorRecord, StudyRecord, StudySetup, ValidityRecord};

use super::{DataFile, Document, Figure, Part, Section, Table, UNNUMBERED, figures_mut};
use crate::chart::Chart;
use crate::file_stems;
use crate::format::heading;
use crate::leading::first_answers;
use crate::study_sections::{self, study_section, validity_section};

/// The report on one output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutputReport<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its unit; may be empty.
    pub unit: &'a str,
    /// Warnings, sentences without capital and full stop.
    pub warnings: &'a [String],
    /// Its result in a sentence, for the top of the document.
    pub answer: String,
    /// Its parts.
    pub parts: Vec<Part>,
    /// Its charts, each with the suffix of its file names.
    pub charts: Vec<(&'static str, Chart)>,
}

/// The study in a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportedStudy<'a> {
    /// The question.
    pub record: &'a StudyRecord,
    /// The factors.
    pub factors: &'a [FactorRecord],
    /// SHA-256 of the study file in hexadecimal.
    pub sha256: &'a str,
}

impl<'a> From<&'a StudySetup> for ReportedStudy<'a> {
    fn from(study: &'a StudySetup) -> Self {
        Self { record: study, factors: &study.factors, sha256: &study.sha256 }
    }
}

/// The report of a command. Empty fields are omitted.
///
/// The sections come in the order of the fields. Figures made by [`Figure::unnumbered`] are numbered in order, and
/// their numbers are in the CSV file, as are the rows of every table that has columns for a file and names none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report<'a> {
    /// Prefix of the names of its files.
    pub name: String,
    /// The kind of document, in a few words.
    pub kicker: &'static str,
    /// Headline.
    pub title: String,
    /// The main results in addition to those of the outputs, a paragraph each.
    pub lead: Vec<String>,
    /// The sections before the outputs.
    pub first: Vec<Section>,
    /// The outputs.
    pub outputs: Vec<OutputReport<'a>>,
    /// The sections after the outputs.
    pub then: Vec<Section>,
    /// Notes, sentences without capital and full stop.
    pub notes: &'a [String],
    /// The number of runs on which the model's assumptions do not hold.
    pub validity: &'a [ValidityRecord],
    /// The numbers of failed model runs and of all model runs.
    pub failed_runs: (u64, u64),
    /// Whether validity and failed runs are set off after the first figure, instead of at the top.
    pub has_callout: bool,
    /// Sections on the method, before that on the study.
    pub method: Vec<Section>,
    /// The study that was run.
    pub study: Option<ReportedStudy<'a>>,
    /// The version of the program that computed it; the current one if it is empty.
    pub version: &'a str,
    /// How to cite the result, before the table of provenance.
    pub citation: &'static str,
    /// Provenance: a table of names and values.
    pub provenance: Vec<(&'static str, String)>,
    /// The file `NAME.json`.
    pub json: String,
    /// The CSV file, if no table of the document holds all rows.
    pub csv: Option<Table>,
    /// Suffix of the name of the CSV file, before `.csv`.
    pub csv_ending: &'static str,
    /// Further data files.
    pub files: Vec<DataFile>,
}

impl Report<'_> {
    /// Builds the document.
    pub fn document(mut self) -> Document {
        let version = if self.version.is_empty() { env!("CARGO_PKG_VERSION") } else { self.version };
        let answers = self.outputs.iter_mut().map(|output| std::mem::take(&mut output.answer));
        let mut lead = first_answers(answers.filter(|answer| !answer.is_empty()).collect());
        lead.append(&mut self.lead);
        let of_outputs = self.of_outputs();
        let mut sections: Vec<Section> = self.first.into_iter().chain(of_outputs).chain(self.then).collect();
        if self.has_callout {
            insert_after_figure(&mut sections, study_sections::callout(self.validity, self.failed_runs));
        } else {
            lead.extend(study_sections::sentence(self.validity));
            lead.extend(study_sections::of_failures(self.failed_runs));
        }
        sections.extend(Part::notes(self.notes).map(|notes| Section::new("notes", "Notes", vec![notes])));
        sections.extend(validity_section(self.validity));
        sections.extend(self.method);
        sections.extend(self.study.map(|study| study_section(study.record, study.factors)));
        if !self.provenance.is_empty() {
            let program = [("program", format!("apportion {version}"))].into_iter();
            let digest = self.study.map(|study| ("study file, SHA-256", format!("`{}`", study.sha256)));
            let table = Table::pairs("How the result was computed.", program.chain(self.provenance).chain(digest));
            let citation = (!self.citation.is_empty()).then(|| Part::Text(self.citation.to_owned()));
            let parts = citation.into_iter().chain([table.into()]).collect();
            sections.push(Section::new("provenance", "Provenance", vec![Part::OnPage(parts)]));
        }
        sections.retain(|section| !section.parts.is_empty());
        let data = format!("{}{}.csv", self.name, self.csv_ending);
        let json = (!self.json.is_empty()).then(|| DataFile::new(format!("{}.json", self.name), self.json));
        let csv = self.csv.map(|table| DataFile::new(data.clone(), table.csv()));
        let mut document = Document {
            kicker: self.kicker.to_owned(),
            lead,
            sections,
            footer: format!("Made by apportion {version}."),
            files: json.into_iter().chain(csv).chain(self.files).collect(),
            name: self.name,
            title: self.title,
            charts: Vec::new(),
        };
        let title = document.title.clone();
        document.visit_mut(&mut |part| {
            if let Part::Table(table) = part
                && table.file.is_empty()
                && table.has_fields()
            {
                table.file.clone_from(&data);
            }
            for figure in figures_mut(part).iter_mut().filter(|figure| figure.id == UNNUMBERED) {
                (figure.title, figure.data) = (figure.title_after(&title), data.clone());
            }
        });
        document.number_figures();
        document
    }

    /// Builds a section for each output, with its warnings first, then its charts; many outputs share one section,
    /// in which each is folded.
    fn of_outputs(&mut self) -> Vec<Section> {
        let names: Vec<&str> = self.outputs.iter().map(|output| output.name).collect();
        let charts = self.outputs.iter().flat_map(|output| &output.charts);
        let mut endings: Vec<&str> = charts.map(|(ending, _)| *ending).collect();
        endings.sort_unstable();
        endings.dedup();
        let stems = file_stems(&self.name, &names, &endings);
        let are_many = names.len() >= StudyResult::MIN_OUTPUTS_TOGETHER;
        let mut sections = Vec::new();
        for ((number, output), stem) in (1..).zip(std::mem::take(&mut self.outputs)).zip(stems) {
            let mut parts: Vec<Part> = Part::warnings(output.warnings).into_iter().collect();
            for (ending, chart) in output.charts {
                parts.push(Figure::unnumbered(chart, format!("{stem}{ending}")).into());
            }
            parts.extend(output.parts);
            sections.push(Section::new(&format!("output-{number}"), &heading(output.name, output.unit), parts));
        }
        if !are_many {
            return sections;
        }
        let folded = sections.into_iter().map(|Section { title, parts, .. }| Part::Details { summary: title, parts });
        vec![Section::new("outputs", "Output by output", folded.collect())]
    }
}

/// Inserts a part after the first figure of a document, if there is one.
fn insert_after_figure(sections: &mut [Section], part: Option<Part>) {
    for section in sections {
        if let Some(place) = section.parts.iter().position(|part| matches!(part, Part::Figure(_))) {
            section.parts.splice(place + 1..place + 1, part);
            return;
        }
    }
}
