//! Pages: sections of text, figures and tables as one HTML file that needs nothing else.
//!
//! A [`Page`] is plain data; [`Page::html`] sets it. The page of a study's result and that of the reproduction are made
//! of the same parts.

mod anchors;
mod drawing;
mod html;
mod symbols;

pub use html::PageError;
pub use symbols::symbols;

use crate::report::chart::Chart;

/// A page.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// A few words above the title: what kind of page it is.
    pub kicker: String,
    /// Headline.
    pub title: String,
    /// What a hurried reader should take along, a paragraph each.
    pub lead: Vec<String>,
    /// The sections, in order; each is listed in the contents.
    pub sections: Vec<Section>,
    /// The last line.
    pub footer: String,
}

/// A section.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Anchor, unique on the page: letters, digits and hyphens.
    pub id: String,
    /// Heading, also in the contents.
    pub title: String,
    /// What it holds.
    pub parts: Vec<Part>,
}

/// A part of a section.
///
/// Texts are plain; symbols such as `F_cr`, `F_Y*` or `S_T` in them are set as italic letters with subscripts.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    /// A paragraph.
    Text(String),
    /// A heading inside the section.
    Heading(String),
    /// A list.
    List(Vec<String>),
    /// A figure.
    Figure(Box<PageFigure>),
    /// A table.
    Table(PageTable),
    /// Links to files beside the page.
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
    /// Parts that are folded until asked for; printed unfolded.
    Details {
        /// What is folded.
        summary: String,
        /// The parts.
        parts: Vec<Part>,
    },
}

/// A figure with what belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct PageFigure {
    /// Anchor, unique on the page.
    pub id: String,
    /// What it is called, such as `CHK fig. 6`; may be empty.
    pub label: String,
    /// What to compare it with, such as what the paper's figure shows; may be empty.
    pub beside: String,
    /// The chart; its title and caption are set as text of the page, its description as the alternative text.
    pub chart: Chart,
    /// Its files.
    pub links: Vec<Link>,
}

/// A link to a file beside the page, or to an anchor on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The words.
    pub text: String,
    /// Where it leads, such as `shares.csv` or `#claims`.
    pub to: String,
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct PageTable {
    /// What it shows, in one sentence.
    pub caption: String,
    /// Headings of the columns.
    pub header: Vec<String>,
    /// Columns of numbers, which are set to the right.
    pub numeric: Vec<usize>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
    /// What becomes of it where it is too wide.
    pub on_phone: OnPhone,
}

/// How a table is set on a phone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnPhone {
    /// As it is, to be scrolled sideways inside its frame: for numbers.
    #[default]
    Scroll,
    /// Every row as a block of its cells, one below the other: for sentences that need no heading.
    Stack,
    /// The same, each cell under the heading of its column.
    StackLabelled,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    /// Its text.
    pub text: String,
    /// How it is set off.
    pub mark: Mark,
    /// Where its text leads, if anywhere.
    pub to: Option<String>,
    /// What is said below it in small letters; may be empty.
    pub note: String,
    /// Further links, below the note.
    pub links: Vec<Link>,
}

/// How a cell is set off; never by colour alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Not at all.
    #[default]
    Plain,
    /// In strong letters.
    Strong,
    /// As a badge of good news.
    Good,
    /// As a badge of mixed news.
    Mixed,
    /// As a badge of bad news.
    Bad,
}

impl Cell {
    /// A cell of plain text.
    pub fn plain(text: impl Into<String>) -> Self {
        Self { text: text.into(), ..Self::default() }
    }

    /// A cell set off by `mark`.
    pub fn marked(text: impl Into<String>, mark: Mark) -> Self {
        Self { text: text.into(), mark, ..Self::default() }
    }
}
