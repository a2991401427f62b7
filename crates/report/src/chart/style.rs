//! The style of all charts: colours, symbols, faces and lengths.

use apportion_base::quantity::{Dimension, Quantity};

use super::text::Face;

/// Margin at every edge of a figure, px.
pub(super) const MARGIN: f64 = 12.0;
/// Numbers beyond this magnitude are drawn as missing: differences of two must not overflow.
pub(super) const LARGEST: f64 = 1e300;

pub(super) const TITLE: Face = Face::bold(14.0);
pub(super) const PANEL_TITLE: Face = Face::bold(12.0);
pub(super) const BODY: Face = Face::regular(11.0);
pub(super) const TICK: Face = Face::regular(10.5);
pub(super) const VALUE: Face = Face::regular(9.5);

pub(super) const INK: &str = "#222222";
pub(super) const MUTED: &str = "#6b6b6b";
pub(super) const GRID: &str = "#e4e4e4";
pub(super) const FINE_GRID: &str = "#f1f1f1";
pub(super) const PAPER: &str = "#ffffff";

/// The width for which a chart is laid out; texts have the same size in all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChartWidth {
    /// A page column, 720 px.
    #[default]
    Wide,
    /// A phone, 360 px.
    Narrow,
    /// A column of a journal: texts have 7 to 9 pt there, and the picture has neither title nor caption.
    Paper(PaperWidth),
}

/// The width of a picture on paper: 60 to 300 mm.
///
/// ```
/// use apportion_report::chart::PaperWidth;
/// let column: PaperWidth = "88mm".parse()?;
/// assert_eq!(column.millimetres(), 88.0);
/// assert!("3 furlongs".parse::<PaperWidth>().is_err() && "20mm".parse::<PaperWidth>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaperWidth {
    micrometres: u32,
}

/// Size on paper of 1 px of a layout, mm: the smallest text, of 9.5 px, has 7 pt, the largest, of 12 px, 8.8 pt.
const MILLIMETRES: f64 = 0.26;
/// Width, px, from which on a picture on paper is laid out as for a page column, below as for a phone.
const COLUMN: f64 = 520.0;

impl PaperWidth {
    /// Returns the width in mm.
    pub fn millimetres(self) -> f64 {
        f64::from(self.micrometres) / 1e3
    }
}

impl std::str::FromStr for PaperWidth {
    type Err = String;

    /// Parses a length with its unit, such as `88mm`, `8.8 cm` or `3.5 in`.
    fn from_str(text: &str) -> Result<Self, String> {
        let length = Quantity::parse(text).ok().filter(|length| length.unit.dimension() == Dimension::LENGTH);
        let micrometres = length.map(|length| (1e6 * length.to_si()).round());
        let fitting = micrometres.filter(|width| (60e3..=300e3).contains(width));
        fitting.map(|width| Self { micrometres: width as u32 }).ok_or_else(|| {
            format!("{text:?} is not a width of a chart: expected 60mm to 300mm, such as 88mm, 18cm or 3.5in")
        })
    }
}

impl ChartWidth {
    /// Returns the width of a figure, px. The wide one is, at 96 px per inch, a full page column of 190 mm.
    pub(super) fn px(self) -> f64 {
        match self {
            Self::Wide => 720.0,
            Self::Narrow => 360.0,
            Self::Paper(width) => (width.millimetres() / MILLIMETRES).floor(),
        }
    }

    /// Returns whether it is laid out as for a phone.
    pub(super) fn is_narrow(self) -> bool {
        match self {
            Self::Wide => false,
            Self::Narrow => true,
            Self::Paper(_) => self.px() < COLUMN,
        }
    }

    /// Returns the first for a page column, the second for a phone.
    pub(super) fn choose<T>(self, wide: T, narrow: T) -> T {
        if self.is_narrow() { narrow } else { wide }
    }

    /// Returns the width on paper, if it is for paper.
    pub(super) fn paper(self) -> Option<PaperWidth> {
        match self {
            Self::Paper(width) => Some(width),
            _ => None,
        }
    }
}

