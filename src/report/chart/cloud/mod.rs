//! Clouds of points in small panels: an output over each of its factors.

mod draw;

use super::ChartError;
use super::figure::{Entry, Figure, Key, Words};
use super::lines::{Axis, LineSeries, legend_of};
use super::style::{ChartWidth, Medium, Role};

/// A figure of small panels that share their vertical axis, each with a cloud of dots and lines through it.
///
/// Panels stand up to three side by side, on a phone two. All dots of a panel are one path, so that thousands of them
/// make a small file. A dot with a coordinate that cannot be shown is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudChart {
    /// Headline.
    pub title: String,
    /// One sentence under the figure.
    pub caption: String,
    /// The vertical axis of all panels.
    pub y: Axis,
    /// Name of the dots in the legend.
    pub dots: String,
    /// Their colour.
    pub role: Role,
    /// At least one.
    pub panels: Vec<CloudPanel>,
}

/// One plot of a [`CloudChart`].
#[derive(Clone, Debug, PartialEq)]
pub struct CloudPanel {
    /// Headline of the panel; may be empty.
    pub title: String,
    /// Its horizontal axis.
    pub x: Axis,
    /// Names of the places 0, 1, 2 and so on along the axis; empty for an axis of numbers.
    pub names: Vec<String>,
    /// The points (x, y) of the cloud.
    pub dots: Vec<(f64, f64)>,
    /// Lines with their bands, over the cloud.
    pub lines: Vec<LineSeries>,
}

impl CloudChart {
    /// Draws the figure as an SVG document, the same bytes for the same figure.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] without panels.
    ///
    /// # Example
    /// ```
    /// use apportion::report::chart::{Axis, CloudChart, CloudPanel, Role};
    ///
    /// let axis = |label: &str, unit: &str| Axis { label: label.into(), unit: unit.into(), ..Axis::default() };
    /// let figure = CloudChart {
    ///     title: "Critical force".into(),
    ///     caption: "It rises with the thickness.".into(),
    ///     y: axis("critical force", "nN"),
    ///     dots: "model run".into(),
    ///     role: Role::Coulomb,
    ///     panels: vec![CloudPanel {
    ///         title: String::new(),
    ///         x: axis("thickness", "um"),
    ///         names: Vec::new(),
    ///         dots: vec![(1.0, 600.0), (1.2, 1000.0), (0.8, 300.0)],
    ///         lines: Vec::new(),
    ///     }],
    /// };
    /// assert!(figure.svg()?.contains("thickness (um)"));
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
        let mut figure = Figure::begin(medium, words, &self.legend());
        let bottom = draw::panels(&mut figure, self, medium.width);
        Ok(figure.finish(bottom, &self.description()))
    }

    fn legend(&self) -> Vec<Entry> {
        let key = Key::Line { role: self.role, dash: "none", line: false, points: true };
        let dots = self.panels.iter().any(|panel| !panel.dots.is_empty()) && !self.dots.trim().is_empty();
        let dots = dots.then(|| Entry { name: self.dots.clone(), key });
        let lines = legend_of(self.panels.iter().flat_map(|panel| &panel.lines));
        dots.into_iter().chain(lines).collect()
    }

    /// Axes, numbers of dots and names of lines in words.
    pub(super) fn description(&self) -> String {
        let mut words = format!("Vertical axis: {}.", self.y.title(0));
        for panel in &self.panels {
            let lines: Vec<&str> = panel.lines.iter().map(|line| line.name.as_str()).collect();
            let count = panel.dots.len();
            words.push_str(&format!(" {} {}: {count} points; {}.", panel.title, panel.x.title(0), lines.join(", ")));
            if !panel.names.is_empty() {
                words.push_str(&format!(" Places: {}.", panel.names.join(", ")));
            }
        }
        words
    }
}

#[cfg(test)]
mod tests;
