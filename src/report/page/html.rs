//! From the data of a page to its bytes.

use askama::Template;
use thiserror::Error;

use super::anchors::{check, href};
use super::drawing::{Drawings, drawings};
use super::symbols::{clean, escaped, symbols};
use super::{Cell, Link, Mark, OnPhone, Page, PageFigure, PageTable, Part};
use crate::report::chart::ChartError;

/// Why a page could not be made.
#[derive(Debug, Error)]
pub enum PageError {
    /// A template cannot be rendered.
    #[error("cannot make the page: {0}")]
    Template(#[from] askama::Error),
    /// A chart cannot be drawn.
    #[error("cannot draw figure {figure:?} of the page: {source}")]
    Chart {
        /// Anchor of the figure.
        figure: String,
        /// Why.
        source: ChartError,
    },
    /// An anchor of which a browser could make nothing.
    #[error("the anchor {id:?} of the page {problem}")]
    Anchor {
        /// The anchor.
        id: String,
        /// What is wrong with it.
        problem: &'static str,
    },
}

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

impl Page {
    /// The page as one HTML document that loads nothing from anywhere: style, script and charts are inside, and only its
    /// links lead to files beside it. The same page gives the same bytes. Texts are escaped, so that none can break out
    /// of its place; charts are drawn twice, for a page column and for a phone.
    ///
    /// # Errors
    /// [`PageError`] if a chart cannot be drawn, or an anchor is malformed, there twice, or linked to and missing.
    ///
    /// # Example
    /// ```
    /// use apportion::report::page::{Page, Part, Section};
    ///
    /// let page = Page {
    ///     kicker: "A study".into(),
    ///     title: "The critical force".into(),
    ///     lead: vec!["The thickness matters most: its S_T is 0.68.".into()],
    ///     sections: vec![Section {
    ///         id: "shares".into(),
    ///         title: "Shares".into(),
    ///         parts: vec![Part::Text("F_cr grows with the thickness.".into())],
    ///     }],
    ///     footer: "Made by hand.".into(),
    /// };
    /// let html = page.html()?;
    /// assert!(html.starts_with("<!DOCTYPE html>"));
    /// assert!(html.contains("<var>F</var><sub>cr</sub> grows"));
    /// # Ok::<(), apportion::report::page::PageError>(())
    /// ```
    pub fn html(&self) -> Result<String, PageError> {
        check(self)?;
        let section = |section: &'_ super::Section| -> Result<(String, String), PageError> {
            Ok((symbols(&section.title), parts_html(&section.parts)?))
        };
        let mut sections = Vec::with_capacity(self.sections.len());
        for one in &self.sections {
            let (title, body) = section(one)?;
            sections.push(SectionView { id: &one.id, title, body });
        }
        let view = PageView {
            page_title: clean(&self.title),
            kicker: symbols(&self.kicker),
            title: symbols(&self.title),
            lead: self.lead.iter().map(|text| symbols(text)).collect(),
            sections,
            footer: symbols(&self.footer),
            style: include_str!("../../../templates/page/page.css"),
            script: include_str!("../../../templates/page/page.js"),
            version: env!("CARGO_PKG_VERSION"),
        };
        Ok(view.render()?)
    }
}

fn parts_html(parts: &[Part]) -> Result<String, PageError> {
    let mut html = String::new();
    for part in parts {
        html.push_str(part_view(part)?.render()?.trim_start());
        html.push('\n');
    }
    Ok(html)
}

