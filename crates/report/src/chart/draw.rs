//! Draws a chart: its panels one after the other, and the marks on axes of numbers.

use super::Arrangement;
use super::figure::Figure;
use super::flags::{self, Flag};
use super::labels::{self, Area, Label};
use super::layout::{Cell, Layout};
use super::model::{Chart, Mark, Point, Series, Shape};
use super::path::{closed, open, runs, thin};
use super::plot::Plot;
use super::style::{ChartWidth, MUTED, Medium, PANEL_TITLE, TICK};
use super::svg::{Anchor, Attributes, Canvas, Text};
use super::text::shorten;

/// Room above a plot, px.
const HEAD: f64 = 8.0;
/// Length of the longest label of a point on a phone, px.
const LONGEST_LABEL: f64 = 110.0;
/// Maximum number of labelled points: more would be unreadable.
const MAX_LABELS: usize = 60;

impl Chart {
    /// Draws the chart as an SVG document for a page column; the same chart gives the same bytes.
    pub fn svg(&self) -> String {
        self.svg_at(ChartWidth::Wide)
    }

    /// Draws the chart as an SVG document for `width`.
    pub fn svg_at(&self, width: ChartWidth) -> String {
        self.drawn(Medium { width, id: None })
    }

    /// Draws the chart as an SVG element for a page that sets [`title`](Self::title) and [`caption`](Self::caption) as
    /// text: it has a `viewBox` but no size, so that the style of the page scales it; an `aria-label`, and title and
    /// description for screen readers, whose identifiers begin with `id`.
    ///
    /// ```
    /// use apportion_report::chart::{Axis, Bar, Chart, ChartWidth, Colour, Panel, Series, Shape};
    ///
    /// let rows = Axis::from_names("", vec!["x1".to_owned()]);
    /// let bar = Series::new("effect", Colour::Series(0)).mark(Shape::Bar(Bar { to: 4.0, ..Bar::default() }));
    /// let chart = Chart::new("Effects", "x1 matters.")
    ///     .panels([Panel::new(Axis::new("effect", "nN"), rows).with([bar])]);
    /// let svg = chart.inline(ChartWidth::Narrow, "effects");
    /// assert!(svg.starts_with("<svg") && svg.contains("viewBox=\"0 0 360 "));
    /// ```
    pub fn inline(&self, width: ChartWidth, id: &str) -> String {
        self.drawn(Medium { width, id: Some(id) })
    }

    fn drawn(&self, medium: Medium<'_>) -> String {
        let mut figure = Figure::begin(medium, self);
        let bottom = self.draw_panels(&mut figure, medium.width);
        figure.finish(bottom)
    }

    /// Draws all panels in the free room of the figure and returns the lower edge.
    fn draw_panels(&self, figure: &mut Figure, page: ChartWidth) -> f64 {
        let layout = Layout::new(self, page);
        let last = layout.cells.len().saturating_sub(1);
        let mut top = figure.top + 4.0;
        let mut bottom = top;
        for (row, cells) in layout.cells.chunks(layout.columns).enumerate() {
            let sheets: Vec<Sheet<'_>> =
                (0..).zip(cells).map(|(column, cell)| Sheet::new(self, &layout, cell, column)).collect();
            let head = sheets.iter().map(Sheet::head).fold(0.0, f64::max);
            for (column, mut sheet) in sheets.into_iter().enumerate() {
                sheet.plot.top = top + head;
                let number = row * layout.columns + column;
                let with_x_axis = self.arrangement == Arrangement::SideBySide || number == last;
                bottom = bottom.max(sheet.draw(&mut figure.canvas, with_x_axis));
            }
            top = bottom + HEAD;
        }
        bottom
    }
}

/// A panel being drawn.
pub(super) struct Sheet<'a> {
    pub chart: &'a Chart,
    pub layout: &'a Layout<'a>,
    pub cell: &'a Cell<'a>,
    pub plot: Plot,
    pub is_first_column: bool,
    flags: Vec<Flag<'a>>,
}

