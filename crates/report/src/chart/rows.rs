//! Draws horizontal bars in rows, with their names and intervals.

use super::draw::Sheet;
use super::layout::{ROW_GAP, TEXT_GAP, row_name};
use super::model::{Bar, Mark, Panel, Series, Shape};
use super::style::{INK, MARGIN, MUTED, PAPER, TICK, VALUE};
use super::svg::{Anchor, Canvas, HALF_DIAMOND, Px, Text, stripes};
use super::text::shorten;

/// Gap between two cells of a map, px.
const TILE_GAP: f64 = 2.0;

/// A bar with its place, px.
struct Lane<'a> {
    series: &'a Series,
    bar: &'a Bar,
    top: f64,
    height: f64,
}

impl Lane<'_> {
    /// Returns the height of interval, published value and label.
    fn middle(&self) -> f64 {
        self.top + 0.5 * self.height
    }
}

impl<'a> Sheet<'a> {
    /// Draws all rows. Names are left of the bars on a page, above them on a phone.
    pub(super) fn rows(&self, canvas: &mut Canvas) {
        let panel = self.cell.panel;
        let rows = 0..panel.y.names.len();
        let lanes: Vec<Lane<'_>> = rows.clone().flat_map(|row| self.lanes(row)).collect();
        self.bars(canvas, &lanes);
        self.tiles(canvas);
        if let Some(x) = self.x(panel.base()).filter(|_| !panel.is_map()) {
            canvas.open("g", &[("class", &"baseline"), ("stroke", &INK), ("stroke-width", &"1")]);
            // On a phone the names of the rows stand above their bars, in gaps of the line.
            let half = self.layout.rows.bars / 2.0 + 1.0;
            let gapped = rows.clone().map(|row| (self.middle(row) - half, self.middle(row) + half)).collect();
            for (from, to) in self.layout.page.choose(vec![(self.plot.top, self.plot.bottom())], gapped) {
                canvas.line((x, from), (x, to));
            }
            canvas.close("g");
        }
        self.published(canvas, &lanes);
        self.intervals(canvas, &lanes);
        self.values(canvas, &lanes);
        canvas.open("g", &[("class", &"rows")]);
        for row in rows {
            self.texts(canvas, row);
        }
        canvas.close("g");
    }

    fn x(&self, value: f64) -> Option<f64> {
        self.plot.x(&self.cell.x, value)
    }

    /// Returns the middle of the bars of a row.
    fn middle(&self, row: usize) -> f64 {
        let rows = self.layout.rows;
        self.plot.top + (row + 1) as f64 * rows.pitch - (rows.bars + ROW_GAP) / 2.0
    }

