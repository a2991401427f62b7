//! The appearance of a series.

use super::palette::Colour;

/// The appearance of the marks of one series.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Colour, and symbol of points.
    pub colour: Colour,
    /// How its lines are drawn, and its bars hatched.
    pub stroke: Stroke,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// A full line.
    #[default]
    Solid,
    /// A dashed line.
    Dashed,
    /// A dotted line.
    Dotted,
    /// A full line with a symbol at every point.
    SolidWithPoints,
    /// Symbols alone.
    Points,
}

impl Series {
    /// Creates a series whose lines are solid.
    pub fn new(name: impl Into<String>, colour: Colour) -> Self {
        Self { name: name.into(), colour, stroke: Stroke::Solid }
    }

    /// Sets the stroke.
    pub fn stroke(self, stroke: Stroke) -> Self {
        Self { stroke, ..self }
    }
}

impl Stroke {
    pub(super) fn has_line(self) -> bool {
        self != Self::Points
    }

    pub(super) fn has_points(self) -> bool {
        matches!(self, Self::SolidWithPoints | Self::Points)
    }

    pub(super) fn dash(self) -> &'static str {
        match self {
            Self::Dashed => "7 4",
            Self::Dotted => "2 3",
            _ => "none",
        }
    }
}
