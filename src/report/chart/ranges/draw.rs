//! Draws level bars.

use super::super::figure::Figure;
use super::super::plot::Plot;
use super::super::scale::{Scale, Spacing, Wish};
use super::super::style::{ChartWidth, INK, MARGIN, MUTED, TICK, VALUE, drawable};
use super::super::svg::{Anchor, Canvas, Px, Text};
use super::super::text::shorten;
use super::{RangeBars, RangeRow};

/// Height of a row, px.
const ROW: f64 = 24.0;
/// Height of the line of text above a row on a phone, px.
const HEADING: f64 = 15.0;
/// Part of a row that its bars fill.
const FILL: f64 = 0.66;
/// Longest name, px; longer ones are shortened.
const LONGEST_NAME: f64 = 170.0;
/// Longest note, px.
const LONGEST_NOTE: f64 = 150.0;
/// Gap between plot and text, px.
const GAP: f64 = 6.0;

/// Draws the plot into the figure's free room; gives the lower edge. On a page names stand left of the bars and notes
/// right of them, on a phone both above them.
pub(super) fn plot(figure: &mut Figure, chart: &RangeBars, page: ChartWidth) -> f64 {
    let widest = |text: fn(&RangeRow) -> String, face: super::super::font::Face| {
        chart.rows.iter().map(|row| face.width(&text(row))).fold(0.0, f64::max)
    };
    let x = scale(chart, page);
    let (left, right) = match page {
        ChartWidth::Wide => (MARGIN + widest(name, TICK) + GAP, MARGIN + (widest(note, VALUE) + GAP).max(16.0)),
        ChartWidth::Narrow => {
            // Half of the outer tick labels may reach beyond the plot.
            let overhang = x.ticks.iter().map(|tick| TICK.width(&tick.label) / 2.0).fold(0.0, f64::max);
            (MARGIN.max(overhang + 2.0), MARGIN.max(overhang + 2.0))
        }
    };
    let width = page.px() - left - right;
    let x = if page == ChartWidth::Narrow { x.with_room(width) } else { x };
    let head = if chart.reference.is_some() { 20.0 } else { 8.0 };
    let pitch = page.choose(ROW, ROW + HEADING);
    let height = pitch * chart.rows.len() as f64;
    let plot = Plot { left, top: figure.top + head, width, height };
    let canvas = &mut figure.canvas;
    canvas.open("g", &[("class", &"panel")]);
    plot.x_grid(canvas, &x);
    let base = chart.reference.as_ref().map_or(0.0, |reference| reference.value);
    let sheet = |number: usize| Sheet { plot, x: &x, bottom: plot.top + (number + 1) as f64 * pitch, page };
    for (number, row) in chart.rows.iter().enumerate() {
        sheet(number).row(canvas, row);
    }
    reference(canvas, (chart, &plot), plot.x(&x, base));
    if page == ChartWidth::Narrow {
        // Over the reference's line, which may run through the names.
        for (number, row) in chart.rows.iter().enumerate() {
            sheet(number).heading(canvas, row);
        }
    }
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
fn scale(chart: &RangeBars, page: ChartWidth) -> Scale {
    let ends = |row: &RangeRow| {
        let bars: Vec<f64> = row.bars().flat_map(|(_, range)| [range.from, range.to]).collect();
        bars.into_iter().chain(row.interval().into_iter().flat_map(|(low, high)| [low, high])).collect::<Vec<_>>()
    };
    let base = chart.reference.as_ref().map_or(0.0, |reference| reference.value);
    let wish = Wish { spacing: Spacing::Linear, air: 0.03, steps: page.choose(6, 4) };
    Scale::over(chart.rows.iter().flat_map(ends).chain(drawable(base)), wish)
}

fn reference(canvas: &mut Canvas, (chart, plot): (&RangeBars, &Plot), place: Option<f64>) {
    let Some(x) = place else { return };
    canvas.open("g", &[("class", &"reference"), ("stroke", &INK), ("stroke-width", &"1")]);
    canvas.line((x, plot.top - 4.0), (x, plot.bottom()));
    canvas.close("g");
    if let Some(reference) = &chart.reference {
        let label = shorten(&reference.label, plot.width, TICK);
        let half = TICK.width(&label) / 2.0;
        // Kept above the plot, even for a line near its edge.
        let middle = x.min(plot.right() - half).max(plot.left + half);
        canvas.text(&Text::new(&label, (middle, plot.top - 8.0), TICK).anchor(Anchor::Middle));
    }
}

struct Sheet<'a> {
    plot: Plot,
    x: &'a Scale,
    bottom: f64,
    page: ChartWidth,
}

impl Sheet<'_> {
    fn row(&self, canvas: &mut Canvas, row: &RangeRow) {
        let middle = self.bottom - ROW / 2.0;
        let baseline = middle + TICK.cap_height() / 2.0;
        if self.page == ChartWidth::Wide {
            self.words(canvas, row, baseline);
        }
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

    /// Name and note left and right of the bars.
    fn words(&self, canvas: &mut Canvas, row: &RangeRow, baseline: f64) {
        let (name, note) = (name(row), note(row));
        let at = (self.plot.left - GAP, baseline);
        canvas.text(&Text::new(&name, at, TICK).anchor(Anchor::End).whole(&row.name));
        canvas.text(&Text::new(&note, (self.plot.right() + GAP, baseline), VALUE).whole(&row.note));
    }

    /// Name and note above the bars, each as long as the other leaves room.
    fn heading(&self, canvas: &mut Canvas, row: &RangeRow) {
        let room = self.page.px() - 2.0 * MARGIN - 2.0 * GAP;
        let name = shorten(&row.name, room - VALUE.width(&row.note).min(room / 2.0), TICK);
        let note = shorten(&row.note, room - TICK.width(&name), VALUE);
        let baseline = self.bottom - ROW;
        canvas.text(&Text::new(&name, (MARGIN, baseline), TICK).halo().whole(&row.name));
        let at = (self.page.px() - MARGIN, baseline);
        canvas.text(&Text::new(&note, at, VALUE).anchor(Anchor::End).halo().whole(&row.note));
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