fn part_view(part: &Part) -> Result<PartView<'_>, PageError> {
    let all = |texts: &[String]| texts.iter().map(|text| symbols(text)).collect();
    Ok(match part {
        Part::Text(text) => PartView::Text(symbols(text)),
        Part::Heading(text) => PartView::Heading(symbols(text)),
        Part::List(items) => PartView::List(all(items)),
        Part::Code(text) => PartView::Code(escaped(text)),
        Part::Links(links) => PartView::Links(link_views(links)),
        Part::Notice { mark, kind, texts } => {
            PartView::Notice { mark: mark.class(), symbol: mark.symbol(), kind: symbols(kind), texts: all(texts) }
        }
        Part::Frame { title, html } => PartView::Frame { title: clean(title), html: clean(html) },
        Part::Details { summary, parts } => PartView::Details { summary: symbols(summary), body: parts_html(parts)? },
        Part::Figure(figure) => figure_view(figure)?,
        Part::Table(table) => PartView::Table(table_view(table)),
    })
}

fn figure_view(figure: &PageFigure) -> Result<PartView<'_>, PageError> {
    let drawings =
        drawings(&figure.id, &figure.chart).map_err(|source| PageError::Chart { figure: figure.id.clone(), source })?;
    let words = FigureWords {
        label: symbols(&figure.label),
        title: symbols(figure.chart.title()),
        caption: symbols(figure.chart.caption()),
        beside: symbols(&figure.beside),
    };
    Ok(PartView::Figure { id: &figure.id, words, drawings, links: link_views(&figure.links) })
}

fn link_views(links: &[Link]) -> Vec<LinkView> {
    links.iter().map(|link| LinkView { html: symbols(&link.text), href: href(&link.to) }).collect()
}

fn table_view(table: &PageTable) -> TableView {
    let numeric = |column: usize| table.numeric.contains(&column);
    let heading = |column: usize| table.header.get(column).map_or_else(String::new, |text| clean(text));
    let cell =
        |(column, cell): (usize, &Cell)| CellView { heading: heading(column), ..cell_view(cell, numeric(column)) };
    let row = |row: &Vec<Cell>| row.iter().enumerate().map(cell).collect();
    TableView {
        caption: symbols(&table.caption),
        label: clean(&table.caption),
        header: table.header.iter().enumerate().map(|(column, text)| (symbols(text), numeric(column))).collect(),
        rows: table.rows.iter().map(row).collect(),
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
        html: if numeric { number(&cell.text) } else { symbols(&cell.text) },
        numeric,
        mark: cell.mark.class(),
        symbol: cell.mark.symbol(),
        href: cell.to.as_deref().map(href),
        note: symbols(&cell.note),
        links: link_views(&cell.links),
    }
}

/// A text of numbers with true minus signs and powers of ten.
fn number(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for (place, word) in text.split(' ').enumerate() {
        if place > 0 {
            html.push(' ');
        }
        let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        let core = word.trim_start_matches(['[', '(', '-', '<']).trim_end_matches([']', ')', ',']);
        match core.split_once('e').filter(|(mantissa, power)| {
            mantissa.starts_with(|c: char| c.is_ascii_digit()) && digits(power.trim_start_matches('-'))
        }) {
            Some((mantissa, power)) => {
                let (before, after) = word.split_once(core).unwrap_or_default();
                html.push_str(&format!("{before}{mantissa}\u{a0}×\u{a0}10^{power}{after}"));
            }
            None => html.push_str(word),
        }
    }
    let html = symbols(&minus(&html));
    raised(&html)
}

/// A hyphen before a digit, where no letter or digit stands before it, as a minus sign.
fn minus(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let sign = |at: usize| {
        let before = at.checked_sub(1).is_some_and(|place| letters[place].is_alphanumeric());
        letters[at] == '-' && !before && letters.get(at + 1).is_some_and(char::is_ascii_digit)
    };
    (0..letters.len()).map(|at| if sign(at) { '−' } else { letters[at] }).collect()
}

/// Powers of ten as superscripts.
fn raised(html: &str) -> String {
    let mut parts = html.split("10^");
    let mut raised = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !(c.is_ascii_digit() || c == '−')).unwrap_or(part.len());
        raised.push_str(&format!("10<sup>{}</sup>{}", &part[..end], &part[end..]));
    }
    raised
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

#[cfg(test)]
mod tests;
