//! The colours and symbols of series, by number.

use super::style::INK;

/// The colours of Okabe and Ito (2008) that people with the usual colour vision deficiencies tell apart, then their like,
/// darker or lighter. Their lightness differs too, for print in grey.
const COLOURS: [&str; 11] = [
    "#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#7f7f7f", "#6f3000", "#6b2c53", "#f0e442",
    "#c4c4c4",
];

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
        }
    }

    /// The outline of a point as path data about its middle.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Series(number) => SYMBOLS[number % SYMBOLS.len()],
            Self::Reference => SYMBOLS[0],
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
}
