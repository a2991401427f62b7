//! A document as a page of HTML.

use askama::Template;

use super::symbols::{clean, escaped, href, symbols};
use super::{Document, Figure, Link, Mark, OnPhone, Part, Section, Table};
use crate::chart::ChartWidth;
use crate::file_names::{CHARTS, ChartFormat};
use crate::format::minus;

/// Values that the templates insert unescaped (`safe`) were escaped by [`symbols`], or come from this program: style,
/// script and charts, which escape their own texts.
#[derive(Template)]
#[template(path = "page/page.html")]
struct PageView<'a> {
    document: &'a Document,
    sections: Vec<&'a Section>,
    around: Surroundings<'a>,
    style: &'static str,
    script: &'static str,
    version: &'static str,
}

#[derive(Template)]
#[template(path = "page/part.html")]
struct PartView<'a> {
    part: &'a Part,
    around: Surroundings<'a>,
}

#[derive(Template)]
#[template(path = "page/figure.html")]
struct FigureView<'a> {
    figure: &'a Figure,
    /// The drawing for a column; `None` for a small figure.
    wide: Option<String>,
    /// The drawing for a phone, or half of a column.
    narrow: String,
    links: Vec<Link>,
}

impl Document {
    /// Renders the page: one HTML document that loads nothing and has no external links. Style, script and charts are
    /// inside. The same document gives the same bytes. Texts are escaped, so that none can become markup; charts are
    /// drawn twice, for a page column and for a phone.
    ///
    /// # Example
    /// ```
    /// use apportion_report::document::{Document, Part, Section};
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
        self.page(Surroundings::default())
    }

    /// Renders the page in its folder: with links to the other files, the charts in these `formats`.
    pub(crate) fn html_in_folder(&self, formats: &[ChartFormat]) -> String {
        self.page(Surroundings { formats, has_files: true })
    }

    /// Renders the body of the section `id` without its heading; `None` if there is no such section.
    pub fn section_html(&self, id: &str) -> Option<String> {
        let section = self.sections.iter().find(|section| section.id == id);
        section.map(|section| Surroundings::default().parts(&section.parts))
    }

    fn page(&self, around: Surroundings<'_>) -> String {
        // Figures link to their own files.
        let data = if around.has_files { self.data_names() } else { Vec::new() };
        let links = data.into_iter().filter(|name| !name.contains('/')).map(|name| Link::new(name.clone(), name));
        let links: Vec<Link> = links.collect();
        let files = (!links.is_empty()).then(|| Section::new("files", "Files", vec![Part::Links(links)]));
        rendered(&PageView {
            document: self,
            sections: self.sections.iter().chain(&files).collect(),
            around,
            style: include_str!("../../templates/page/page.css"),
            script: concat!(
                include_str!("../../templates/page/page.js"),
                include_str!("../../templates/page/charts.js")
            ),
            version: env!("CARGO_PKG_VERSION"),
        })
    }
}

/// The context of a page.
#[derive(Clone, Copy, Default)]
struct Surroundings<'a> {
    /// Formats of the charts.
    formats: &'a [ChartFormat],
    /// Whether there are files at all.
    has_files: bool,
}

impl Surroundings<'_> {
    fn parts(&self, parts: &[Part]) -> String {
        parts.iter().map(|part| self.part(part)).collect()
    }

    fn part(&self, part: &Part) -> String {
        match part {
            Part::OnPage(parts) => self.parts(parts),
            part => rendered(&PartView { part, around: *self }).trim_start().to_owned() + "\n",
        }
    }

    /// Renders a figure, drawn for a column and for a phone, or a small one.
    fn figure(&self, figure: &Figure, is_small: bool) -> String {
        let mut links = Vec::new();
        for format in self.formats.iter().filter(|_| !figure.stem.is_empty()) {
            let ending = format.name();
            links.push(Link::new(ending.to_uppercase(), format!("{CHARTS}/{}.{ending}", figure.stem)));
        }
        if self.has_files && !figure.data.is_empty() {
            links.push(Link::new("CSV", &figure.data));
        }
        let wide = (!is_small).then(|| figure.chart.inline(ChartWidth::Wide, &format!("{}-wide", figure.id)));
        let narrow = figure.chart.inline(ChartWidth::Narrow, &format!("{}-narrow", figure.id));
        rendered(&FigureView { figure, wide, narrow, links })
    }
}

impl FigureView<'_> {
    fn title(&self) -> &str {
        self.figure.title.as_deref().unwrap_or(&self.figure.chart.title)
    }
}

impl Table {
    fn has_headings(&self) -> bool {
        self.printed_columns().iter().any(|(_, heading, _)| !heading.is_empty())
    }
}

impl OnPhone {
    fn class(self) -> &'static str {
        match self {
            Self::Scroll => "",
            Self::Stack => " stack",
            Self::StackLabelled => " stack labelled",
        }
    }
}

impl Mark {
    /// Returns the class of the mark; empty without a mark.
    fn class(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Strong => "strong",
            Self::Good => "good",
            Self::Mixed => "mixed",
            Self::Bad => "bad",
        }
    }

    /// Returns the sign of a badge, for readers who do not see its colour; empty without a badge.
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
