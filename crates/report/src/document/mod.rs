//! Documents: the result of a command as data, written as a page, a text for the terminal and tables of CSV.
//!
//! A [`Document`] is plain data. [`Document::html`] renders its page, [`Document::text`] the text for a terminal, and
//! [`Document::data_files`] its data files; [`Artefacts`](crate::Artefacts) writes all of them.
//!
//! A command does not build its document itself: it fills in a [`Report`] with its own sentences, tables and charts,
//! output by output. [`Report::document`] adds what all commands have in common, in one order and one wording: the
//! first answers, the range of validity, notes, the study, provenance, numbers and file names of figures, JSON and CSV.
//! The columns of a table are defined once, see [`Table::from_rows`]: heading, printed text, name and value in the
//! file.

mod html;
mod report;
mod symbols;
mod table;
mod text;

use std::borrow::Cow;

pub use report::{OutputReport, Report, ReportedStudy};
pub use symbols::symbols;
pub use table::{Cell, Column, Mark, OnPhone, Rows, Table};
pub(crate) use table::{csv, largest};

pub use super::csv::Value;
use crate::chart::Chart;

/// A document of a result.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Prefix of the names of its files.
    pub name: String,
    /// The kind of document, in a few words above the title.
    pub kicker: String,
    /// Headline.
    pub title: String,
    /// The main results, a paragraph each.
    pub lead: Vec<String>,
    /// The sections, in order; each is listed in the contents of the page.
    pub sections: Vec<Section>,
    /// The last line.
    pub footer: String,
    /// Charts that are written to files only.
    pub charts: Vec<Figure>,
    /// Data files in addition to those of its tables.
    pub files: Vec<DataFile>,
}

/// A data file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// Its name in the folder of the document, or the path below it.
    pub name: String,
    /// Its content.
    pub text: String,
}

/// A section.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Anchor, unique in the document: letters, digits and hyphens.
    pub id: String,
    /// Heading, also in the contents.
    pub title: String,
    /// Its content.
    pub parts: Vec<Part>,
}

/// A part of a section.
///
/// Texts are plain; on a page, symbols in them such as `F_cr`, `F_Y*` or `S_T` are set in italics with subscripts.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// A paragraph.
    Text(String),
    /// A heading inside the section.
    Heading(String),
    /// A list.
    List(Vec<String>),
    /// A figure; terminals do not show it.
    Figure(Box<Figure>),
    /// Small figures, two side by side where there is room; terminals do not show them.
    Gallery(Vec<Figure>),
    /// A table.
    Table(Table),
    /// Links to files next to the page; terminals do not show them.
    Links(Vec<Link>),
    /// Important sentences, set off by a mark.
    Notice {
        /// Good, mixed or bad news; a badge with its symbol.
        mark: Mark,
        /// The kind of news in a word or two, such as `warning`.
        kind: String,
        /// The sentences, a paragraph each.
        texts: Vec<String>,
    },
    /// Lines shown verbatim, such as a study file.
    Code(String),
    /// Another page embedded in this one, such as an animation, in a frame as high as its content; not printed.
    Frame {
        /// Its description for screen readers.
        title: String,
        /// The whole HTML document.
        html: String,
    },
    /// Parts that are folded on a page until opened; printed unfolded.
    Details {
        /// The summary of the folded parts.
        summary: String,
        /// The parts.
        parts: Vec<Part>,
    },
    /// Parts for the page only, which are too long for a terminal.
    OnPage(Vec<Part>),
}

/// A figure with its label, files and texts.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Anchor, unique in the document.
    pub id: String,
    /// Its label, such as `CHK fig. 6`; may be empty.
    pub label: String,
    /// Its title on the page, if the title of the chart repeats that of the document.
    pub title: Option<String>,
    /// What to compare it with, such as what the paper's figure shows; may be empty.
    pub comparison_note: String,
    /// The chart; its title and caption are set as text of the page, its description as the alternative text.
    pub chart: Chart,
    /// The name of its files, without ending.
    pub stem: String,
    /// The name of the file with its numbers; may be empty.
    pub data: String,
}

/// A link to a file next to the page, or to an anchor on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The words.
    pub text: String,
    /// The target, such as `shares.csv` or `#claims`.
    pub to: String,
}

impl Document {
    /// Returns its charts: the figures in order, then those that are files only.
    pub fn figures(&self) -> Vec<&Figure> {
        let mut figures = Vec::new();
        self.visit(&mut |part| match part {
            Part::Figure(figure) => figures.push(&**figure),
            Part::Gallery(small) => figures.extend(small),
            _ => (),
        });
        figures.extend(&self.charts);
        figures
    }

