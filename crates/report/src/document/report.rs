//! The content of a command's document, and its conversion to a document.

use apportion::analysis::MIN_OUTPUTS_TOGETHER;
use apportion::result::{StudySetup, ValidityRecord};

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
    /// The study that was run.
    pub study: Option<&'a StudySetup>,
    /// The version of the program that computed it; the current one if it is empty.
    pub version: &'a str,
    /// Provenance: a table of names and values.
    pub provenance: Vec<(&'static str, String)>,
    /// The file `NAME.json`.
    pub json: String,
    /// The CSV file, if no table of the document holds all rows.
    pub csv: Option<Table>,
    /// Suffix of the name of the CSV file, before `.csv`.
    pub csv_ending: &'static str,
}

impl Report<'_> {
    /// Builds the document.
    pub fn document(mut self) -> Document {
        let version = if self.version.is_empty() { env!("CARGO_PKG_VERSION") } else { self.version };
        let answers = self.outputs.iter_mut().map(|output| std::mem::take(&mut output.answer));
        let mut lead = first_answers(answers.filter(|answer| !answer.is_empty()).collect());
        lead.append(&mut self.lead);
        lead.extend(study_sections::sentence(self.validity));
        lead.extend(study_sections::of_failures(self.failed_runs.0, self.failed_runs.1));
        let of_outputs = self.of_outputs();
        let mut sections: Vec<Section> = self.first.into_iter().chain(of_outputs).chain(self.then).collect();
        sections.extend(Part::notes(self.notes).map(|notes| Section::new("notes", "Notes", vec![notes])));
        sections.extend(validity_section(self.validity));
        sections.extend(self.study.map(|study| study_section(study, &study.factors)));
        if !self.provenance.is_empty() {
            let program = [("program", format!("apportion {version}"))].into_iter();
            let digest = self.study.map(|study| ("study file, SHA-256", format!("`{}`", study.sha256)));
            let table = Table::pairs("How the result was computed.", program.chain(self.provenance).chain(digest));
            sections.push(Section::new("provenance", "Provenance", vec![Part::OnPage(vec![table.into()])]));
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
            files: json.into_iter().chain(csv).collect(),
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
                (figure.title, figure.data) = (figure.own_title(&title), data.clone());
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
        let are_many = names.len() >= MIN_OUTPUTS_TOGETHER;
        let section = |(number, (output, stem)): (usize, (OutputReport<'_>, String))| {
            let figure = |(ending, chart)| Figure::unnumbered(chart, format!("{stem}{ending}")).into();
            let parts = Part::warnings(output.warnings).into_iter().chain(output.charts.into_iter().map(figure));
            let parts = parts.chain(output.parts).collect();
            Section::new(&format!("output-{number}"), &heading(output.name, output.unit), parts)
        };
        let sections = (1..).zip(std::mem::take(&mut self.outputs).into_iter().zip(stems)).map(section);
        if !are_many {
            return sections.collect();
        }
        let folded = sections.map(|Section { title, parts, .. }| Part::Details { summary: title, parts });
        vec![Section::new("outputs", "Output by output", folded.collect())]
    }
}
