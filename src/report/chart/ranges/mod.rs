//! Level bars, one row per name: effects with their intervals, or ranges about a reference.

mod draw;

use super::ChartError;
use super::figure::{Entry, Figure, Key, Words};
use super::lines::Axis;
use super::style::{ChartWidth, Medium, Role, drawable};

/// A figure of level bars, such as a tornado.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeBars {
    /// Headline.
    pub title: String,
    /// One sentence under the figure.
    pub caption: String,
    /// The axis; its spacing is linear.
    pub x: Axis,
    /// The value that bars are about, as a line; without one they are about 0.
    pub reference: Option<Reference>,
    /// Names and colours in the legend.
    pub series: Vec<(String, Role)>,
    /// Name of the intervals in the legend.
    pub interval_label: String,
    /// From top to bottom.
    pub rows: Vec<RangeRow>,
}

/// A value marked through all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The value.
    pub value: f64,
    /// Written above its line.
    pub label: String,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeRow {
    /// Written on the left.
    pub name: String,
    /// Its bars, one below the other; one that is not finite is not drawn.
    pub bars: Vec<Range>,
    /// An interval drawn over the bars as a thin line with caps.
    pub interval: Option<(f64, f64)>,
    /// Written on the right.
    pub note: String,
}

/// A bar from one value to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Its colour.
    pub role: Role,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl RangeRow {
    fn bars(&self) -> impl Iterator<Item = (usize, Range)> {
        let is_drawable = |range: &Range| drawable(range.from).and(drawable(range.to)).is_some();
        self.bars.iter().copied().enumerate().filter(move |(_, range)| is_drawable(range))
    }

    fn interval(&self) -> Option<(f64, f64)> {
        self.interval.filter(|&(low, high)| drawable(low).and(drawable(high)).is_some())
    }

    /// The row in words.
    fn words(&self) -> String {
        let bars: Vec<String> = self.bars().map(|(_, range)| format!("{} to {}", range.from, range.to)).collect();
        let interval = self.interval().map_or_else(String::new, |(low, high)| format!(" ({low} to {high})"));
        format!("{}: {}{interval} {}", self.name, bars.join(", "), self.note)
    }
}

impl RangeBars {
    /// Draws the figure as an SVG document, the same bytes for the same figure.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] without rows.
    ///
    /// # Example
    /// ```
    /// use apportion::report::chart::{Axis, Range, RangeBars, RangeRow, Reference, Role};
    ///
    /// let figure = RangeBars {
    ///     title: "Critical force".into(),
    ///     caption: "How far each factor moves it.".into(),
    ///     x: Axis { label: "critical force".into(), unit: "nN".into(), ..Axis::default() },
    ///     reference: Some(Reference { value: 40.0, label: "nominal".into() }),
    ///     series: vec![("at its low end".into(), Role::Other(2)), ("at its high end".into(), Role::Other(0))],
    ///     interval_label: "whole range".into(),
    ///     rows: vec![RangeRow {
    ///         name: "thickness".into(),
    ///         bars: vec![
    ///             Range { role: Role::Other(2), from: 40.0, to: 10.0 },
    ///             Range { role: Role::Other(0), from: 40.0, to: 90.0 },
    ///         ],
    ///         interval: Some((10.0, 90.0)),
    ///         note: "200 %".into(),
    ///     }],
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
        if self.rows.is_empty() {
            return Err(ChartError::NoPanels { chart: self.title.clone() });
        }
        let words = Words { title: &self.title, caption: &self.caption };
        let mut figure = Figure::begin(medium, words, &self.legend());
        let bottom = draw::plot(&mut figure, self, medium.width);
        Ok(figure.finish(bottom, &self.description()))
    }

    /// Axis and rows in words.
    pub(super) fn description(&self) -> String {
        let rows: Vec<String> = self.rows.iter().map(RangeRow::words).collect();
        format!("{}. {}.", self.x.title(0), rows.join("; "))
    }

    /// The series that occur, then the interval if there is one.
    fn legend(&self) -> Vec<Entry> {
        let occurs = |role: Role| self.rows.iter().flat_map(|row| &row.bars).any(|bar| bar.role == role);
        let named = self.series.iter().filter(|(name, role)| !name.trim().is_empty() && occurs(*role));
        let mut entries: Vec<Entry> =
            named.map(|(name, role)| Entry { name: name.clone(), key: Key::Swatch(*role) }).collect();
        if self.rows.iter().any(|row| row.interval().is_some()) {
            entries.push(Entry { name: self.interval_label.clone(), key: Key::Whisker });
        }
        entries
    }
}

#[cfg(test)]
mod tests;
