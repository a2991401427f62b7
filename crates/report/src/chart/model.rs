//! The data of a chart: panels of marks on axes, bars, and the appearance of series.

use super::scale::Spacing;
use super::style::{Colour, drawable};
use super::text::{percent, power_of_ten};

/// A chart: headline, caption, and panels of marks.
///
/// The legend names every series once, in the order of the marks.
///
/// ```
/// use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series};
///
/// let series = Series::new("model A", Colour::Series(0));
/// let panel = Panel::new(Axis::new("Time", "ms"), Axis::new("Pressure", "bar"))
///     .with([series.line(vec![(0.0, 0.0), (10.0, 41.0)]), Mark::rule(10.0, "event")]);
/// let chart = Chart::new("A start", "The pressure grows until the valve opens.").panels([panel]);
/// assert!(chart.svg().contains("Pressure (bar)"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The headline.
    pub title: String,
    /// The sentence under the chart.
    pub caption: String,
    /// The panels.
    pub panels: Vec<Panel>,
    pub(super) arrangement: Arrangement,
}

/// How the panels of a chart are arranged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// One above the other; they share the horizontal axis.
    #[default]
    Stacked,
    /// Side by side in rows as far as there is room; they share the vertical axis.
    SideBySide,
}

/// One plot of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Headline of the panel; may be empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn.
    pub marks: Vec<Mark>,
}

/// An axis: of numbers, or of names if there are any.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// The quantity, such as "Pressure".
    pub label: String,
    /// Its unit, such as "bar"; empty for none.
    pub unit: String,
    /// Linear or logarithmic.
    pub spacing: Spacing,
    /// Names of the places 0, 1, 2 and so on; on a vertical axis the rows from top to bottom.
    pub names: Vec<String>,
}

/// A mark of a series. Numbers that cannot be drawn (not finite, beyond 1e300, not positive on a logarithmic axis)
/// leave gaps in lines and bands; other marks are omitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its series.
    pub series: Series,
    /// Its shape.
    pub shape: Shape,
}

/// The kinds of marks.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through points, or only the points, see [`super::Stroke`].
    Line(Vec<(f64, f64)>),
    /// A shaded band as (x, low, high).
    Band(Vec<(f64, f64, f64)>),
    /// A cloud of small dots.
    Dots(Vec<(f64, f64)>),
    /// A point with its label.
    Point(Point),
    /// A horizontal bar in a row of a vertical axis of names; the bars of a row share it in their order.
    Bar(Bar),
    /// A cell of a map, on two axes of names.
    Tile(Tile),
    /// A vertical line at x with a label above; bars start at the first of them, else at 0.
    Rule(f64, String),
}

/// A point with its label.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Position on the horizontal axis.
    pub x: f64,
    /// Position on the vertical axis.
    pub y: f64,
    /// Written next to it where there is room; may be empty.
    pub label: String,
}

/// A cell of a map, marked by its colour and by a letter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tile {
    /// Its row.
    pub row: usize,
    /// Its column.
    pub column: usize,
    /// A letter or two.
    pub letter: String,
    /// The tooltip.
    pub tip: String,
}

impl Chart {
    /// Creates a chart without panels.
    pub fn new(title: impl Into<String>, caption: impl Into<String>) -> Self {
        Self { title: title.into(), caption: caption.into(), panels: Vec::new(), arrangement: Arrangement::Stacked }
    }

    /// Adds panels.
    pub fn panels(mut self, panels: impl IntoIterator<Item = Panel>) -> Self {
        self.panels.extend(panels);
        self
    }

    /// Arranges the panels side by side.
    pub fn side_by_side(self) -> Self {
        Self { arrangement: Arrangement::SideBySide, ..self }
    }

    /// Iterates over all marks of all panels.
    pub(super) fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.panels.iter().flat_map(|panel| &panel.marks)
    }
}

