//! A plotting rectangle: grid, tick labels and axis titles around it.

use super::scale::{Scale, Tick};
use super::style::{BODY, ChartWidth, FINE_GRID, GRID, INK, MARGIN, MUTED, PANEL_TITLE, TICK};
use super::svg::{Anchor, Canvas, Text};
use super::text::{shorten, wrap, wrap_within};

/// Room between an axis and its tick labels, px.
pub(super) const TICK_GAP: f64 = 6.0;
/// Maximum number of lines of a turned axis title.
const TITLE_LINES: usize = 3;

/// A rectangle with a scale on each side, in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plot {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Plot {
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Returns the horizontal position of a value.
    pub fn x(&self, scale: &Scale, value: f64) -> Option<f64> {
        scale.place(value).map(|place| self.left + place * self.width)
    }

    /// Returns the vertical position of a value.
    pub fn y(&self, scale: &Scale, value: f64) -> Option<f64> {
        scale.place(value).map(|place| self.bottom() - place * self.height)
    }

    /// Draws the panel's title over the upper left corner, `rise` px above the rectangle; on a phone from edge to edge.
    pub fn title(&self, canvas: &mut Canvas, title: &str, rise: f64, width: ChartWidth) {
        let (left, room) = width.choose((self.left, self.width), (MARGIN, width.px() - 2.0 * MARGIN));
        let line = shorten(title, room, PANEL_TITLE);
        canvas.text(&Text::new(&line, (left, self.top - rise), PANEL_TITLE).tooltip(title));
    }

    /// Draws horizontal grid lines, and the labels of the vertical axis where no neighbour has them.
    pub fn y_axis(&self, canvas: &mut Canvas, scale: &Scale, is_labelled: bool) {
        let class = if is_labelled { "y-axis" } else { "y-grid" };
        canvas.open("g", &[("class", &class), ("stroke-width", &"1")]);
        grid(canvas, scale, |canvas, value| {
            if let Some(y) = self.y(scale, value) {
                canvas.line((self.left, y), (self.right(), y));
            }
        });
        for Tick { value, label } in scale.ticks.iter().filter(|_| is_labelled) {
            if let Some(y) = self.y(scale, *value) {
                let at = (self.left - TICK_GAP, y + TICK.cap_height() / 2.0);
                canvas.text(&Text::new(label, at, TICK).anchor(Anchor::End));
            }
        }
        canvas.close("g");
    }

    /// Draws the vertical grid lines of the horizontal axis.
    pub fn x_grid(&self, canvas: &mut Canvas, scale: &Scale) {
        canvas.open("g", &[("class", &"x-grid"), ("stroke-width", &"1")]);
        grid(canvas, scale, |canvas, value| {
            if let Some(x) = self.x(scale, value) {
                canvas.line((x, self.top), (x, self.bottom()));
            }
        });
        canvas.close("g");
    }

    /// Draws the labels of the horizontal axis and its title below; returns the lower edge.
    pub fn x_labels(&self, canvas: &mut Canvas, scale: &Scale, title: &str) -> f64 {
        canvas.open("g", &[("class", &"x-axis")]);
        let baseline = self.bottom() + TICK_GAP + TICK.cap_height() + 1.0;
        for Tick { value, label } in &scale.ticks {
            if let Some(x) = self.x(scale, *value) {
                canvas.text(&Text::new(label, (x, baseline), TICK).anchor(Anchor::Middle));
            }
        }
        let mut bottom = baseline + 3.0;
        for line in wrap(title, self.width, BODY) {
            bottom += BODY.leading();
            let at = (self.left + self.width / 2.0, bottom);
            canvas.text(&Text::new(&line, at, BODY).anchor(Anchor::Middle));
        }
        canvas.close("g");
        bottom + 4.0
    }

    /// Draws the turned title of the vertical axis, its last baseline at `x`.
    pub fn y_title(&self, canvas: &mut Canvas, title: &str, x: f64) {
        let lines = wrap_within(title, self.height, TITLE_LINES, BODY);
        let middle = self.top + self.height / 2.0;
        for (back, line) in lines.iter().rev().enumerate() {
            let at = (x - back as f64 * BODY.leading(), middle);
            canvas.text(&Text::new(line, at, BODY).anchor(Anchor::Middle).turn(-90.0));
        }
    }

    /// Draws a note in the middle, for an empty plot.
    pub fn note(&self, canvas: &mut Canvas, note: &str) {
        let at = (self.left + self.width / 2.0, self.top + self.height / 2.0);
        canvas.text(&Text::new(note, at, BODY).anchor(Anchor::Middle).fill(MUTED));
    }

    /// Draws the two axis lines, left and below.
    pub fn axis_lines(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"axis-lines"), ("stroke", &INK), ("stroke-width", &"1")]);
        canvas.line((self.left, self.top), (self.left, self.bottom()));
        canvas.line((self.left, self.bottom()), (self.right(), self.bottom()));
        canvas.close("g");
    }
}

/// Returns the width of tick labels and the gap to their axis, px.
pub(super) fn tick_room(scale: &Scale) -> f64 {
    let widest = scale.ticks.iter().map(|tick| TICK.width(&tick.label)).fold(0.0, f64::max);
    widest + TICK_GAP
}

/// Returns the width of a turned axis title next to a plot of this height, px.
pub(super) fn title_room(title: &str, height: f64) -> f64 {
    let lines = wrap_within(title, height, TITLE_LINES, BODY).len() as f64;
    if lines == 0.0 { 0.0 } else { lines * BODY.leading() + 4.0 }
}

/// Draws fine lines first, then those of the ticks.
fn grid(canvas: &mut Canvas, scale: &Scale, line: impl Fn(&mut Canvas, f64)) {
    let ticks: Vec<f64> = scale.ticks.iter().map(|tick| tick.value).collect();
    for (values, colour) in [(&scale.minor, FINE_GRID), (&ticks, GRID)] {
        if !values.is_empty() {
            canvas.open("g", &[("stroke", &colour)]);
            values.iter().for_each(|&value| line(canvas, value));
            canvas.close("g");
        }
    }
}
