//! The one look of all charts: colours, faces and lengths.

use super::font::Face;

/// Room left free at every edge of a figure, px.
pub(super) const MARGIN: f64 = 12.0;
/// Numbers beyond this magnitude are drawn like missing ones: differences of two must not overflow.
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

/// For which room a chart is laid out; texts have the same size in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChartWidth {
    /// A page column, 720 px.
    #[default]
    Wide,
    /// A phone, 360 px.
    Narrow,
}

impl ChartWidth {
    /// Width of a figure, px. The wide one is, at 96 px per inch, a full page column of 190 mm.
    pub(super) fn px(self) -> f64 {
        self.choose(720.0, 360.0)
    }

    /// The first for a page column, the second for a phone.
    pub(super) fn choose<T>(self, wide: T, narrow: T) -> T {
        match self {
            Self::Wide => wide,
            Self::Narrow => narrow,
        }
    }
}

/// What a chart is drawn for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Medium {
    pub width: ChartWidth,
    /// Whether it becomes part of a page, which sets title and caption as text and scales the picture.
    pub inline: bool,
}

/// The number if it can be drawn: finite and not beyond [`LARGEST`].
pub(super) fn drawable(value: f64) -> Option<f64> {
    (value.abs() <= LARGEST).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_that_can_be_placed_are_drawable() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            assert_eq!(drawable(value), None);
        }
        assert_eq!(drawable(-LARGEST), Some(-LARGEST));
    }
}
