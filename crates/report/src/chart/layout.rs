//! The positions and scales of the panels of a chart.

use super::model::{Arrangement, Bar, Chart, Mark, Panel, Shape, Tile};
use super::plot::{TICK_GAP, tick_room, title_room};
use super::scale::{Scale, ScaleOptions};
use super::style::{ChartWidth, MARGIN, TICK, VALUE, drawable};
use super::text::shorten;

/// Heights of the plot of a single panel and of each of several, px.
const HEIGHTS: (f64, f64) = (320.0, 170.0);
/// The same on a phone.
const NARROW_HEIGHTS: (f64, f64) = (230.0, 140.0);
/// Heights of a plot with labelled points, px, and the same on a phone.
const LABELLED_HEIGHTS: (f64, f64) = (400.0, 290.0);
/// Minimum gap between neighbours, px.
const GAP: f64 = 16.0;
/// Gap between a plot and the text next to it, px.
pub(super) const TEXT_GAP: f64 = 6.0;
/// Ratio below which positive values are shown on an axis from zero.
const NEAR_ZERO: f64 = 0.4;
/// Length of the longest name of a row, px; longer ones are shortened.
const LONGEST_NAME: f64 = 220.0;
/// Height of one of several bars in a row, of a bar with a label or a published value, and minimum height of the bars
/// of a row, px.
const LANE: f64 = 6.0;
const LABELLED_LANE: f64 = 10.0;
const MIN_BARS: f64 = 16.0;
/// Gap between the bars of two rows, px.
pub(super) const ROW_GAP: f64 = 8.0;
/// Height of the line of text above a row on a phone, px.
const HEADING: f64 = 15.0;
/// Room for the label after a bar in addition to its width, px.
const LABEL_ROOM: f64 = 10.0;

/// A panel with its scales.
pub(super) struct Cell<'a> {
    pub panel: &'a Panel,
    pub x: Scale,
    pub y: Scale,
    pub height: f64,
}

/// All panels of a chart and their common lengths, px.
pub(super) struct Layout<'a> {
    pub page: ChartWidth,
    pub columns: usize,
    pub cells: Vec<Cell<'a>>,
    pub left: f64,
    pub width: f64,
    pub gap: f64,
    /// The baseline of the titles of the vertical axes.
    pub y_title: f64,
    pub rows: Rows,
}

/// Heights of the rows of bars, px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    /// From one row to the next.
    pub pitch: f64,
    /// Of the bars of a row.
    pub bars: f64,
}

impl<'a> Layout<'a> {
    pub fn new(chart: &'a Chart, page: ChartWidth) -> Self {
        let panels = &chart.panels[..];
        let columns = columns(chart, page);
        let rows = Rows::new(panels, page);
        let heights: Vec<f64> = panels.iter().map(|panel| height(panel, panels.len() == 1, rows, page)).collect();
        let y = y_scales(chart, &heights);
        let (mut titles, mut ticks) = (0.0_f64, 0.0_f64);
        for ((panel, y), height) in panels.iter().zip(&y).zip(&heights).filter(|((panel, _), _)| !panel.has_rows()) {
            titles = titles.max(title_room(&panel.y.title(y.exponent), *height));
            ticks = ticks.max(tick_room(y));
        }
        let names = panels.iter().flat_map(|panel| &panel.y.names).map(|name| TICK.width(&row_name(name)) + TEXT_GAP);
        let names = page.choose(names.fold(0.0, f64::max), 0.0);
        let left = MARGIN + (titles + ticks).max(names);
        let (mut left, mut right, mut gap) = (left, MARGIN, GAP);
        for (_, x) in panels
            .iter()
            .zip(x_scales(chart, column_width(page.px() - left - right, columns, gap)))
            .filter(|(panel, _)| panel.x.names.is_empty())
        {
            let widths: Vec<f64> = x.ticks.iter().map(|tick| TICK.width(&tick.label)).collect();
            // Half of an outer tick label may extend beyond the plot.
            left = widths.first().map_or(left, |width| left.max(width / 2.0 + 2.0));
            right = widths.last().map_or(right, |width| right.max(width / 2.0 + 4.0));
            gap = widths.into_iter().map(|width| width + 8.0).fold(gap, f64::max);
        }
        let width = column_width(page.px() - left - right, columns, gap);
        let cells = panels.iter().zip(x_scales(chart, width)).zip(y).zip(heights);
        let cells = cells.map(|(((panel, x), y), height)| Cell { panel, x, y, height }).collect();
        Self { page, columns, cells, left, width, gap, y_title: left - ticks - TICK_GAP - 4.0, rows }
    }
}

/// Returns the width of each of several columns within `width`, px.
fn column_width(width: f64, columns: usize, gap: f64) -> f64 {
    ((width - (columns - 1) as f64 * gap) / columns as f64).max(10.0)
}

