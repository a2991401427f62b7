//! Documents: what a command has to say, made once and then written as a page, a text for the terminal and tables of CSV.
//!
//! A [`Document`] is plain data. [`Document::html`] is its page, [`Document::text`] what a terminal shows, and its files
//! for programs are made by [`Document::data_files`]; [`Artefacts`](crate::Artefacts) writes all of them.
//!
//! A command does not put its document together by hand: it fills in a [`Report`] with what it alone can say, sentences,
//! tables and charts, output by output. [`Report::document`] adds what all commands have in common, in one order and one
//! wording: the first answers, the range of validity, notes, the study, provenance, numbers and file names of figures, JSON and
//! CSV. The columns of a table are said once each, see [`Table::from_rows`]: heading, what is printed, and its name and value in
//! the file.

mod anchors;
mod drawing;
mod html;
mod report;
mod symbols;
mod table;
mod text;

use std::borrow::Cow;

pub use report::{OutputReport, Report};
pub use symbols::symbols;
pub use table::{Cell, Column, Mark, OnPhone, Rows, Table};
pub(crate) use table::{csv, largest};

pub use super::csv::Value;
use crate::chart::Chart;

/// A result to be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// What the names of its files begin with.
    pub name: String,
    /// A few words above the title: what kind of document it is.
    pub kicker: String,
    /// Headline.
    pub title: String,
    /// What decides, a paragraph each.
    pub lead: Vec<String>,
    /// The sections, in order; each is listed in the contents of the page.
    pub sections: Vec<Section>,
    /// The last line.
    pub footer: String,
    /// Charts that are files alone.
    pub charts: Vec<Figure>,
    /// Files for programs, beside those that its tables make.
    pub files: Vec<DataFile>,
}

/// A file for programs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// Its name in the folder of the document, or the path below it.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// A section.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Anchor, unique in the document: letters, digits and hyphens.
    pub id: String,
    /// Heading, also in the contents.
    pub title: String,
    /// What it holds.
    pub parts: Vec<Part>,
}

/// A part of a section.
///
/// Texts are plain; on a page, symbols such as `F_cr`, `F_Y*` or `S_T` in them are set as italic letters with subscripts.
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
    /// Links to files beside the page; terminals do not show them.
    Links(Vec<Link>),
    /// Sentences that must not be overlooked, set off by a mark.
    Notice {
        /// Good, mixed or bad news; a badge with its symbol.
        mark: Mark,
        /// What kind of news in a word or two, such as `warning`.
        kind: String,
        /// The sentences, a paragraph each.
        texts: Vec<String>,
    },
    /// Lines to be read as they were typed, such as a study file.
    Code(String),
    /// Another page set into this one, such as an animation, in a frame as high as its content; not printed.
    Frame {
        /// What it shows, for screen readers.
        title: String,
        /// The whole HTML document.
        html: String,
    },
    /// Parts that are folded on a page until asked for; printed unfolded.
    Details {
        /// What is folded.
        summary: String,
        /// The parts.
        parts: Vec<Part>,
    },
    /// Parts that are for the page alone: what would only fill a terminal.
    OnPage(Vec<Part>),
}

/// A figure with what belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Anchor, unique in the document.
    pub id: String,
    /// What it is called, such as `CHK fig. 6`; may be empty.
    pub label: String,
    /// Its title on the page, where the chart's own one repeats that of the document.
    pub title: Option<String>,
    /// What to compare it with, such as what the paper's figure shows; may be empty.
    pub beside: String,
    /// The chart; its title and caption are set as text of the page, its description as the alternative text.
    pub chart: Chart,
    /// The name of its files, without ending.
    pub stem: String,
    /// The name of the file with its numbers; may be empty.
    pub data: String,
}

/// A link to a file beside the page, or to an anchor on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The words.
    pub text: String,
    /// Where it leads, such as `shares.csv` or `#claims`.
    pub to: String,
}

impl Document {
    /// Its charts: the figures in order, then the files alone.
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