    /// Returns the data files: the given ones, then one for all tables that name it, in the order of the document.
    pub fn data_files(&self) -> Vec<Cow<'_, DataFile>> {
        let of_tables = self.tables_by_file().into_iter();
        let of_tables = of_tables.map(|(name, tables)| Cow::Owned(DataFile::new(name, csv(tables))));
        self.files.iter().map(Cow::Borrowed).chain(of_tables).collect()
    }

    /// Returns the files of its tables, each with its tables in order.
    fn tables_by_file(&self) -> Vec<(&str, Vec<&Table>)> {
        let mut tables: Vec<&Table> = Vec::new();
        self.visit(&mut |part| {
            if let Part::Table(table) = part
                && !table.file.is_empty()
            {
                tables.push(table);
            }
        });
        let tables = tables.into_iter().filter(|table| self.files.iter().all(|file| file.name != table.file));
        grouped_by_key(tables.map(|table| (table.file.as_str(), table)))
    }

    /// Returns the names of the data files.
    pub fn data_names(&self) -> Vec<String> {
        let of_tables = self.tables_by_file().into_iter().map(|(name, _)| name.to_owned());
        self.files.iter().map(|file| file.name.clone()).chain(of_tables).collect()
    }

    /// Keeps only these sections and renumbers their figures.
    #[must_use]
    pub fn excerpt(mut self, ids: &[&str]) -> Self {
        self.sections.retain(|section| ids.contains(&&*section.id));
        self.number_figures();
        self
    }

    /// Numbers the figures in order, except those whose label is set.
    pub(crate) fn number_figures(&mut self) {
        let mut number = 0;
        self.visit_mut(&mut |part| {
            for figure in figures_mut(part).iter_mut().filter(|figure| figure.label.starts_with("Figure ")) {
                number += 1;
                figure.label = format!("Figure {number}");
                if figure.id == UNNUMBERED {
                    figure.id = format!("figure-{number}");
                }
            }
        });
    }

    fn visit<'a>(&'a self, see: &mut dyn FnMut(&'a Part)) {
        self.sections.iter().for_each(|section| visit(&section.parts, see));
    }

    fn visit_mut(&mut self, change: &mut dyn FnMut(&mut Part)) {
        self.sections.iter_mut().for_each(|section| visit_mut(&mut section.parts, change));
    }
}

/// Groups items by their keys, in the order of first occurrence.
pub(crate) fn grouped_by_key<K: PartialEq, V>(items: impl IntoIterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut groups: Vec<(K, Vec<V>)> = Vec::new();
    for (key, item) in items {
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, group)) => group.push(item),
            None => groups.push((key, vec![item])),
        }
    }
    groups
}

/// Calls `see` for every part, nested ones included.
fn visit<'a>(parts: &'a [Part], see: &mut dyn FnMut(&'a Part)) {
    for part in parts {
        see(part);
        if let Part::Details { parts, .. } | Part::OnPage(parts) = part {
            visit(parts, see);
        }
    }
}

/// Calls `change` for every part, nested ones included.
fn visit_mut(parts: &mut [Part], change: &mut dyn FnMut(&mut Part)) {
    for part in parts {
        change(part);
        if let Part::Details { parts, .. } | Part::OnPage(parts) = part {
            visit_mut(parts, change);
        }
    }
}

/// Returns the figures of a part itself.
fn figures_mut(part: &mut Part) -> &mut [Figure] {
    match part {
        Part::Figure(figure) => std::slice::from_mut(figure),
        Part::Gallery(small) => small,
        _ => &mut [],
    }
}

/// The anchor of a figure that has no number yet.
const UNNUMBERED: &str = "figure-0";

impl Figure {
    /// Creates a figure that its document numbers: `chart`, with files named `stem`.
    pub fn unnumbered(chart: Chart, stem: impl Into<String>) -> Self {
        Self {
            id: UNNUMBERED.to_owned(),
            label: "Figure ".to_owned(),
            title: None,
            comparison_note: String::new(),
            chart,
            stem: stem.into(),
            data: String::new(),
        }
    }

    /// Returns the part of the chart's title after that of the document.
    pub(crate) fn title_after(&self, title: &str) -> Option<String> {
        let rest = self.chart.title.strip_prefix(title)?.strip_prefix(": ")?;
        Some(apportion_base::text::capitalised(rest))
    }
}

impl From<Figure> for Part {
    fn from(figure: Figure) -> Self {
        Self::Figure(Box::new(figure))
    }
}

impl From<Table> for Part {
    fn from(table: Table) -> Self {
        Self::Table(table)
    }
}

impl DataFile {
    /// Creates a file.
    pub fn new(name: impl Into<String>, text: String) -> Self {
        Self { name: name.into(), text }
    }
}

impl Section {
    /// Creates a section.
    pub fn new(id: &str, title: &str, parts: Vec<Part>) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), parts }
    }
}

impl Part {
    /// Lists warnings, each a sentence that begins with a lower-case letter and has no full stop.
    pub(crate) fn warnings(warnings: &[String]) -> Option<Self> {
        let texts = warnings.iter().map(|warning| format!("{}.", as_sentence(warning))).collect();
        let kind = "Warning".to_owned();
        (!warnings.is_empty()).then_some(Self::Notice { mark: Mark::Mixed, kind, texts })
    }

    /// Lists notes in the same way.
    pub(crate) fn notes(notes: &[String]) -> Option<Self> {
        let texts = notes.iter().map(|note| format!("{}.", apportion_base::text::capitalised(note))).collect();
        (!notes.is_empty()).then_some(Self::Notice { mark: Mark::Plain, kind: "Note".to_owned(), texts })
    }

    /// Creates a sentence that says why there are no indices.
    pub(crate) fn no_indices(text: String) -> Self {
        Self::Notice { mark: Mark::Bad, kind: "No indices".to_owned(), texts: vec![text] }
    }
}

/// Formats a text as a sentence: a name before a colon, such as a factor or a flag, is not capitalised.
fn as_sentence(text: &str) -> String {
    match text.split_once(": ") {
        Some((name, _)) if !name.contains(' ') || name.ends_with(" runs)") || name.ends_with("(1 run)") => {
            text.to_owned()
        }
        _ => apportion_base::text::capitalised(text),
    }
}

impl Link {
    /// Creates a link.
    pub fn new(text: impl Into<String>, to: impl Into<String>) -> Self {
        Self { text: text.into(), to: to.into() }
    }
}
