//! The small symbols of data, equal in a plot and in its legend.

use super::palette::{Colour, DOTS_OPACITY};
use super::series::Stroke;
use super::style::{INK, PAPER};
use super::svg::{Canvas, Px};

/// Half the diagonal of a diamond, px.
pub(super) const HALF_DIAMOND: f64 = 4.2;

/// Returns the stripes of a bar of a dashed or dotted series as path data, for print in grey; `None` for a full bar.
pub(super) fn stripes((left, right): (f64, f64), (top, bottom): (f64, f64), stroke: Stroke) -> Option<String> {
    const STEP: f64 = 4.5;
    let area = |(left, right): (f64, f64), (top, bottom): (f64, f64)| {
        format!("M{} {}H{}V{}H{}z", Px(left), Px(top), Px(right), Px(bottom), Px(left))
    };
    let third = (bottom - top) / 3.0;
    let level = [(top, bottom - 2.0 * third), (top + 2.0 * third, bottom)];
    let upright = (0..).map(|stripe| right - STEP * f64::from(stripe)).take_while(|x| *x > left);
    match stroke {
        Stroke::Dashed => Some(upright.map(|x| area(((x - 0.6 * STEP).max(left), x), (top, bottom))).collect()),
        Stroke::Dotted => Some(level.map(|y| area((left, right), y)).concat()),
        _ => None,
    }
}

impl Canvas {
    /// Draws a hollow diamond: a published value.
    pub fn diamond(&mut self, (x, y): (f64, f64)) {
        let (left, right, top, bottom) =
            (Px(x - HALF_DIAMOND), Px(x + HALF_DIAMOND), Px(y - HALF_DIAMOND), Px(y + HALF_DIAMOND));
        let d = format!("M{left} {y}L{x} {top}L{right} {y}L{x} {bottom}Z", x = Px(x), y = Px(y));
        self.leaf("path", &[("d", &d), ("fill", &PAPER), ("stroke", &INK), ("stroke-width", &"1.2")]);
    }

    /// Draws an interval along a horizontal axis, with caps `cap` px high.
    pub fn whisker(&mut self, (from, to): (f64, f64), y: f64, cap: f64) {
        let (top, bottom) = (Px(y - cap / 2.0), Px(y + cap / 2.0));
        let (from, to, y) = (Px(from), Px(to), Px(y));
        let d = format!("M{from} {top}V{bottom}M{from} {y}H{to}M{to} {top}V{bottom}");
        self.leaf("path", &[("d", &d), ("fill", &"none"), ("stroke", &INK), ("stroke-width", &"1.2")]);
    }

    /// Draws the white rim that separates an interval from the bar below it.
    pub fn rim(&mut self, (from, to): (f64, f64), y: f64) {
        let d = format!("M{} {}H{}", Px(from - 0.6), Px(y), Px(to + 0.6));
        self.leaf("path", &[("d", &d), ("fill", &"none"), ("stroke", &PAPER), ("stroke-width", &"3.2")]);
    }

    /// Draws a cloud of small dots as one path of zero-length lines with round ends. Coordinates have one decimal.
    pub fn dots(&mut self, dots: &[(f64, f64)], colour: Colour) {
        let mut d = String::with_capacity(14 * dots.len());
        for (x, y) in dots {
            let tenth = |v: &f64| Px((10.0 * v).round() / 10.0);
            d.push_str(&format!("M{} {}h0", tenth(x), tenth(y)));
        }
        self.leaf(
            "path",
            &[
                ("class", &"dots"),
                ("d", &d),
                ("fill", &"none"),
                ("stroke", &colour.hex()),
                ("stroke-width", &"2.4"),
                ("stroke-linecap", &"round"),
                ("stroke-opacity", &DOTS_OPACITY),
            ],
        );
    }

    /// Draws a filled point with the colour and, for print in grey, the symbol of its series.
    pub fn point(&mut self, (x, y): (f64, f64), colour: Colour) {
        let d = format!("M{} {}{}", Px(x), Px(y), colour.symbol());
        self.leaf("path", &[("class", &"point"), ("d", &d), ("fill", &colour.hex())]);
    }
}
