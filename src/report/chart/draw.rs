//! Draws a chart: its panels one after the other, and the marks on axes of numbers.

use super::figure::{Figure, Words};
use super::flags::{self, Flag};
use super::labels::{self, Area, Label};
use super::layout::{Cell, Layout, slope_label};
use super::model::{Chart, Mark, Point, Shape};
use super::path::{closed, open, runs, thin};
use super::plot::Plot;
use super::scale::Scale;
use super::series::Series;
use super::style::{ChartWidth, MUTED, Medium, PANEL_TITLE, TICK};
use super::svg::{Anchor, Attributes, Canvas, Text};
use super::symbols::Ends;
use super::text::shorten;
use super::{Arrangement, ChartError};

/// Room above a plot, px, and above one with slopes, whose labels may stand there.
const HEAD: f64 = 8.0;
const SLOPE_HEAD: f64 = 18.0;
/// Longest label of a point on a phone, px.
const LONGEST_LABEL: f64 = 110.0;
/// Most points that are labelled: more would be a thicket.
const MOST_LABELS: usize = 60;

impl Chart {
    /// The chart as an SVG document for a page column, the same bytes for the same chart.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] if there is nothing to draw.
    pub fn svg(&self) -> Result<String, ChartError> {
        self.svg_at(ChartWidth::Wide)
    }

    /// The chart as an SVG document for `width`.
    ///
    /// # Errors
    /// [`ChartError`], as for [`svg`](Self::svg).
    pub fn svg_at(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(Medium { width, inline: false })
    }

    /// The chart as an SVG element for a page that sets [`title`](Self::title) and [`caption`](Self::caption) as text: it
    /// has a `viewBox` but no size, so that the style of the page scales it; an `aria-label`, and title and description
    /// for screen readers; and no `id`, so that any number of them may stand on a page.
    ///
    /// ```
    /// use apportion::report::chart::{Axis, Bar, Chart, ChartWidth, Colour, Panel, Series, Shape};
    ///
    /// let rows = Axis::from_names("", vec!["x1".to_owned()]);
    /// let bar = Series::new("effect", Colour::Series(0)).mark(Shape::Bar(Bar { to: 4.0, ..Bar::default() }));
    /// let chart = Chart::new("Effects", "x1 matters.")
    ///     .panels([Panel::new(Axis::new("effect", "nN"), rows).with([bar])]);
    /// let svg = chart.inline(ChartWidth::Narrow)?;
    /// assert!(svg.starts_with("<svg") && svg.contains("viewBox=\"0 0 360 "));
    /// # Ok::<(), apportion::report::chart::ChartError>(())
    /// ```
    ///
    /// # Errors
    /// [`ChartError`], as for [`svg`](Self::svg).
    pub fn inline(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(Medium { width, inline: true })
    }

    fn drawn(&self, medium: Medium) -> Result<String, ChartError> {
        if self.panels.is_empty() {
            return Err(ChartError::NoPanels { chart: self.title.clone() });
        }
        let words = Words { title: &self.title, caption: &self.caption };
        let mut figure = Figure::begin(medium, words, &self.legend());
        let bottom = self.draw_panels(&mut figure, medium.width);
        Ok(figure.finish(bottom, &self.data()))
    }

