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

impl From<ChartWidth> for Medium {
    /// A document of its own.
    fn from(width: ChartWidth) -> Self {
        Self { width, inline: false }
    }
}

/// What a colour stands for. The colours are those of Okabe and Ito (2008), which people with the usual
/// colour vision deficiencies tell apart; their lightness differs too, for print in grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Coulomb friction: blue, here and in every other chart.
    Coulomb,
    /// Hurtado-Kim friction: orange.
    HurtadoKim,
    /// LuGre friction: bluish green.
    LuGre,
    /// The n-th series that is no friction model: vermilion, purple, sky blue, grey; then their like, darker
    /// or lighter; then again from the first.
    Other(usize),
    /// References and exact values: nearly black.
    Reference,
}

impl Role {
    /// The colour as `#rrggbb`.
    ///
    /// ```
    /// use apportion::report::chart::Role;
    /// assert_eq!(Role::Coulomb.colour(), "#0072b2");
    /// assert_ne!(Role::Other(0).colour(), Role::Other(1).colour());
    /// ```
    pub fn colour(self) -> &'static str {
        const OTHERS: [&str; 8] =
            ["#d55e00", "#cc79a7", "#56b4e9", "#7f7f7f", "#6f3000", "#6b2c53", "#f0e442", "#c4c4c4"];
        match self {
            Role::Coulomb => "#0072b2",
            Role::HurtadoKim => "#e69f00",
            Role::LuGre => "#009e73",
            Role::Other(n) => OTHERS[n % OTHERS.len()],
            Role::Reference => INK,
        }
    }
}

/// The number if it can be drawn: finite and not beyond [`LARGEST`].
pub(super) fn drawable(value: f64) -> Option<f64> {
    (value.abs() <= LARGEST).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_have_distinct_colours() {
        let mut roles = vec![Role::Coulomb, Role::HurtadoKim, Role::LuGre, Role::Reference];
        roles.extend((0..8).map(Role::Other));
        let mut colours: Vec<_> = roles.iter().map(|role| role.colour()).collect();
        colours.sort_unstable();
        colours.dedup();
        assert_eq!(colours.len(), roles.len());
        assert_eq!(Role::Other(usize::MAX).colour(), Role::Other(7).colour());
    }

    #[test]
    fn only_numbers_that_can_be_placed_are_drawable() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            assert_eq!(drawable(value), None);
        }
        assert_eq!(drawable(-LARGEST), Some(-LARGEST));
    }
}
