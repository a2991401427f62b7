//! Draws level bars.

use super::super::figure::Figure;
use super::super::plot::Plot;
use super::super::scale::{Scale, Spacing, Wish};
use super::super::style::{INK, MARGIN, MUTED, TICK, VALUE, WIDTH, drawable};
use super::super::svg::{Anchor, Canvas, Px, Text};
use super::super::text::shorten;
use super::{RangeBars, RangeRow};

/// Height of a row, px.
const ROW: f64 = 24.0;
/// Part of a row that its bars fill.
const FILL: f64 = 0.66;
/// Longest name, px; longer ones are shortened.
const LONGEST_NAME: f64 = 170.0;
/// Longest note, px.
const LONGEST_NOTE: f64 = 150.0;
/// Gap between plot and text, px.
const GAP: f64 = 6.0;

/// Draws the plot into the figure's free room; gives the lower edge.
pub(super) fn plot(figure: &mut Figure, chart: &RangeBars) -> f64 {
    let widest = |text: fn(&RangeRow) -> String, face: super::super::font::Face| {
        chart.rows.iter().map(|row| face.width(&text(row))).fold(0.0, f64::max)
    };
    let left = MARGIN + widest(name, TICK) + GAP;
    let right = WIDTH - MARGIN - (widest(note, VALUE) + GAP).max(16.0);
    let head = if chart.reference.is_some() { 20.0 } else { 8.0 };
    let height = ROW * chart.rows.len() as f64;
    let plot = Plot { left, top: figure.top + head, width: right - left, height };
    let x = scale(chart);
    let canvas = &mut figure.canvas;
    canvas.open("g", &[("class", &"panel")]);
    plot.x_grid(canvas, &x);
    let base = chart.reference.as_ref().map_or(0.0, |reference| reference.value);
    for (number, row) in chart.rows.iter().enumerate() {
        let sheet = Sheet { plot, x: &x, top: plot.top + number as f64 * ROW };
        sheet.row(canvas, row);
    }
    reference(canvas, (chart, &plot), plot.x(&x, base));
    canvas.close("g");
    plot.x_labels(canvas, &x, &chart.x.title(x.exponent))
}

fn name(row: &RangeRow) -> String {
    shorten(&row.name, LONGEST_NAME, TICK)
}

fn note(row: &RangeRow) -> String {
    shorten(&row.note, LONGEST_NOTE, VALUE)
}

/// Every bar and interval, and the value they are about.
fn scale(chart: &RangeBars) -> Scale {
    let ends = |row: &RangeRow| {
        let bars: Vec<f64> = row.bars().flat_map(|(_, range)| [range.from, range.to]).collect();
        bars.into_iter().chain(row.interval().into_iter().flat_map(|(low, high)| [low, high])).collect::<Vec<_>>()
    };
    let base = chart.reference.as_ref().map_or(0.0, |reference| reference.value);
    let wish = Wish { spacing: Spacing::Linear, air: 0.03, steps: 6 };
    Scale::over(chart.rows.iter().flat_map(ends).chain(drawable(base)), wish)
}

fn reference(canvas: &mut Canvas, (chart, plot): (&RangeBars, &Plot), place: Option<f64>) {
    let Some(x) = place else { return };
    canvas.open("g", &[("class", &"reference"), ("stroke", &INK), ("stroke-width", &"1")]);
    canvas.line((x, plot.top - 4.0), (x, plot.bottom()));
    canvas.close("g");
    if let Some(reference) = &chart.reference {
        let half = TICK.width(&reference.label) / 2.0;
        // Kept above the plot, even for a line near its edge.
        let middle = x.min(plot.right() - half).max(plot.left + half);
        canvas.text(&Text::new(&reference.label, (middle, plot.top - 8.0), TICK).anchor(Anchor::Middle));
    }
}

struct Sheet<'a> {
    plot: Plot,
    x: &'a Scale,
    top: f64,
}

impl Sheet<'_> {
    fn row(&self, canvas: &mut Canvas, row: &RangeRow) {
        let middle = self.top + ROW / 2.0;
        let baseline = middle + TICK.cap_height() / 2.0;
        canvas
            .text(&Text::new(&name(row), (self.plot.left - GAP, baseline), TICK).anchor(Anchor::End).whole(&row.name));
        canvas.text(&Text::new(&note(row), (self.plot.right() + GAP, baseline), VALUE).whole(&row.note));
        let lane = ROW * FILL / row.bars.len().max(1) as f64;
        canvas.open("g", &[("class", &"bars")]);
        for (number, range) in row.bars() {
            let Some((from, to)) = self.plot.x(self.x, range.from).zip(self.plot.x(self.x, range.to)) else { continue };
            let top = middle - ROW * FILL / 2.0 + number as f64 * lane;
            canvas.tipped(
                "rect",
                &[
                    ("x", &Px(from.min(to))),
                    ("y", &Px(top)),
                    ("width", &Px((to - from).abs())),
                    ("height", &Px(lane)),
                    ("fill", &range.role.colour()),
                ],
                &row.words(),
            );
        }
        canvas.close("g");
        match row.interval().and_then(|(low, high)| self.plot.x(self.x, low).zip(self.plot.x(self.x, high))) {
            Some(ends) => level_whisker(canvas, ends, middle),
            None if row.bars().next().is_none() => {
                let at = (self.plot.left + GAP, baseline);
                canvas.text(&Text::new("no value", at, VALUE).fill(MUTED));
            }
            None => (),
        }
    }
}

/// An interval along the axis, with caps.
fn level_whisker(canvas: &mut Canvas, (from, to): (f64, f64), y: f64) {
    const CAP: f64 = 7.0;
    let (top, bottom) = (Px(y - CAP / 2.0), Px(y + CAP / 2.0));
    let (from, to, y) = (Px(from), Px(to), Px(y));
    let d = format!("M{from} {top}V{bottom}M{from} {y}H{to}M{to} {top}V{bottom}");
    canvas.leaf(
        "path",
        &[("class", &"whisker"), ("d", &d), ("fill", &"none"), ("stroke", &INK), ("stroke-width", &"1.2")],
    );
}
