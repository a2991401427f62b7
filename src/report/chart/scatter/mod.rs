//! Labelled points in a plane, with lines of constant ratio through the origin.

mod draw;
mod labels;

use super::ChartError;
use super::figure::{Entry, Figure, Key, Words};
use super::lines::Axis;
use super::style::{ChartWidth, Medium, Role};

/// A figure of labelled points; both axes begin at zero or below.
///
/// Labels never cover one another or a point: they stand beside their points, or a little off with a thin line; where
/// there is no room, the points of smaller x go without. They keep clear of intervals where they can.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterChart {
    /// Headline.
    pub title: String,
    /// One sentence under the figure.
    pub caption: String,
    /// The horizontal axis; its spacing is linear.
    pub x: Axis,
    /// The vertical axis, likewise.
    pub y: Axis,
    /// What is drawn, in the order of the legend.
    pub series: Vec<ScatterSeries>,
    /// Dashed lines through the origin.
    pub guides: Vec<Guide>,
}

/// Points of one look.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterSeries {
    /// Name in the legend.
    pub name: String,
    /// Colour and shape.
    pub role: Role,
    /// The points.
    pub points: Vec<ScatterPoint>,
}

/// A point with its label and intervals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScatterPoint {
    /// On the horizontal axis; a point with a coordinate that is not finite is not drawn.
    pub x: f64,
    /// On the vertical axis.
    pub y: f64,
    /// Written beside it; may be empty.
    pub label: String,
    /// Bounds of `x`, drawn as a thin line; bounds that are not finite are not drawn.
    pub x_interval: Option<(f64, f64)>,
    /// Bounds of `y`, likewise.
    pub y_interval: Option<(f64, f64)>,
}

/// A dashed line y = slope x from the origin to the edge of the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// y / x, positive.
    pub slope: f64,
    /// Written at its end.
    pub label: String,
}

impl ScatterChart {
    /// Draws the figure as an SVG document, the same bytes for the same figure.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] without series.
    ///
    /// # Example
    /// ```
    /// use apportion::report::chart::{Axis, Guide, Role, ScatterChart, ScatterPoint, ScatterSeries};
    ///
    /// let axis = |label: &str| Axis { label: label.into(), unit: "nN".into(), ..Axis::default() };
    /// let figure = ScatterChart {
    ///     title: "Screening".into(),
    ///     caption: "The thickness matters most.".into(),
    ///     x: axis("μ*"),
    ///     y: axis("σ"),
    ///     series: vec![ScatterSeries {
    ///         name: "monotone".into(),
    ///         role: Role::Other(0),
    ///         points: vec![ScatterPoint { x: 40.0, y: 12.0, label: "thickness".into(), ..ScatterPoint::default() }],
    ///     }],
    ///     guides: vec![Guide { slope: 0.5, label: "σ = 0.5 μ*".into() }],
    /// };
    /// assert!(figure.svg()?.contains("thickness"));
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
        if self.series.is_empty() {
            return Err(ChartError::NoPanels { chart: self.title.clone() });
        }
        let words = Words { title: &self.title, caption: &self.caption };
        let mut figure = Figure::begin(medium, words, &self.legend());
        let bottom = draw::plot(&mut figure, self, medium.width);
        Ok(figure.finish(bottom, &self.description()))
    }

    fn legend(&self) -> Vec<Entry> {
        let named = self.series.iter().filter(|series| !series.name.trim().is_empty() && !series.points.is_empty());
        let key = |role| Key::Line { role, dash: "none", line: false, points: true };
        named.map(|series| Entry { name: series.name.clone(), key: key(series.role) }).collect()
    }

    /// Axes and points in words.
    pub(super) fn description(&self) -> String {
        let mut words = format!("Horizontal axis: {}. Vertical axis: {}.", self.x.title(0), self.y.title(0));
        for series in &self.series {
            for point in &series.points {
                let interval = |interval: Option<(f64, f64)>| {
                    interval.map_or_else(String::new, |(low, high)| format!(" ({low} to {high})"))
                };
                let (x, y) = (interval(point.x_interval), interval(point.y_interval));
                let ScatterPoint { label, x: at, y: height, .. } = point;
                words.push_str(&format!(" {label}, {}: {at}{x}, {height}{y};", series.name));
            }
        }
        words
    }
}

#[cfg(test)]
mod tests;
