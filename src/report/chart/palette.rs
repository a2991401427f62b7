//! The colours and symbols of series, by number.

use super::style::INK;

/// The colours of Okabe and Ito (2008) that people with the usual colour vision deficiencies tell apart, then their like,
/// darker or lighter. Their lightness differs too, for print in grey.
const COLOURS: [&str; 11] = [
    "#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#7f7f7f", "#6f3000", "#6b2c53", "#f0e442",
    "#c4c4c4",
];

/// The shades of maps from little to much, ever darker, so that they are told apart in grey too (ColorBrewer's YlGnBu).
const SHADES: [&str; 9] =
    ["#ffffd9", "#edf8b1", "#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#253494", "#081d58"];

/// The first shade on which dark letters cannot be read.
const FIRST_DARK: usize = 6;

/// Outlines of points as path data about the origin, of about equal area.
const SYMBOLS: [&str; 4] = [
    "m-2.8 0a2.8 2.8 0 1 0 5.6 0a2.8 2.8 0 1 0 -5.6 0z",
    "m-2.5 -2.5h5v5h-5z",
    "m0 -3.6l3.4 6h-6.8z",
    "m0 -3.6l3.6 3.6l-3.6 3.6l-3.6 -3.6z",
];

/// A colour of the palette, and the symbol of points that goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Colour {
    /// That of a series by its number: blue, vermilion, green, orange, purple, sky blue, grey, and four more; then again
    /// from the first. Those that are told apart best come first.
    Series(usize),
    /// References and exact values: nearly black.
    Reference,
    /// That of a cell of a map by how much there is, from 0, the lightest, to 8, the darkest.
    Shade(usize),
}

impl Default for Colour {
    fn default() -> Self {
        Self::Series(0)
    }
}

impl Colour {
    /// The colour as `#rrggbb`.
    ///
    /// ```
    /// use apportion::report::chart::Colour;
    /// assert_eq!(Colour::Series(0).hex(), "#0072b2");
    /// assert_ne!(Colour::Series(0).hex(), Colour::Series(1).hex());
    /// ```
    pub fn hex(self) -> &'static str {
        match self {
            Self::Series(number) => COLOURS[number % COLOURS.len()],
            Self::Reference => INK,
            Self::Shade(number) => SHADES[number.min(SHADES.len() - 1)],
        }
    }

    /// Whether letters on it must be light.
    pub(super) fn is_dark(self) -> bool {
        matches!(self, Self::Reference | Self::Shade(FIRST_DARK..))
    }

    /// The outline of a point as path data about its middle.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Series(number) => SYMBOLS[number % SYMBOLS.len()],
            Self::Reference | Self::Shade(_) => SYMBOLS[0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_have_distinct_colours() {
        let mut colours: Vec<_> = (0..COLOURS.len()).map(|number| Colour::Series(number).hex()).collect();
        colours.push(Colour::Reference.hex());
        colours.sort_unstable();
        colours.dedup();
        assert_eq!(colours.len(), COLOURS.len() + 1);
        assert!(colours.contains(&Colour::Series(usize::MAX).hex()));
    }

    #[test]
    fn shades_grow_darker() {
        let lightness = |shade: usize| {
            let hex = Colour::Shade(shade).hex();
            let part = |at: usize| f64::from(u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal"));
            0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
        };
        assert!((1..SHADES.len()).all(|shade| lightness(shade) < lightness(shade - 1)));
        assert_eq!(Colour::Shade(usize::MAX).hex(), SHADES[8]);
    }
}