/// The medium of a chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Medium<'a> {
    pub width: ChartWidth,
    /// Its identifier if it is part of a page, which sets title and caption as text and scales the picture.
    pub id: Option<&'a str>,
}

impl Medium<'_> {
    /// Returns whether the picture contains title and caption.
    pub fn has_words(self) -> bool {
        self.id.is_none() && self.width.paper().is_none()
    }
}

/// Returns the number if it can be drawn: finite and not beyond [`LARGEST`].
pub(super) fn drawable(value: f64) -> Option<f64> {
    (value.abs() <= LARGEST).then_some(value)
}

/// Hues of Okabe and Ito (2008), which people with the usual colour vision deficiencies can distinguish, dark enough
/// for marks on white (contrast 3 or more, WCAG 2.2, 1.4.11). Their lightness differs too, mostly among the first four,
/// for print in grey.
const COLOURS: [&str; 11] = [
    "#00527f", "#e8710a", "#00785a", "#571a48", "#5b85b0", "#a03f00", "#757575", "#3b2a00", "#cc659b", "#4c6a00",
    "#929292",
];

/// The shades of maps from low to high, increasingly dark, so that they differ in grey too (ColorBrewer's YlGnBu).
const SHADES: [&str; 9] =
    ["#ffffd9", "#edf8b1", "#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#253494", "#081d58"];

/// Opacity of the dots of a cloud.
pub(super) const DOTS_OPACITY: &str = "0.6";

/// Outlines of points as path data about the origin, of about equal area.
const SYMBOLS: [&str; 8] = [
    "m-2.8 0a2.8 2.8 0 1 0 5.6 0a2.8 2.8 0 1 0 -5.6 0z",
    "m-2.5 -2.5h5v5h-5z",
    "m0 -3.6l3.4 6h-6.8z",
    "m0 -3.6l3.6 3.6l-3.6 3.6l-3.6 -3.6z",
    "m0 3.6l-3.4 -6h6.8z",
    "m-1.1 -3.3h2.2v2.2h2.2v2.2h-2.2v2.2h-2.2v-2.2h-2.2v-2.2h2.2z",
    "m-3.6 0l6 -3.4v6.8z",
    "m3.6 0l-6 -3.4v6.8z",
];

/// A colour of the palette with its point symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Colour {
    /// Colour of a series by its number: dark blue, orange, green, plum, blue, rust, grey, and four more; then again
    /// from the first. The most distinct ones come first.
    Series(usize),
    /// References and exact values: nearly black.
    Reference,
    /// Colour of a cell of a map by its level, from 0, the lightest, to 8, the darkest.
    Shade(usize),
}

impl Default for Colour {
    fn default() -> Self {
        Self::Series(0)
    }
}

impl Colour {
    /// Returns the colour as `#rrggbb`.
    ///
    /// ```
    /// use apportion_report::chart::Colour;
    /// assert_eq!(Colour::Series(0).hex(), "#00527f");
    /// assert_ne!(Colour::Series(0).hex(), Colour::Series(1).hex());
    /// ```
    pub fn hex(self) -> &'static str {
        match self {
            Self::Series(number) => COLOURS[number % COLOURS.len()],
            Self::Reference => INK,
            Self::Shade(number) => SHADES[number.min(SHADES.len() - 1)],
        }
    }

    /// Returns whether letters on it must be light: where these have more contrast than dark ones.
    pub(super) fn is_dark(self) -> bool {
        let background = luminance(self.hex()) + 0.05;
        1.05 / background > background / (luminance(INK) + 0.05)
    }

    /// Returns the outline of a point as path data about its middle.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Series(number) => SYMBOLS[number % SYMBOLS.len()],
            Self::Reference | Self::Shade(_) => SYMBOLS[0],
        }
    }
}

/// Returns the relative luminance of a colour (WCAG 2.2).
fn luminance(hex: &str) -> f64 {
    let [red, green, blue] = [1, 3, 5].map(|place| {
        let part = f64::from(u8::from_str_radix(&hex[place..place + 2], 16).unwrap_or(0)) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { libm::pow((part + 0.055) / 1.055, 2.4) }
    });
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}