    /// The files for programs: those that are given, then one for all tables that name it, in the order of the document.
    pub fn data_files(&self) -> Vec<Cow<'_, DataFile>> {
        let of_tables = self.tables_by_file().into_iter();
        let of_tables = of_tables.map(|(name, tables)| Cow::Owned(DataFile::new(name, csv(tables))));
        self.files.iter().map(Cow::Borrowed).chain(of_tables).collect()
    }

    /// The files that its tables make, each with its tables in their order.
    fn tables_by_file(&self) -> Vec<(&str, Vec<&Table>)> {
        let mut tables: Vec<&Table> = Vec::new();
        self.visit(&mut |part| {
            if let Part::Table(table) = part
                && !table.file.is_empty()
            {
                tables.push(table);
            }
        });
        let mut files: Vec<(&str, Vec<&Table>)> = Vec::new();
        for table in tables.into_iter().filter(|table| self.files.iter().all(|file| file.name != table.file)) {
            match files.iter_mut().find(|(name, _)| *name == table.file) {
                Some((_, of_file)) => of_file.push(table),
                None => files.push((&table.file, vec![table])),
            }
        }
        files
    }

    /// The names of the files for programs.
    pub fn data_names(&self) -> Vec<String> {
        let of_tables = self.tables_by_file().into_iter().map(|(name, _)| name.to_owned());
        self.files.iter().map(|file| file.name.clone()).chain(of_tables).collect()
    }

    /// These sections of it alone, with their figures numbered through.
    #[must_use]
    pub fn excerpt(mut self, ids: &[&str]) -> Self {
        self.sections.retain(|section| ids.contains(&&*section.id));
        let mut number = 0;
        self.visit_mut(&mut |part| {
            for figure in figures_mut(part).iter_mut().filter(|figure| figure.label.starts_with("Figure ")) {
                number += 1;
                figure.label = format!("Figure {number}");
            }
        });
        self
    }

    fn visit<'a>(&'a self, see: &mut dyn FnMut(&'a Part)) {
        self.sections.iter().for_each(|section| visit(&section.parts, see));
    }

    fn visit_mut(&mut self, change: &mut dyn FnMut(&mut Part)) {
        self.sections.iter_mut().for_each(|section| visit_mut(&mut section.parts, change));
    }
}

/// Shows `see` every part, those inside of others too.
fn visit<'a>(parts: &'a [Part], see: &mut dyn FnMut(&'a Part)) {
    for part in parts {
        see(part);
        if let Part::Details { parts, .. } | Part::OnPage(parts) = part {
            visit(parts, see);
        }
    }
}

/// Lets `change` change every part, those inside of others too.
fn visit_mut(parts: &mut [Part], change: &mut dyn FnMut(&mut Part)) {
    for part in parts {
        change(part);
        if let Part::Details { parts, .. } | Part::OnPage(parts) = part {
            visit_mut(parts, change);
        }
    }
}

/// The figures of a part itself.
fn figures_mut(part: &mut Part) -> &mut [Figure] {
    match part {
        Part::Figure(figure) => std::slice::from_mut(figure),
        Part::Gallery(small) => small,
        _ => &mut [],
    }
}

impl Figure {
    /// Figure `number` of a document: `chart`, whose files are called `stem` and whose numbers are in the file `data`.
    pub fn new(number: usize, chart: Chart, stem: impl Into<String>, data: impl Into<String>) -> Self {
        Self {
            id: format!("figure-{number}"),
            label: format!("Figure {number}"),
            title: None,
            beside: String::new(),
            chart,
            stem: stem.into(),
            data: data.into(),
        }
    }

    /// A figure of a [`Report`], which numbers it: `chart`, whose files are called `stem`.
    pub fn unnumbered(chart: Chart, stem: impl Into<String>) -> Self {
        Self::new(0, chart, stem, "")
    }

    /// The same without the title of the document before that of the chart.
    pub(crate) fn below(self, title: &str) -> Self {
        Self { title: self.own_title(title), ..self }
    }

    /// What the title of the chart says beyond that of the document.
    fn own_title(&self, title: &str) -> Option<String> {
        let own = self.chart.title().strip_prefix(title).and_then(|rest| rest.strip_prefix(": "));
        own.map(apportion::text::capitalised)
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
    /// A file.
    pub fn new(name: impl Into<String>, text: String) -> Self {
        Self { name: name.into(), text }
    }
}

impl Section {
    /// A section.
    pub fn new(id: &str, title: &str, parts: Vec<Part>) -> Self {
        Self { id: id.to_owned(), title: title.to_owned(), parts }
    }
}

impl Part {
    /// Warnings, each a sentence that begins with a small letter and has no full stop.
    pub(crate) fn warnings(warnings: &[String]) -> Option<Self> {
        let texts = warnings.iter().map(|warning| format!("{}.", of_sentence(warning))).collect();
        let kind = "Warning".to_owned();
        (!warnings.is_empty()).then_some(Self::Notice { mark: Mark::Mixed, kind, texts })
    }

    /// Notes, in the same way.
    pub(crate) fn notes(notes: &[String]) -> Option<Self> {
        let texts = notes.iter().map(|note| format!("{}.", apportion::text::capitalised(note))).collect();
        (!notes.is_empty()).then_some(Self::Notice { mark: Mark::Plain, kind: "Note".to_owned(), texts })
    }

    /// A sentence that says why there are no indices.
    pub(crate) fn no_indices(text: String) -> Self {
        Self::Notice { mark: Mark::Bad, kind: "No indices".to_owned(), texts: vec![text] }
    }
}

/// A text as a sentence: names before a colon, as of a factor or a flag, have no capital.
fn of_sentence(text: &str) -> String {
    match text.split_once(": ") {
        Some((name, _)) if !name.contains(' ') || name.ends_with(" runs)") || name.ends_with("(1 run)") => {
            text.to_owned()
        }
        _ => apportion::text::capitalised(text),
    }
}

impl Link {
    /// A link.
    pub fn new(text: impl Into<String>, to: impl Into<String>) -> Self {
        Self { text: text.into(), to: to.into() }
    }
}