impl<'a> Sheet<'a> {
    /// Creates the panel with its plot at its position from left to right.
    fn new(chart: &'a Chart, layout: &'a Layout<'a>, cell: &'a Cell<'a>, column: usize) -> Self {
        let left = layout.left + column as f64 * (layout.width + layout.gap);
        let plot = Plot { left, top: 0.0, width: layout.width, height: cell.height };
        let flags = flags::place(cell.panel.rules(), &cell.x, &plot, layout.page);
        Self { chart, layout, cell, plot, is_first_column: column == 0, flags }
    }

    fn is_titled(&self) -> bool {
        !self.cell.panel.title.trim().is_empty()
    }

    /// Returns the room between the plot and the title of the panel.
    fn rise(&self) -> f64 {
        flags::room(&self.flags).max(HEAD)
    }

    fn head(&self) -> f64 {
        self.rise() + if self.is_titled() { PANEL_TITLE.leading() } else { 0.0 }
    }

    /// Draws the panel and returns its lower edge.
    fn draw(&self, canvas: &mut Canvas, with_x_axis: bool) -> f64 {
        let Cell { panel, x, y, .. } = self.cell;
        let plot = &self.plot;
        canvas.open("g", &[("class", &"panel")]);
        if self.is_titled() {
            let page = if self.layout.columns == 1 { self.layout.page } else { ChartWidth::Wide };
            plot.title(canvas, &panel.title, self.rise(), page);
        }
        if !panel.is_map() {
            plot.x_grid(canvas, x);
        }
        if panel.has_rows() {
            flags::draw(canvas, plot, &self.flags);
            self.rows(canvas);
        } else {
            plot.y_axis(canvas, y, self.is_first_column);
            if self.is_first_column {
                plot.y_title(canvas, &panel.y.title(y.exponent), self.layout.y_title);
            }
            plot.axis_lines(canvas);
            flags::draw(canvas, plot, &self.flags);
            self.marks(canvas);
        }
        canvas.close("g");
        if with_x_axis { plot.x_labels(canvas, x, &panel.x.title(x.exponent)) } else { plot.bottom() }
    }

    /// Draws the marks on axes of numbers: those that cover much first.
    fn marks(&self, canvas: &mut Canvas) {
        let marks = &self.cell.panel.marks;
        for layer in 0..3 {
            for Mark { series, shape } in marks {
                match shape {
                    Shape::Dots(dots) if layer == 0 => {
                        let dots: Vec<_> = dots.iter().filter_map(|&dot| self.at(dot)).collect();
                        canvas.dots(&dots, series.colour);
                    }
                    Shape::Band(edges) if layer == 1 => self.band(canvas, series, edges),
                    Shape::Line(points) if layer == 2 => self.line(canvas, series, points),
                    _ => (),
                }
            }
        }
        let points: Vec<(&Series, &Point)> = marks.iter().filter_map(as_point).collect();
        self.labels(canvas, &points);
        self.points(canvas, &points);
        if !marks.iter().any(|mark| self.shows(mark)) {
            self.plot.note(canvas, "no value");
        }
    }

    /// Returns the place of a point, if it has one.
    fn at(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        Some((self.plot.x(&self.cell.x, x)?, self.plot.y(&self.cell.y, y)?))
    }

    /// Returns both edges of a band at a position.
    fn edges(&self, &(x, low, high): &(f64, f64, f64)) -> Option<[(f64, f64); 2]> {
        Some([self.at((x, low))?, self.at((x, high))?])
    }

    fn shows(&self, mark: &Mark) -> bool {
        match &mark.shape {
            Shape::Line(points) | Shape::Dots(points) => points.iter().any(|&point| self.at(point).is_some()),
            Shape::Band(edges) => edges.iter().any(|edges| self.edges(edges).is_some()),
            Shape::Point(point) => self.at((point.x, point.y)).is_some(),
            _ => false,
        }
    }