impl Panel {
    /// Creates a panel without marks.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self { title: String::new(), x, y, marks: Vec::new() }
    }

    /// Sets the headline of the panel.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: title.into(), ..self }
    }

    /// Sorts the rows by falling keys and keeps only the first `max_rows` of them.
    pub fn ranked(mut self, keys: &[f64], max_rows: usize) -> Self {
        let keys = keys.iter().map(|key| if key.is_nan() { f64::NEG_INFINITY } else { *key });
        let mut order: Vec<(usize, f64)> =
            (0..self.y.names.len()).zip(keys.chain(std::iter::repeat(f64::NEG_INFINITY))).collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let order: Vec<usize> = order.into_iter().take(max_rows).map(|(row, _)| row).collect();
        self.marks.retain_mut(|mark| {
            let row = match &mut mark.shape {
                Shape::Bar(bar) => &mut bar.row,
                Shape::Tile(tile) => &mut tile.row,
                _ => return true,
            };
            let place = order.iter().position(|other| other == row);
            *row = place.unwrap_or(*row);
            place.is_some()
        });
        self.y.names = order.iter().map(|&row| self.y.names[row].clone()).collect();
        self
    }

    /// Adds marks.
    pub fn with(mut self, marks: impl IntoIterator<Item = Mark>) -> Self {
        self.marks.extend(marks);
        self
    }
}

impl Axis {
    /// Creates a linear axis.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// Creates an axis of names.
    pub fn from_names(label: impl Into<String>, names: Vec<String>) -> Self {
        Self { label: label.into(), names, ..Self::default() }
    }

    /// Sets the spacing.
    pub fn spaced(self, spacing: Spacing) -> Self {
        Self { spacing, ..self }
    }

    /// Returns `label (unit)`, with the power of ten of the ticks.
    pub(super) fn title(&self, exponent: i32) -> String {
        let label = &self.label;
        match (self.unit.trim(), exponent) {
            ("", 0) => label.clone(),
            ("", _) => format!("{label} (×{})", power_of_ten(exponent)),
            (unit, 0) => format!("{label} ({unit})"),
            (unit, _) => format!("{label} ({} {unit})", power_of_ten(exponent)),
        }
    }
}

impl Series {
    /// Creates a mark of the series.
    pub fn mark(&self, shape: Shape) -> Mark {
        Mark { series: self.clone(), shape }
    }

    /// Creates a line of the series.
    pub fn line(&self, points: Vec<(f64, f64)>) -> Mark {
        self.mark(Shape::Line(points))
    }

    /// Creates a band of the series.
    pub fn band(&self, edges: Vec<(f64, f64, f64)>) -> Mark {
        self.mark(Shape::Band(edges))
    }
}

impl Mark {
    /// Creates a vertical line with a label.
    pub fn rule(x: f64, label: impl Into<String>) -> Self {
        Series::default().mark(Shape::Rule(x, label.into()))
    }
}

/// A horizontal bar. If an end cannot be drawn, the bar keeps its row, with a text instead.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Its row.
    pub row: usize,
    /// Its start.
    pub from: f64,
    /// Its end, the value.
    pub to: f64,
    /// Lower and upper bound of the value.
    pub interval: Option<(f64, f64)>,
    /// A published value, drawn as a hollow diamond.
    pub published: Option<f64>,
    /// Text after it; in place of a bar that cannot be drawn, the reason.
    pub label: String,
    /// Its value in words with its error; empty for plain numbers.
    pub value_text: String,
    /// The value from which the bar has the colour of another series.
    pub beyond: Option<(f64, Series)>,
}

impl Bar {
    /// Creates a bar from 0 to a value in percent, with the value written after it; `None` keeps the row.
    pub fn percent(row: usize, value: Option<f64>, interval: Option<(f64, f64)>) -> Self {
        let label = value.map_or_else(String::new, percent);
        Self { row, to: value.unwrap_or(f64::NAN), interval, label, ..Self::default() }
    }

    /// Returns the bar as drawn; `None` if it cannot be drawn.
    pub(super) fn drawn(&self) -> Option<Self> {
        drawable(self.from).and(drawable(self.to))?;
        let interval = self.interval.and_then(|(low, high)| drawable(low).zip(drawable(high)));
        Some(Self { interval, ..self.clone() })
    }

    /// Returns the non-empty part that belongs to another series: its start and the end.
    pub(super) fn of_other(&self) -> Option<(f64, f64, &Series)> {
        let (split, series) = self.beyond.as_ref()?;
        let split = drawable(*split)?.clamp(self.from.min(self.to), self.from.max(self.to));
        (split != self.to).then_some((split, self.to, series))
    }

    /// Formats one of its values: a labelled bar is in percent.
    pub(super) fn number(&self, value: f64) -> String {
        if self.label.is_empty() { value.to_string() } else { percent(value) }
    }

    /// Returns the diamond, if it can be drawn.
    pub(super) fn diamond(&self) -> Option<f64> {
        self.published.and_then(drawable)
    }
}

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