    fn lanes(&self, row: usize) -> Vec<Lane<'a>> {
        let panel: &'a Panel = self.cell.panel;
        let in_row: Vec<(&'a Mark, &'a Bar)> = panel.bars().filter(|(_, bar)| bar.row == row).collect();
        let height = self.layout.rows.bars / in_row.len().max(1) as f64;
        let top = self.middle(row) - self.layout.rows.bars / 2.0;
        let lanes = in_row.iter().enumerate();
        lanes
            .map(|(number, (mark, bar))| Lane { series: &mark.series, bar, top: top + number as f64 * height, height })
            .collect()
    }

    fn bars(&self, canvas: &mut Canvas, lanes: &[Lane<'_>]) {
        canvas.open("g", &[("class", &"bars")]);
        for lane in lanes {
            let Some(bar) = lane.bar.drawn() else { continue };
            let other = bar.of_other();
            let first = (bar.from, other.map_or(bar.to, |(split, ..)| split), lane.series);
            for (from, to, series) in std::iter::once(first).chain(other) {
                let Some((left, right)) = self.x(from).zip(self.x(to)) else { continue };
                let fill = series.colour.hex();
                let words = self.chart.bar_in_words(self.cell.panel, &lane.series.name, &bar);
                let (left, right) = (left.min(right), left.max(right));
                if let Some(d) = stripes((left, right), (lane.top, lane.top + lane.height), series.stroke) {
                    canvas.tipped("path", &[("d", &d), ("fill", &fill)], &words);
                    continue;
                }
                canvas.tipped(
                    "rect",
                    &[
                        ("x", &Px(left)),
                        ("y", &Px(lane.top)),
                        ("width", &Px(right - left)),
                        ("height", &Px(lane.height)),
                        ("fill", &fill),
                    ],
                    &words,
                );
            }
        }
        canvas.close("g");
    }

    /// Draws the cells of a map, each with its letter.
    fn tiles(&self, canvas: &mut Canvas) {
        let panel = self.cell.panel;
        if !panel.is_map() {
            return;
        }
        canvas.open("g", &[("class", &"tiles")]);
        for (mark, tile) in panel.tiles().filter(|(_, tile)| tile.row < panel.y.names.len()) {
            let middle = self.middle(tile.row);
            let place = tile.column as f64;
            let Some((left, right)) = self.x(place - 0.5).zip(self.x(place + 0.5)) else { continue };
            let Series { name, colour, .. } = &mark.series;
            let column = panel.x.names.get(tile.column).map_or("", String::as_str);
            let tip = format!("{}, {column}: {name}. {}", panel.y.names[tile.row], tile.tip);
            canvas.tipped(
                "rect",
                &[
                    ("x", &Px(left + TILE_GAP / 2.0)),
                    ("y", &Px(middle - self.layout.rows.bars / 2.0)),
                    ("width", &Px((right - left - TILE_GAP).max(1.0))),
                    ("height", &Px(self.layout.rows.bars)),
                    ("fill", &colour.hex()),
                    // The outline separates the lightest shades from the paper.
                    ("stroke", &MUTED),
                    ("stroke-width", &"0.6"),
                ],
                tip.trim_end(),
            );
            let at = ((left + right) / 2.0, middle + VALUE.cap_height() / 2.0);
            let ink = if colour.is_dark() { PAPER } else { INK };
            canvas.text(&Text::new(&tile.letter, at, VALUE).anchor(Anchor::Middle).fill(ink));
        }
        canvas.close("g");
    }

    fn intervals(&self, canvas: &mut Canvas, lanes: &[Lane<'_>]) {
        let mut drawn = Vec::new();
        for lane in lanes {
            if let Some((low, high)) = lane.bar.drawn().and_then(|bar| bar.interval)
                && let Some(ends) = self.x(low).zip(self.x(high))
            {
                drawn.push((ends, lane));
            }
        }
        canvas.open("g", &[("class", &"rims")]);
        for (ends, lane) in &drawn {
            canvas.rim(*ends, lane.middle());
        }
        canvas.close("g");
        canvas.open("g", &[("class", &"whiskers")]);
        for (ends, lane) in drawn {
            canvas.whisker(ends, lane.middle(), (lane.height - 2.0).min(7.0));
        }
        canvas.close("g");
    }

    fn published(&self, canvas: &mut Canvas, lanes: &[Lane<'_>]) {
        canvas.open("g", &[("class", &"published")]);
        for lane in lanes {
            if let Some(x) = lane.bar.diamond().and_then(|value| self.x(value)) {
                canvas.diamond((x, lane.middle()));
            }
        }
        canvas.close("g");
    }

    /// Draws the label after each bar and its marks, or a note that there is no value.
    fn values(&self, canvas: &mut Canvas, lanes: &[Lane<'_>]) {
        canvas.open("g", &[("class", &"values")]);
        for lane in lanes {
            let baseline = lane.middle() + VALUE.cap_height() / 2.0;
            let (end, label, fill) = match lane.bar.drawn() {
                Some(bar) => (bar.right(), lane.bar.label.as_str(), INK),
                None if lane.bar.label.is_empty() => (self.cell.panel.base(), "no value", MUTED),
                None => (self.cell.panel.base(), lane.bar.label.as_str(), MUTED),
            };
            if let Some(x) = self.x(end).filter(|_| !label.is_empty()) {
                // The label is placed after a published value that would overlap it.
                let diamond = lane.bar.diamond().and_then(|value| self.x(value)).map(|at| at + HALF_DIAMOND);
                let covered = x..x + 2.0 * (TEXT_GAP + HALF_DIAMOND) + VALUE.width(label);
                let x = diamond.filter(|right| covered.contains(right)).unwrap_or(x);
                canvas.text(&Text::new(label, (x + TEXT_GAP, baseline), VALUE).fill(fill).halo());
            }
        }
        canvas.close("g");
    }

    /// Draws the name of a row, and a note if it has no value.
    fn texts(&self, canvas: &mut Canvas, row: usize) {
        let panel = self.cell.panel;
        let name = panel.y.names[row].as_str();
        let middle = self.middle(row);
        let baseline = middle + TICK.cap_height() / 2.0;
        let is_empty = !panel.marks.iter().any(|mark| match &mark.shape {
            Shape::Bar(bar) => bar.row == row,
            Shape::Tile(tile) => tile.row == row,
            _ => false,
        });
        if is_empty {
            canvas.text(&Text::new("no value", (self.plot.left + TEXT_GAP, baseline), VALUE).fill(MUTED));
        }
        if self.layout.page.is_narrow() {
            // With a white rim, since a rule may run through it.
            let line = shorten(name, self.layout.page.px() - 2.0 * MARGIN, TICK);
            let baseline = middle - self.layout.rows.bars / 2.0 - 4.0;
            canvas.text(&Text::new(&line, (MARGIN, baseline), TICK).halo().tooltip(name));
        } else if self.is_first_column {
            let at = (self.plot.left - TEXT_GAP, baseline);
            canvas.text(&Text::new(&row_name(name), at, TICK).anchor(Anchor::End).tooltip(name));
        }
    }
}
