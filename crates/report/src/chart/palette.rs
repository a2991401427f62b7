//! The colours and symbols of series, by number.

use super::style::INK;

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
        let own = luminance(self.hex()) + 0.05;
        1.05 / own > own / (luminance(INK) + 0.05)
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
    let channel = |at: usize| {
        let part = f64::from(u8::from_str_radix(&hex[at..at + 2], 16).unwrap_or(0)) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { libm::pow((part + 0.055) / 1.055, 2.4) }
    };
    0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
}