impl Rows {
    fn new(panels: &[Panel], page: ChartWidth) -> Self {
        let mut bars = panels.iter().flat_map(Panel::bars);
        let is_labelled = bars.any(|(_, bar)| !bar.label.is_empty() || bar.diamond().is_some());
        let lane = if is_labelled { LABELLED_LANE } else { LANE };
        let mut max_bars = 0;
        for panel in panels {
            for row in 0..panel.y.names.len() {
                max_bars = max_bars.max(panel.bars().filter(|(_, bar)| bar.row == row).count());
            }
        }
        let bars = (max_bars as f64 * lane).max(MIN_BARS);
        Self { pitch: bars + ROW_GAP + page.choose(0.0, HEADING), bars }
    }
}

impl Panel {
    /// Returns whether the vertical axis has names.
    pub(super) fn has_rows(&self) -> bool {
        !self.y.names.is_empty()
    }

    /// Iterates over the bars with their marks.
    pub(super) fn bars(&self) -> impl Iterator<Item = (&Mark, &Bar)> + Clone {
        self.marks.iter().filter_map(|mark| match &mark.shape {
            Shape::Bar(bar) => Some((mark, bar)),
            _ => None,
        })
    }

    /// Iterates over the cells of a map with their marks.
    pub(super) fn tiles(&self) -> impl Iterator<Item = (&Mark, &Tile)> {
        self.marks.iter().filter_map(|mark| match &mark.shape {
            Shape::Tile(tile) => Some((mark, tile)),
            _ => None,
        })
    }

    /// Returns whether it is a map, whose rows hold cells and not bars about a value.
    pub(super) fn is_map(&self) -> bool {
        self.tiles().next().is_some()
    }

    /// Iterates over the rules as (place, label).
    pub(super) fn rules(&self) -> impl Iterator<Item = (f64, &str)> {
        self.marks.iter().filter_map(|mark| match &mark.shape {
            Shape::Rule(x, label) => Some((*x, label.as_str())),
            _ => None,
        })
    }

    /// Returns the value at which bars start.
    pub(super) fn base(&self) -> f64 {
        self.rules().find_map(|(x, _)| drawable(x)).unwrap_or(0.0)
    }

    /// Returns whether it has labelled points, which need more room than lines.
    fn has_points(&self) -> bool {
        self.marks.iter().any(|mark| matches!(mark.shape, Shape::Point(_)))
    }

    /// Returns the coordinates of all marks; a missing coordinate is 0.
    fn places(&self) -> Vec<(f64, f64)> {
        let mut places = Vec::new();
        for mark in &self.marks {
            match &mark.shape {
                Shape::Line(points) | Shape::Dots(points) => places.extend_from_slice(points),
                Shape::Band(edges) => places.extend(edges.iter().flat_map(|&(x, low, high)| [(x, low), (x, high)])),
                Shape::Point(point) => places.push((point.x, point.y)),
                Shape::Bar(bar) => {
                    let ends = bar.drawn().map_or_else(|| Vec::from_iter(bar.diamond()), |bar| bar.ends());
                    places.extend(ends.into_iter().map(|x| (x, 0.0)));
                }
                Shape::Tile(_) | Shape::Rule(..) => (),
            }
        }
        places
    }

    fn x_values(&self) -> Vec<f64> {
        let base = self.has_rows().then(|| self.base());
        self.places().into_iter().map(|place| place.0).chain(self.rules().map(|rule| rule.0)).chain(base).collect()
    }

    /// Returns the ordinates of everything that has a position on the horizontal axis.
    fn y_values(&self) -> Vec<f64> {
        self.places().into_iter().filter(|place| self.x.spacing.shows(place.0)).map(|place| place.1).collect()
    }
}

impl Bar {
    /// Returns every value that it marks.
    fn ends(&self) -> Vec<f64> {
        let (low, high) = self.interval.unzip();
        [Some(self.from), Some(self.to), low, high, self.diamond()].into_iter().flatten().collect()
    }

    /// Returns the right end of bar and interval, after which the label is written.
    pub(super) fn right(&self) -> f64 {
        self.from.max(self.to).max(self.interval.map_or(self.to, |(low, high)| low.max(high)))
    }
}

/// Returns the number of panels side by side.
fn columns(chart: &Chart, page: ChartWidth) -> usize {
    let panels = &chart.panels[..];
    let count = panels.len().max(1);
    if chart.arrangement == Arrangement::Stacked {
        return 1;
    }
    if panels.iter().any(Panel::has_rows) {
        // They share the names on the left.
        let alike = panels.windows(2).all(|pair| pair[0].y.names == pair[1].y.names);
        return if alike { count.min(page.choose(2, 1)) } else { 1 };
    }
    // Four panels make two even rows.
    if count == 4 { 2 } else { count.min(page.choose(3, 2)) }
}

