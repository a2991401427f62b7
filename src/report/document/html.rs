//! A document as a page of HTML.

use askama::Template;

use super::anchors::href;
use super::drawing::Drawings;
use super::symbols::{clean, escaped, symbols};
use super::{Cell, Document, Figure, Link, Mark, OnPhone, Part, Section, Table};
use crate::report::chart::Chart;
use crate::report::file_names::{CHARTS, ChartFormat};
use crate::report::format::minus;

/// What the template takes as it is (`safe`) was escaped by [`symbols`], or comes from this program: style, script and
/// charts, which escape their own texts.
#[derive(Template)]
#[template(path = "page/page.html")]
struct PageView<'a> {
    page_title: String,
    kicker: String,
    title: String,
    lead: Vec<String>,
    sections: Vec<SectionView<'a>>,
    footer: String,
    style: &'static str,
    script: &'static str,
    version: &'static str,
}

struct SectionView<'a> {
    id: &'a str,
    title: String,
    body: String,
}

#[derive(Template)]
#[template(path = "page/part.html")]
enum PartView<'a> {
    Text(String),
    Heading(String),
    List(Vec<String>),
    Code(String),
    Links(Vec<LinkView>),
    Notice { mark: &'static str, symbol: &'static str, kind: String, texts: Vec<String> },
    Frame { title: String, html: String },
    Details { summary: String, body: String },
    Gallery { body: String },
    Figure { id: &'a str, words: FigureWords, drawings: Drawings, links: Vec<LinkView> },
    Table(TableView),
}

struct FigureWords {
    label: String,
    title: String,
    caption: String,
    beside: String,
}

struct TableView {
    caption: String,
    label: String,
    header: Vec<(String, bool)>,
    rows: Vec<Vec<CellView>>,
    /// Whether the last row is that of the sums, which stays where it is.
    has_sum: bool,
    stack: &'static str,
}

struct CellView {
    heading: String,
    html: String,
    numeric: bool,
    mark: &'static str,
    symbol: &'static str,
    href: Option<String>,
    note: String,
    links: Vec<LinkView>,
}

struct LinkView {
    html: String,
    href: String,
}

impl Document {
    /// The page: one HTML document that loads nothing from anywhere and links to nothing outside. Style, script and charts
    /// are inside. The same document gives the same bytes. Texts are escaped, so that none can break out of its place;
    /// charts are drawn twice, for a page column and for a phone.
    ///
    /// # Example
    /// ```
    /// use apportion::report::document::{Document, Part, Section};
    ///
    /// let document = Document {
    ///     title: "The critical force".into(),
    ///     lead: vec!["The thickness matters most: its S_T is 0.68.".into()],
    ///     sections: vec![Section::new("shares", "Shares", vec![Part::Text("F_cr grows with the thickness.".into())])],
    ///     ..Document::default()
    /// };
    /// let html = document.html();
    /// assert!(html.starts_with("<!DOCTYPE html>"));
    /// assert!(html.contains("<var>F</var><sub>cr</sub> grows"));
    /// ```
    pub fn html(&self) -> String {
        self.page(&Surroundings { formats: &[], has_files: false })
    }

    /// The page as it stands in its folder: with links to the other files, the charts in these `formats`.
    pub(crate) fn html_in_folder(&self, formats: &[ChartFormat]) -> String {
        self.page(&Surroundings { formats, has_files: true })
    }

    /// The body of the section `id` as it stands on the page, without its heading; `None` if there is no such section.
    pub fn section_html(&self, id: &str) -> Option<String> {
        let section = self.sections.iter().find(|section| section.id == id);
        section.map(|section| Surroundings { formats: &[], has_files: false }.parts(&section.parts))
    }

    fn page(&self, around: &Surroundings<'_>) -> String {
        // Figures have links to their own files.
        let data = if around.has_files { self.data_names() } else { Vec::new() };
        let links = data.into_iter().filter(|name| !name.contains('/')).map(|name| Link::new(name.clone(), name));
        let links: Vec<Link> = links.collect();
        let files = (!links.is_empty()).then(|| Section::new("files", "Files", vec![Part::Links(links)]));
        let view = PageView {
            page_title: clean(&self.title),
            kicker: symbols(&self.kicker),
            title: symbols(&self.title),
            lead: self.lead.iter().map(|text| symbols(text)).collect(),
            sections: self.sections.iter().chain(&files).map(|section| around.section(section)).collect(),
            footer: symbols(&self.footer),
            style: include_str!("../../../templates/page/page.css"),
            script: concat!(
                include_str!("../../../templates/page/page.js"),
                include_str!("../../../templates/page/charts.js")
            ),
            version: env!("CARGO_PKG_VERSION"),
        };
        rendered(&view)
    }
}

/// What lies around a page.
struct Surroundings<'a> {
    formats: &'a [ChartFormat],
    has_files: bool,
}