    /// Draws a band of a series. Its rim has the contrast that its light filling does not have.
    fn band(&self, canvas: &mut Canvas, series: &Series, edges: &[(f64, f64, f64)]) {
        for run in runs(edges.iter().map(|edges| self.edges(edges))) {
            let lower: Vec<_> = run.iter().map(|edges| edges[0]).collect();
            let upper: Vec<_> = run.iter().map(|edges| edges[1]).collect();
            let d = closed(&thin(&lower), &thin(&upper));
            let fill = series.colour.hex();
            let filling: Attributes = &[("class", &"band"), ("d", &d), ("fill", &fill), ("fill-opacity", &"0.18")];
            canvas.leaf("path", &[filling, &[("stroke", &fill), ("stroke-width", &"0.7")]].concat());
        }
    }

    fn line(&self, canvas: &mut Canvas, series: &Series, points: &[(f64, f64)]) {
        canvas.open("g", &[("class", &"series")]);
        canvas.content("title", &[], &series.name);
        let width = if series.stroke.has_points() { "1.4" } else { "1.8" };
        for run in runs(points.iter().map(|&point| self.at(point))) {
            if series.stroke.has_line() && run.len() > 1 {
                canvas.leaf(
                    "path",
                    &[
                        ("d", &open(&thin(&run))),
                        ("fill", &"none"),
                        ("stroke", &series.colour.hex()),
                        ("stroke-width", &width),
                        ("stroke-linejoin", &"round"),
                        ("stroke-dasharray", &series.stroke.dash()),
                    ],
                );
            }
            // A point between two gaps would be invisible as a line.
            if series.stroke.has_points() || run.len() == 1 {
                run.iter().for_each(|&point| canvas.point(point, series.colour));
            }
        }
        canvas.close("g");
    }

    /// Returns the label of a point as it is drawn.
    fn label_text(&self, label: &str) -> String {
        self.layout.page.choose(label.to_owned(), shorten(label, LONGEST_LABEL, TICK))
    }

    /// Draws the labels of points, those of larger x first.
    fn labels(&self, canvas: &mut Canvas, points: &[(&Series, &Point)]) {
        let mut shown: Vec<(&Point, (f64, f64))> =
            points.iter().filter_map(|(_, point)| Some((*point, self.at((point.x, point.y))?))).collect();
        if shown.is_empty() {
            return;
        }
        shown.sort_by(|a, b| b.0.x.total_cmp(&a.0.x).then(b.0.y.total_cmp(&a.0.y)));
        let wanted: Vec<Label> = (0..)
            .zip(&shown)
            .map(|(number, (point, at))| {
                // Without a label, or beyond the maximum number of labels, the width is infinite, which fits nowhere.
                let labelled = number < MAX_LABELS && !point.label.trim().is_empty();
                let width = if labelled { TICK.width(&self.label_text(&point.label)) } else { f64::INFINITY };
                Label { at: *at, width, height: TICK.cap_height() }
            })
            .collect();
        let plot = &self.plot;
        let bounds = Area { left: plot.left, right: plot.right() + 2.0, top: plot.top, bottom: plot.bottom() };
        let places = labels::place(&wanted, bounds);
        canvas.open("g", &[("class", &"labels")]);
        for ((point, _), place) in shown.iter().zip(places) {
            let Some(labels::Place { area, leader }) = place else { continue };
            if let Some([from, to]) = leader {
                canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"0.7")]);
                canvas.line(from, to);
                canvas.close("g");
            }
            let middle = ((area.left + area.right) / 2.0, (area.top + area.bottom + TICK.cap_height()) / 2.0);
            let label = self.label_text(&point.label);
            canvas.text(&Text::new(&label, middle, TICK).anchor(Anchor::Middle).halo().tooltip(&point.label));
        }
        canvas.close("g");
    }

    /// Draws the points, series by series.
    fn points(&self, canvas: &mut Canvas, points: &[(&Series, &Point)]) {
        for of_series in points.chunk_by(|a, b| a.0 == b.0) {
            canvas.open("g", &[("class", &"series")]);
            canvas.content("title", &[], &of_series[0].0.name);
            let shown = of_series.iter().filter_map(|(_, point)| self.at((point.x, point.y)));
            shown.for_each(|at| canvas.point(at, of_series[0].0.colour));
            canvas.close("g");
        }
    }
}

fn as_point(mark: &Mark) -> Option<(&Series, &Point)> {
    match &mark.shape {
        Shape::Point(point) => Some((&mark.series, point)),
        _ => None,
    }
}