fn height(panel: &Panel, alone: bool, rows: Rows, page: ChartWidth) -> f64 {
    let (lone, several) = page.choose(HEIGHTS, NARROW_HEIGHTS);
    match alone {
        _ if panel.has_rows() => rows.pitch * panel.y.names.len() as f64,
        true if panel.has_points() => page.choose(LABELLED_HEIGHTS.0, LABELLED_HEIGHTS.1),
        true => lone,
        false => several,
    }
}

/// Returns the scale of each panel's horizontal axis: one for all if they are stacked or have equal axes.
fn x_scales(chart: &Chart, width: f64) -> Vec<Scale> {
    let panels = &chart.panels[..];
    let shared = chart.arrangement == Arrangement::Stacked || panels.windows(2).all(|pair| pair[0].x == pair[1].x);
    match panels.first() {
        Some(first) if shared => vec![x_scale(first, panels, width); panels.len()],
        _ => panels.iter().map(|panel| x_scale(panel, std::slice::from_ref(panel), width)).collect(),
    }
}

fn x_scale(first: &Panel, panels: &[Panel], width: f64) -> Scale {
    if !first.x.names.is_empty() {
        return Scale::from_names(&first.x.names).with_names_within(width);
    }
    let mut values: Vec<f64> = panels.iter().flat_map(Panel::x_values).collect();
    values.extend(room_for_labels(panels, &values, width));
    let mut marks = panels.iter().flat_map(|panel| &panel.marks);
    let air = match () {
        () if panels.iter().any(Panel::has_rows) => 0.03,
        () if panels.iter().any(Panel::has_points) => 0.06,
        // Points need free room at the ends; lines run from edge to edge.
        () if marks.any(|mark| matches!(mark.shape, Shape::Dots(_)) || mark.series.stroke.has_points()) => 0.02,
        () => 0.0,
    };
    let options = ScaleOptions { spacing: first.x.spacing, air, steps: steps(width, 50.0, 7) };
    Scale::over(values, options).with_room(width)
}

/// Returns the value up to which an axis must extend for the labels after its bars.
fn room_for_labels(panels: &[Panel], values: &[f64], width: f64) -> Option<f64> {
    let low = values.iter().copied().filter_map(drawable).reduce(f64::min)?;
    let needed = panels.iter().flat_map(Panel::bars).filter_map(|(_, bar)| {
        let room = (VALUE.width(&bar.label) + LABEL_ROOM).min(0.5 * width);
        let bar = bar.drawn().filter(|bar| !bar.label.is_empty())?;
        // The label may be behind the published value.
        let (right, diamond) = (bar.right(), bar.diamond().unwrap_or(f64::NEG_INFINITY));
        let behind = low + (right - low) * width / (width - (room + LABEL_ROOM));
        let right = if diamond < behind { right.max(diamond) } else { right };
        drawable(low + (right - low) * width / (width - room))
    });
    needed.reduce(f64::max)
}

/// Returns the scale of each panel's vertical axis: one for all if they are side by side.
fn y_scales(chart: &Chart, heights: &[f64]) -> Vec<Scale> {
    let panels = &chart.panels[..];
    match (chart.arrangement, panels.first(), heights.first()) {
        (Arrangement::SideBySide, Some(first), Some(height)) => {
            vec![y_scale(first, panels, *height); panels.len()]
        }
        _ => panels.iter().zip(heights).map(|(panel, h)| y_scale(panel, std::slice::from_ref(panel), *h)).collect(),
    }
}

fn y_scale(first: &Panel, panels: &[Panel], height: f64) -> Scale {
    if first.has_rows() {
        return Scale::from_names(&first.y.names);
    }
    let mut values: Vec<f64> = panels.iter().flat_map(Panel::y_values).collect();
    let shown = values.iter().filter(|y| y.is_finite());
    let (low, high) = shown.fold((f64::INFINITY, 0.0_f64), |(l, h), y| (l.min(*y), h.max(*y)));
    // Zero is included unless it would take much of the axis. A logarithmic scale ignores it.
    values.extend((low > 0.0 && low < NEAR_ZERO * high).then_some(0.0));
    Scale::over(values, ScaleOptions { spacing: first.y.spacing, air: 0.05, steps: steps(height, 45.0, 6) })
}

/// Returns the approximate number of steps between ticks of an axis: one for so many px, but at most `max_steps`.
fn steps(length: f64, px: f64, max_steps: usize) -> usize {
    ((length / px).round() as usize).clamp(3, max_steps)
}

/// Returns the name of a row as written next to the plot.
pub(super) fn row_name(name: &str) -> String {
    shorten(name, LONGEST_NAME, TICK)
}
