//! Lines and points over a common horizontal axis, in one panel or several one above the other.

mod draw;
mod flags;
mod path;
pub(super) mod sheet;

use super::ChartError;
use super::figure::{Entry, Figure, Key, Words};
use super::scale::{Scale, Spacing};
use super::style::{ChartWidth, Medium, Role};

/// A figure of lines; its panels stand one above the other and share the horizontal axis.
///
/// Points with a coordinate that cannot be shown (not finite, or not positive on a logarithmic axis) break
/// the line; they are never bridged.
#[derive(Clone, Debug, PartialEq)]
pub struct LineChart {
    /// Headline.
    pub title: String,
    /// One sentence under the figure.
    pub caption: String,
    /// The horizontal axis of all panels.
    pub x: Axis,
    /// Names of the places 0, 1, 2 and so on of the horizontal axis, for categories; empty for an axis of numbers.
    pub names: Vec<String>,
    /// At least one.
    pub panels: Vec<LinePanel>,
}

/// An axis: what it shows, in which unit, how spaced.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// The quantity, such as "Pushing force".
    pub label: String,
    /// Its unit, such as "nN"; empty for none.
    pub unit: String,
    /// Linear or logarithmic.
    pub spacing: Spacing,
}

/// One plot of a [`LineChart`].
#[derive(Clone, Debug, PartialEq)]
pub struct LinePanel {
    /// Headline of the panel; may be empty.
    pub title: String,
    /// Its vertical axis.
    pub y: Axis,
    /// What is drawn.
    pub series: Vec<LineSeries>,
    /// Vertical lines with labels.
    pub markers: Vec<Marker>,
}

/// A line, a row of points, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSeries {
    /// Name in the legend; series of one name and look in several panels share an entry.
    pub name: String,
    /// Which colour.
    pub role: Role,
    /// Line, points or both.
    pub stroke: Stroke,
    /// The points (x, y) in drawing order.
    pub points: Vec<(f64, f64)>,
    /// A shaded band as (x, low, high); empty for none.
    pub band: Vec<(f64, f64, f64)>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// A full line.
    #[default]
    Solid,
    /// A dashed line.
    Dashed,
    /// A dotted line.
    Dotted,
    /// A full line with a dot at every point.
    SolidWithPoints,
    /// Dots alone.
    Points,
}

impl Stroke {
    fn line(self) -> bool {
        self != Stroke::Points
    }

    fn points(self) -> bool {
        matches!(self, Stroke::SolidWithPoints | Stroke::Points)
    }

    fn dash(self) -> &'static str {
        match self {
            Stroke::Dashed => "7 4",
            Stroke::Dotted => "2 3",
            _ => "none",
        }
    }
}

/// A vertical line across a panel, such as the critical time.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Where on the horizontal axis; a place that cannot be shown is left out.
    pub x: f64,
    /// Written above the line.
    pub label: String,
}

impl LineChart {
    /// Draws the figure as an SVG document, the same bytes for the same figure. Points closer together
    /// than half a pixel are thinned without a visible difference.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] without panels.
    ///
    /// # Example
    /// ```
    /// use apportion::report::chart::{Axis, LineChart, LinePanel, LineSeries, Marker, Role, Spacing, Stroke};
    ///
    /// let axis = |label: &str, unit: &str| Axis {
    ///     label: label.into(), unit: unit.into(), spacing: Spacing::Linear,
    /// };
    /// let figure = LineChart {
    ///     names: Vec::new(),
    ///     title: "Pushing".into(),
    ///     caption: "Pushing force until the particle slides.".into(),
    ///     x: axis("Time", "ms"),
    ///     panels: vec![LinePanel {
    ///         title: String::new(),
    ///         y: axis("Force", "nN"),
    ///         series: vec![LineSeries {
    ///             name: "Coulomb".into(),
    ///             role: Role::Coulomb,
    ///             stroke: Stroke::Solid,
    ///             points: vec![(0.0, 0.0), (10.0, 41.0), (20.0, f64::NAN)],
    ///             band: Vec::new(),
    ///         }],
    ///         markers: vec![Marker { x: 10.0, label: "critical time".into() }],
    ///     }],
    /// };
    /// assert!(figure.svg()?.contains("Force (nN)"));
    /// # Ok::<(), apportion::report::chart::ChartError>(())
    /// ```
    pub fn svg(&self) -> Result<String, ChartError> {
        self.svg_at(ChartWidth::Wide)
    }

    /// The figure as an SVG document for `width`.
    ///
    /// # Errors
    /// As [`svg`](Self::svg).
    pub fn svg_at(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(width.into())
    }

    pub(super) fn drawn(&self, medium: Medium) -> Result<String, ChartError> {
        if self.panels.is_empty() {
            return Err(ChartError::NoPanels { chart: self.title.clone() });
        }
        let words = Words { title: &self.title, caption: &self.caption };
        let mut figure = Figure::begin(medium, words, &legend_of(self.panels.iter().flat_map(|panel| &panel.series)));
        let bottom = draw::panels(&mut figure, self, medium.width);
        Ok(figure.finish(bottom, &self.description()))
    }

    /// Axes and series in words.
    pub(super) fn description(&self) -> String {
        let mut words = format!("Horizontal axis: {}.", self.x.title(0));
        if !self.names.is_empty() {
            words.push_str(&format!(" Places: {}.", self.names.join(", ")));
        }
        for panel in &self.panels {
            let names: Vec<_> = panel.series.iter().map(|series| series.name.as_str()).collect();
            words.push_str(&format!(" {} {}: {}.", panel.title, panel.y.title(0), names.join(", ")));
            for marker in &panel.markers {
                let named = self.names.get(marker.x as usize).cloned();
                words.push_str(&format!(" {} at {}.", marker.label, named.unwrap_or_else(|| marker.x.to_string())));
            }
        }
        words
    }
}

/// Every name and look once; none for nameless series.
pub(super) fn legend_of<'a>(series: impl Iterator<Item = &'a LineSeries>) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for LineSeries { name, role, stroke, .. } in series {
        let (line, points) = (stroke.line(), stroke.points());
        let key = Key::Line { role: *role, dash: stroke.dash(), line, points };
        let entry = Entry { name: name.clone(), key };
        if !name.trim().is_empty() && !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries
}

impl Axis {
    /// Label and unit, with the power of ten that the ticks are in.
    pub(super) fn title(&self, exponent: i32) -> String {
        super::plot::axis_title(&self.label, &self.unit, exponent)
    }
}

impl LinePanel {
    fn xs(&self) -> impl Iterator<Item = f64> {
        let points = self.series.iter().flat_map(|s| s.points.iter().map(|p| p.0).chain(s.band.iter().map(|b| b.0)));
        points.chain(self.markers.iter().map(|marker| marker.x))
    }

    /// The ordinates of the points that also have a place on the horizontal axis.
    fn ys(&self, x: &Scale) -> impl Iterator<Item = f64> {
        let points = self.series.iter().flat_map(|s| s.points.iter().copied());
        let bands = self.series.iter().flat_map(|s| s.band.iter().flat_map(|&(x, low, high)| [(x, low), (x, high)]));
        points.chain(bands).filter(|p| x.place(p.0).is_some()).map(|p| p.1)
    }
}

#[cfg(test)]
mod tests;
