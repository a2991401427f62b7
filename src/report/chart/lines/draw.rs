//! Draws the panels of a line chart.

use super::super::figure::Figure;
use super::super::plot::{Plot, TICK_GAP, tick_room, title_room};
use super::super::scale::{Scale, Wish};
use super::super::style::{ChartWidth, MARGIN, PANEL_TITLE, TICK};
use super::super::svg::Canvas;
use super::sheet::Sheet;
use super::{LineChart, LinePanel, flags};

/// Heights of the plot of a lone panel and of each among several, px.
const HEIGHTS: (f64, f64) = (320.0, 170.0);
/// The same on a phone.
const NARROW_HEIGHTS: (f64, f64) = (230.0, 150.0);
/// Positive values whose ratio is below this are shown from zero on.
const NEAR_ZERO: f64 = 0.4;
/// Room above a plot without markers, px.
const HEAD: f64 = 8.0;

/// What all panels share.
struct Common {
    x: Scale,
    left: f64,
    width: f64,
    height: f64,
    /// Where the titles of the vertical axes have their baseline.
    y_title: f64,
    /// What it is drawn for.
    page: ChartWidth,
}

/// Draws all panels from the figure's free room on; gives the lower edge.
pub(super) fn panels(figure: &mut Figure, chart: &LineChart, page: ChartWidth) -> f64 {
    let (lone, stacked) = page.choose(HEIGHTS, NARROW_HEIGHTS);
    let alone = chart.panels.len() == 1;
    let height = if alone { lone } else { stacked };
    let x = x_scale(chart, page);
    let scales: Vec<Scale> = chart.panels.iter().map(|panel| y_scale(panel, &x, alone)).collect();
    let titled = || chart.panels.iter().zip(&scales);
    let titles = titled().map(|(panel, y)| title_room(&panel.y.title(y.exponent), height)).fold(0.0, f64::max);
    let ticks = scales.iter().map(tick_room).fold(0.0, f64::max);
    let left = MARGIN + titles + ticks;
    // Half of the last tick label may reach beyond the plot.
    let overhang = x.ticks.last().map_or(0.0, |tick| TICK.width(&tick.label) / 2.0 + 4.0);
    let width = page.px() - left - MARGIN.max(overhang);
    let x = match page {
        _ if !chart.names.is_empty() => x.with_names_within(width),
        ChartWidth::Narrow => x.with_room(width),
        ChartWidth::Wide => x,
    };
    let common = Common { x, left, width, height, y_title: left - ticks - TICK_GAP, page };

    let mut top = figure.top + 4.0;
    let mut last = None;
    for (panel, y) in titled() {
        let plot = common.panel(&mut figure.canvas, (panel, y), top);
        top = plot.bottom() + HEAD;
        last = Some(plot);
    }
    match last {
        Some(plot) => plot.x_labels(&mut figure.canvas, &common.x, &chart.x.title(common.x.exponent)),
        None => top,
    }
}

fn x_scale(chart: &LineChart, page: ChartWidth) -> Scale {
    if !chart.names.is_empty() {
        return Scale::named(&chart.names);
    }
    let mut series = chart.panels.iter().flat_map(|panel| &panel.series);
    // Points need air at the ends; lines run from edge to edge.
    let air = if series.any(|series| series.stroke.points()) { 0.02 } else { 0.0 };
    let wish = Wish { spacing: chart.x.spacing, air, steps: page.choose(7, 4) };
    Scale::over(chart.panels.iter().flat_map(LinePanel::xs), wish)
}

fn y_scale(panel: &LinePanel, x: &Scale, alone: bool) -> Scale {
    let steps = if alone { 6 } else { 4 };
    let wish = Wish { spacing: panel.y.spacing, air: 0.05, steps };
    let (low, high) =
        panel.ys(x).filter(|y| y.is_finite()).fold((f64::INFINITY, 0.0_f64), |(l, h), y| (l.min(y), h.max(y)));
    // Zero belongs to the picture unless it would take much of it. A logarithmic scale passes over it.
    let zero = (low > 0.0 && low < NEAR_ZERO * high).then_some(0.0);
    Scale::over(panel.ys(x).chain(zero), wish)
}

impl Common {
    fn panel(&self, canvas: &mut Canvas, (panel, y): (&LinePanel, &Scale), top: f64) -> Plot {
        let mut plot = Plot { left: self.left, top, width: self.width, height: self.height };
        let flags = flags::place(&panel.markers, &self.x, (&plot, self.page));
        let above = flags::room(&flags).max(HEAD);
        let title = !panel.title.trim().is_empty();
        plot.top += above + if title { PANEL_TITLE.leading() } else { 0.0 };
        canvas.open("g", &[("class", &"panel")]);
        if title {
            plot.title(canvas, &panel.title, (above, self.page));
        }
        plot.x_grid(canvas, &self.x);
        plot.y_axis(canvas, y);
        plot.y_title(canvas, &panel.y.title(y.exponent), self.y_title);
        plot.axis_lines(canvas);
        flags::draw(canvas, &plot, &flags);
        let sheet = Sheet { plot, x: &self.x, y };
        for series in &panel.series {
            sheet.band(canvas, series);
        }
        for series in &panel.series {
            sheet.series(canvas, series);
        }
        if !panel.series.iter().any(|series| sheet.shows(series)) {
            plot.note(canvas, "no value");
        }
        canvas.close("g");
        plot
    }
}
