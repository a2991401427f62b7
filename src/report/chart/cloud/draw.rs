//! Draws the panels of a cloud chart.

use super::super::figure::Figure;
use super::super::lines::sheet::Sheet;
use super::super::plot::{Plot, TICK_GAP, tick_room, title_room};
use super::super::scale::{Scale, Wish};
use super::super::style::{ChartWidth, MARGIN, PANEL_TITLE, TICK};
use super::super::svg::{Canvas, Text};
use super::super::text::shorten;
use super::{CloudChart, CloudPanel};

/// Heights of the plot of a lone panel and of each among several, px.
const HEIGHTS: (f64, f64) = (300.0, 170.0);
/// The same on a phone.
const NARROW_HEIGHTS: (f64, f64) = (220.0, 120.0);
/// Least gap between neighbours, px.
const GAP: f64 = 16.0;
/// Room above a plot, px.
const HEAD: f64 = 8.0;
/// Positive values whose ratio is below this are shown from zero on.
const NEAR_ZERO: f64 = 0.4;

/// Draws all panels from the figure's free room on; gives the lower edge.
pub(super) fn panels(figure: &mut Figure, chart: &CloudChart, page: ChartWidth) -> f64 {
    let columns = columns(chart.panels.len(), page);
    let (lone, several) = page.choose(HEIGHTS, NARROW_HEIGHTS);
    let height = if chart.panels.len() == 1 { lone } else { several };
    let y = y_scale(chart, page);
    let y_title = chart.y.title(y.exponent);
    let steps = page.choose(if columns == 1 { 7 } else { 4 }, if columns == 1 { 4 } else { 3 });
    let scales: Vec<Scale> = chart.panels.iter().map(|panel| x_scale(panel, steps)).collect();
    // Names are shortened to their places, so that they reach nowhere.
    let numbers = chart.panels.iter().zip(&scales).filter(|(panel, _)| panel.names.is_empty());
    let widest = numbers.flat_map(|(_, x)| &x.ticks).map(|tick| TICK.width(&tick.label)).fold(0.0, f64::max);
    let left = MARGIN + title_room(&y_title, height) + tick_room(&y);
    let gap = GAP.max(widest + 8.0);
    // Half of the last tick label may reach beyond the plot.
    let room = page.px() - left - MARGIN.max(widest / 2.0 + 4.0);
    let width = (room - (columns - 1) as f64 * gap) / columns as f64;

    let mut top = figure.top + 4.0;
    for (row, panels) in chart.panels.chunks(columns).enumerate() {
        let mut bottom = top;
        let titled = panels.iter().any(|panel| !panel.title.trim().is_empty());
        let head = HEAD + if titled { PANEL_TITLE.leading() } else { 0.0 };
        for (column, panel) in panels.iter().enumerate() {
            let x = scales[row * columns + column].clone();
            let x = if panel.names.is_empty() { x.with_room(width) } else { x.with_names_within(width) };
            let plot = Plot { left: left + column as f64 * (width + gap), top: top + head, width, height };
            let canvas = &mut figure.canvas;
            canvas.open("g", &[("class", &"panel")]);
            if titled {
                let line = shorten(&panel.title, width, PANEL_TITLE);
                canvas.text(&Text::new(&line, (plot.left, plot.top - HEAD), PANEL_TITLE).whole(&panel.title));
            }
            plot.x_grid(canvas, &x);
            if column == 0 {
                plot.y_axis(canvas, &y);
                plot.y_title(canvas, &y_title, left - tick_room(&y) - TICK_GAP);
            } else {
                plot.y_grid(canvas, &y);
            }
            plot.axis_lines(canvas);
            Sheet { plot, x: &x, y: &y }.cloud(canvas, (chart, panel));
            bottom = bottom.max(plot.x_labels(canvas, &x, &panel.x.title(x.exponent)));
            canvas.close("g");
        }
        top = bottom + 6.0;
    }
    top - 6.0
}

/// How many panels stand side by side.
fn columns(panels: usize, page: ChartWidth) -> usize {
    let most = page.choose(3, 2);
    // Four panels make two even rows.
    if panels == 4 { 2 } else { panels.min(most) }
}

fn x_scale(panel: &CloudPanel, steps: usize) -> Scale {
    if !panel.names.is_empty() {
        return Scale::named(&panel.names);
    }
    let lines =
        panel.lines.iter().flat_map(|line| line.points.iter().map(|p| p.0).chain(line.band.iter().map(|b| b.0)));
    let wish = Wish { spacing: panel.x.spacing, air: 0.02, steps };
    Scale::over(panel.dots.iter().map(|dot| dot.0).chain(lines), wish)
}

/// One scale for all panels. Zero belongs to it unless it would take much of the room.
fn y_scale(chart: &CloudChart, page: ChartWidth) -> Scale {
    let values = || {
        chart.panels.iter().flat_map(|panel| {
            let lines = panel.lines.iter().flat_map(|line| {
                line.points.iter().map(|p| p.1).chain(line.band.iter().flat_map(|&(_, low, high)| [low, high]))
            });
            panel.dots.iter().map(|dot| dot.1).chain(lines)
        })
    };
    let shown = values().filter(|y| y.is_finite());
    let (low, high) = shown.fold((f64::INFINITY, 0.0_f64), |(l, h), y| (l.min(y), h.max(y)));
    let zero = (low > 0.0 && low < NEAR_ZERO * high).then_some(0.0);
    let steps = if chart.panels.len() == 1 { 6 } else { page.choose(4, 3) };
    Scale::over(values().chain(zero), Wish { spacing: chart.y.spacing, air: 0.04, steps })
}

impl Sheet<'_> {
    fn cloud(&self, canvas: &mut Canvas, (chart, panel): (&CloudChart, &CloudPanel)) {
        let dots: Vec<(f64, f64)> = panel.dots.iter().filter_map(|&(x, y)| self.at(x, y)).collect();
        if !dots.is_empty() {
            canvas.dots(&dots, chart.role);
        }
        for line in &panel.lines {
            self.band(canvas, line);
        }
        for line in &panel.lines {
            self.series(canvas, line);
        }
        if dots.is_empty() && !panel.lines.iter().any(|line| self.shows(line)) {
            self.plot.note(canvas, "no value");
        }
    }
}