    /// Draws all panels from the figure's free room on; gives the lower edge.
    fn draw_panels(&self, figure: &mut Figure, page: ChartWidth) -> f64 {
        let layout = Layout::new(self, page);
        let last = layout.cells.len() - 1;
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
    /// The panel with its plot at its place from left to right.
    fn new(chart: &'a Chart, layout: &'a Layout<'a>, cell: &'a Cell<'a>, column: usize) -> Self {
        let left = layout.left + column as f64 * (layout.width + layout.gap);
        let plot = Plot { left, top: 0.0, width: layout.width, height: cell.height };
        let flags = flags::place(cell.panel.rules(), &cell.x, &plot, layout.page);
        Self { chart, layout, cell, plot, is_first_column: column == 0, flags }
    }

    fn is_titled(&self) -> bool {
        !self.cell.panel.title.trim().is_empty()
    }

    /// Room between the plot and the title of the panel.
    fn rise(&self) -> f64 {
        let least = if self.cell.panel.has_slopes() { SLOPE_HEAD } else { HEAD };
        flags::room(&self.flags).max(least)
    }

    fn head(&self) -> f64 {
        self.rise() + if self.is_titled() { PANEL_TITLE.leading() } else { 0.0 }
    }

    /// Draws the panel; gives its lower edge.
    fn draw(&self, canvas: &mut Canvas, with_x_axis: bool) -> f64 {
        let Cell { panel, x, y, .. } = self.cell;
        let plot = &self.plot;
        canvas.open("g", &[("class", &"panel")]);
        if self.is_titled() {
            let page = if self.layout.columns == 1 { self.layout.page } else { ChartWidth::Wide };
            plot.title(canvas, &panel.title, self.rise(), page);
        }
        if panel.tiles().next().is_none() {
            plot.x_grid(canvas, x);
        }
        if panel.has_rows() {
            flags::draw(canvas, plot, &self.flags);
            self.rows(canvas);
        } else {
            if self.is_first_column {
                plot.y_axis(canvas, y);
                plot.y_title(canvas, &panel.y.title(y.exponent), self.layout.y_title);
            } else {
                plot.y_grid(canvas, y);
            }
            plot.axis_lines(canvas);
            flags::draw(canvas, plot, &self.flags);
            self.marks(canvas);
        }
        canvas.close("g");
        if with_x_axis { plot.x_labels(canvas, x, &panel.x.title(x.exponent)) } else { plot.bottom() }
    }

    /// The marks on axes of numbers: what covers much first.
    fn marks(&self, canvas: &mut Canvas) {
        let marks = &self.cell.panel.marks;
        self.slopes(canvas);
        for Mark { series, shape } in marks {
            if let Shape::Dots(dots) = shape {
                let dots: Vec<_> = dots.iter().filter_map(|&dot| self.at(dot)).collect();
                canvas.dots(&dots, series.colour);
            }
        }
        for Mark { series, shape } in marks {
            if let Shape::Band(edges) = shape {
                self.band(canvas, series, edges);
            }
        }
        for Mark { series, shape } in marks {
            if let Shape::Line(points) = shape {
                self.line(canvas, series, points);
            }
        }
        let points: Vec<(&Series, &Point)> = marks.iter().filter_map(as_point).collect();
        self.labels(canvas, &points);
        self.points(canvas, &points);
        if !marks.iter().any(|mark| self.shows(mark)) {
            self.plot.note(canvas, "no value");
        }
    }

    /// The place of a point, if it has one.
    fn at(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        Some((self.plot.x(&self.cell.x, x)?, self.plot.y(&self.cell.y, y)?))
    }

    /// Both edges of a band at a place.
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

    /// A band of a series. Its rim has the contrast that its light filling lacks.
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

    fn slopes(&self, canvas: &mut Canvas) {
        let Some(origin) = self.at((0.0, 0.0)).filter(|_| self.cell.panel.has_slopes()) else { return };
        let (width, height) = (self.plot.right() - origin.0, origin.1 - self.plot.top);
        let (Some(x_px), Some(y_px)) =
            (px_per_unit(&self.cell.x, self.plot.width), px_per_unit(&self.cell.y, self.plot.height))
        else {
            return;
        };
        canvas.open("g", &[("class", &"slopes")]);
        for mark in &self.cell.panel.marks {
            let Shape::Slope(slope, whole) = &mark.shape else { continue };
            let rise = slope * (y_px / x_px);
            if !(rise.is_finite() && rise > 0.0) {
                continue;
            }
            let is_steep = rise > height / width;
            let end = if is_steep {
                (origin.0 + height / rise, self.plot.top)
            } else {
                (self.plot.right(), origin.1 - rise * width)
            };
            canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"1"), ("stroke-dasharray", &"5 4")]);
            canvas.line(origin, end);
            canvas.close("g");
            let label = slope_label(whole, self.layout.page);
            let text = if is_steep {
                Text::new(&label, (end.0, end.1 - 4.0), TICK).anchor(Anchor::Middle)
            } else {
                Text::new(&label, (end.0 + 4.0, end.1 + TICK.cap_height() / 2.0), TICK)
            };
            canvas.text(&text.fill(MUTED).whole(whole));
        }
        canvas.close("g");
    }

    /// The labels of points, those of larger x first.
    fn labels(&self, canvas: &mut Canvas, points: &[(&Series, &Point)]) {
        let mut shown: Vec<(&Point, (f64, f64))> =
            points.iter().filter_map(|(_, point)| Some((*point, self.at((point.x, point.y))?))).collect();
        if shown.is_empty() {
            return;
        }
        shown.sort_by(|a, b| b.0.x.total_cmp(&a.0.x).then(b.0.y.total_cmp(&a.0.y)));
        let text = |label: &str| self.layout.page.choose(label.to_owned(), shorten(label, LONGEST_LABEL, TICK));
        let wanted: Vec<Label> = (0..)
            .zip(&shown)
            .map(|(number, (point, at))| {
                // Without a label, or beyond the most labels, there is no room of any width.
                let labelled = number < MOST_LABELS && !point.label.trim().is_empty();
                let width = if labelled { TICK.width(&text(&point.label)) } else { f64::INFINITY };
                Label { at: *at, width, height: TICK.cap_height() }
            })
            .collect();
        let whiskers = shown.iter().flat_map(|(point, (x, y))| {
            let (level, upright) = self.whiskers(point);
            let level = level.map(|ends| Area::between(ends, (y - 1.0, y + 1.0)));
            level.into_iter().chain(upright.map(|ends| Area::between((x - 1.0, x + 1.0), ends)))
        });
        let plot = &self.plot;
        let bounds = Area { left: plot.left, right: plot.right() + 2.0, top: plot.top, bottom: plot.bottom() };
        let places = labels::place(&wanted, &whiskers.collect::<Vec<_>>(), bounds);
        canvas.open("g", &[("class", &"labels")]);
        for ((point, _), place) in shown.iter().zip(places) {
            let Some(labels::Place { area, leader }) = place else { continue };
            if let Some([from, to]) = leader {
                canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"0.7")]);
                canvas.line(from, to);
                canvas.close("g");
            }
            let middle = ((area.left + area.right) / 2.0, (area.top + area.bottom + TICK.cap_height()) / 2.0);
            let label = text(&point.label);
            canvas.text(&Text::new(&label, middle, TICK).anchor(Anchor::Middle).halo().whole(&point.label));
        }
        canvas.close("g");
    }

    /// The places of a point's interval ends, along the axes.
    fn whiskers(&self, point: &Point) -> (Ends, Ends) {
        let x = |(low, high)| Some((self.plot.x(&self.cell.x, low)?, self.plot.x(&self.cell.x, high)?));
        let y = |(low, high)| Some((self.plot.y(&self.cell.y, low)?, self.plot.y(&self.cell.y, high)?));
        (point.x_interval.and_then(x), point.y_interval.and_then(y))
    }

    /// The points, series by series: first the intervals.
    fn points(&self, canvas: &mut Canvas, points: &[(&Series, &Point)]) {
        for of_series in points.chunk_by(|a, b| a.0 == b.0) {
            let shown = || of_series.iter().filter_map(|(_, point)| Some((self.at((point.x, point.y))?, *point)));
            let colour = of_series[0].0.colour;
            canvas.open("g", &[("class", &"series")]);
            canvas.content("title", &[], &of_series[0].0.name);
            shown().for_each(|(at, point)| canvas.thin_whiskers(at, self.whiskers(point), colour));
            shown().for_each(|(at, _)| canvas.point(at, colour));
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

/// Length of one unit of a linear scale that is so many px long.
fn px_per_unit(scale: &Scale, length: f64) -> Option<f64> {
    let [first, second] = [scale.ticks.first()?.value, scale.ticks.get(1)?.value];
    Some((scale.place(second)? - scale.place(first)?) * length / (second - first))
}