impl Surroundings<'_> {
    fn section<'a>(&self, section: &'a Section) -> SectionView<'a> {
        SectionView { id: &section.id, title: symbols(&section.title), body: self.parts(&section.parts) }
    }

    fn parts(&self, parts: &[Part]) -> String {
        parts.iter().map(|part| self.part(part)).collect()
    }

    fn part(&self, part: &Part) -> String {
        let all = |texts: &[String]| texts.iter().map(|text| symbols(text)).collect();
        let view = match part {
            Part::OnPage(parts) => return self.parts(parts),
            Part::Text(text) => PartView::Text(symbols(text)),
            Part::Heading(text) => PartView::Heading(symbols(text)),
            Part::List(items) => PartView::List(all(items)),
            Part::Code(text) => PartView::Code(escaped(text)),
            Part::Links(links) => PartView::Links(link_views(links)),
            Part::Notice { mark, kind, texts } => {
                PartView::Notice { mark: mark.class(), symbol: mark.symbol(), kind: symbols(kind), texts: all(texts) }
            }
            Part::Frame { title, html } => PartView::Frame { title: clean(title), html: clean(html) },
            Part::Details { summary, parts } => {
                PartView::Details { summary: symbols(summary), body: self.parts(parts) }
            }
            Part::Figure(figure) => self.figure(figure, Drawings::new),
            Part::Gallery(figures) => {
                let small = figures.iter().map(|figure| rendered(&self.figure(figure, Drawings::small)) + "\n");
                PartView::Gallery { body: small.collect() }
            }
            Part::Table(table) => PartView::Table(table_view(table)),
        };
        rendered(&view).trim_start().to_owned() + "\n"
    }

    fn figure<'a>(&self, figure: &'a Figure, drawings: fn(&str, &Chart) -> Drawings) -> PartView<'a> {
        let drawings = drawings(&figure.id, &figure.chart);
        let words = FigureWords {
            label: symbols(&figure.label),
            title: symbols(figure.title.as_deref().unwrap_or(figure.chart.title())),
            caption: symbols(figure.chart.caption()),
            beside: symbols(&figure.beside),
        };
        let picture = |format: &ChartFormat| {
            let ending = format.ending();
            Link::new(ending.to_uppercase(), format!("{CHARTS}/{}.{ending}", figure.stem))
        };
        let mut links = Vec::new();
        if !figure.stem.is_empty() {
            links.extend(self.formats.iter().map(picture));
        }
        if self.has_files && !figure.data.is_empty() {
            links.push(Link::new("CSV", &figure.data));
        }
        PartView::Figure { id: &figure.id, words, drawings, links: link_views(&links) }
    }
}

fn link_views(links: &[Link]) -> Vec<LinkView> {
    links.iter().map(|link| LinkView { html: symbols(&link.text), href: href(&link.to) }).collect()
}

fn table_view(table: &Table) -> TableView {
    let columns = table.printed_columns();
    let cell = |(cell, (_, heading, numeric)): (&&Cell, &(usize, &str, bool))| CellView {
        heading: clean(heading),
        ..cell_view(cell, *numeric)
    };
    let row = |row: Vec<&Cell>| row.iter().zip(&columns).map(cell).collect();
    let has_headings = columns.iter().any(|(_, heading, _)| !heading.is_empty());
    let header = columns.iter().filter(|_| has_headings).map(|(_, heading, numeric)| (symbols(heading), *numeric));
    TableView {
        caption: symbols(&table.caption),
        label: clean(&table.caption),
        header: header.collect(),
        rows: table.printed_rows().into_iter().map(row).collect(),
        has_sum: !table.sums.is_empty(),
        stack: match table.on_phone {
            OnPhone::Scroll => "",
            OnPhone::Stack => " stack",
            OnPhone::StackLabelled => " stack labelled",
        },
    }
}

fn cell_view(cell: &Cell, numeric: bool) -> CellView {
    CellView {
        heading: String::new(),
        html: if numeric { symbols(&minus(&cell.text)) } else { symbols(&cell.text) },
        numeric,
        mark: cell.mark.class(),
        symbol: cell.mark.symbol(),
        href: cell.to.as_deref().map(href),
        note: symbols(&cell.note),
        links: link_views(&cell.links),
    }
}

impl Mark {
    /// Name of the mark's style; empty without a mark.
    fn class(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Strong => "strong",
            Self::Good => "good",
            Self::Mixed => "mixed",
            Self::Bad => "bad",
        }
    }

    /// The sign of a badge, for those who do not see its colour; empty where there is no badge.
    fn symbol(self) -> &'static str {
        match self {
            Self::Plain | Self::Strong => "",
            Self::Good => "✓",
            Self::Mixed => "◐",
            Self::Bad => "✗",
        }
    }
}

fn rendered(template: &impl Template) -> String {
    template.render().expect("texts, into memory")
}

#[cfg(test)]
mod tests;
