//! A writer of SVG elements: escapes text and writes coordinates with two decimals, always the same bytes; and the small
//! symbols of data, equal in a plot and in its legend.

use std::fmt::{Display, Formatter, Result, Write};

use apportion_base::text::symbol;

use super::model::Stroke;
use super::style::{Colour, DOTS_OPACITY, INK, PAPER};
use super::text::{Face, Weight};
use crate::format::split_word;

/// Size of a subscript, and its offset downwards, relative to the size of the text.
const SUBSCRIPT: f64 = 0.75;
const LOWERED: f64 = 0.22;

/// A coordinate in px, written with at most two decimals.
pub(super) struct Px(pub f64);

impl Display for Px {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let text = format!("{:.2}", self.0);
        let text = text.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if text == "-0" { "0" } else { text })
    }
}

/// Attributes of an element, in the order they are written.
pub(super) type Attributes<'a> = &'a [(&'a str, &'a dyn Display)];

/// Alignment of a line of text to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One line of text.
pub(super) struct Text<'a> {
    content: &'a str,
    at: (f64, f64),
    face: Face,
    anchor: Anchor,
    fill: &'static str,
    turn: f64,
    halo: bool,
    tooltip: Option<&'a str>,
}

impl<'a> Text<'a> {
    /// Creates dark text that starts at `at`, a point of its baseline.
    pub fn new(content: &'a str, at: (f64, f64), face: Face) -> Self {
        Self { content, at, face, anchor: Anchor::Start, fill: INK, turn: 0.0, halo: false, tooltip: None }
    }

    pub fn anchor(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    pub fn fill(self, fill: &'static str) -> Self {
        Self { fill, ..self }
    }

    /// Turns the text about its point, degrees clockwise.
    pub fn turn(self, turn: f64) -> Self {
        Self { turn, ..self }
    }

    /// Adds a white rim, for text above lines.
    pub fn halo(self) -> Self {
        Self { halo: true, ..self }
    }

    /// Sets the unshortened text as the tooltip.
    pub fn tooltip(self, tooltip: &'a str) -> Self {
        Self { tooltip: (tooltip != self.content).then_some(tooltip), ..self }
    }
}

/// A buffer of SVG.
#[derive(Debug, Default)]
pub(super) struct Canvas {
    /// The elements written so far.
    pub out: String,
}

impl Canvas {
    /// Opens an element; `close` ends it.
    pub fn open(&mut self, name: &str, attributes: Attributes) {
        self.start(name, attributes);
        self.out.push_str(">\n");
    }

    pub fn close(&mut self, name: &str) {
        self.push(format_args!("</{name}>\n"));
    }

    /// Writes an element without content.
    pub fn leaf(&mut self, name: &str, attributes: Attributes) {
        self.start(name, attributes);
        self.out.push_str("/>\n");
    }

    /// Writes an element with text as content.
    pub fn content(&mut self, name: &str, attributes: Attributes, text: &str) {
        self.start(name, attributes);
        self.push(format_args!(">{}</{name}>\n", escaped(text)));
    }

    /// Writes an element with the tooltip `tip`.
    pub fn tipped(&mut self, name: &str, attributes: Attributes, tip: &str) {
        self.start(name, attributes);
        self.push(format_args!("><title>{}</title></{name}>\n", escaped(tip)));
    }

    pub fn line(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.leaf("line", &[("x1", &Px(from.0)), ("y1", &Px(from.1)), ("x2", &Px(to.0)), ("y2", &Px(to.1))]);
    }

    pub fn text(&mut self, text: &Text) {
        let (x, y) = (Px(text.at.0), Px(text.at.1));
        let size = Px(text.face.size);
        let turn = format!("rotate({} {x} {y})", Px(text.turn));
        let mut attributes: Vec<(&str, &dyn Display)> = vec![("x", &x), ("y", &y), ("font-size", &size)];
        if text.face.weight == Weight::Bold {
            attributes.push(("font-weight", &"bold"));
        }
        match text.anchor {
            Anchor::Start => {}
            Anchor::Middle => attributes.push(("text-anchor", &"middle")),
            Anchor::End => attributes.push(("text-anchor", &"end")),
        }
        if text.fill != INK {
            attributes.push(("fill", &text.fill));
        }
        if text.turn != 0.0 {
            attributes.push(("transform", &turn));
        }
        if text.halo {
            let rim: Attributes = &[("paint-order", &"stroke"), ("stroke", &PAPER), ("stroke-width", &"2.4")];
            attributes.extend_from_slice(rim);
            attributes.push(("stroke-linejoin", &"round"));
        }
        self.start("text", &attributes);
        self.out.push('>');
        self.words(text);
        if let Some(tooltip) = text.tooltip {
            self.push(format_args!("<title>{}</title>", escaped(tooltip)));
        }
        self.out.push_str("</text>\n");
    }

    /// Writes the content of a text; symbols such as `F_cr` have a lowered subscript.
    fn words(&mut self, text: &Text) {
        let (size, drop) = (SUBSCRIPT * text.face.size, LOWERED * text.face.size);
        let (mut rest, mut is_lowered) = (text.content, false);
        while !rest.is_empty() {
            let (word, after) = split_word(rest);
            let (letter, below) = symbol(word).unwrap_or((word, ""));
            if is_lowered {
                self.push(format_args!("<tspan dy=\"-{}\">{}</tspan>", Px(drop), escaped(letter)));
            } else {
                self.push(format_args!("{}", escaped(letter)));
            }
            is_lowered = !below.is_empty();
            if is_lowered {
                let (drop, size) = (Px(drop), Px(size));
                self.push(format_args!("<tspan dy=\"{drop}\" font-size=\"{size}\">{}</tspan>", escaped(below)));
            }
            rest = after;
        }
    }

    fn start(&mut self, name: &str, attributes: Attributes) {
        self.push(format_args!("<{name}"));
        for (key, value) in attributes {
            let value = value.to_string();
            self.push(format_args!(" {key}=\"{}\"", escaped(&value)));
        }
    }

    fn push(&mut self, text: std::fmt::Arguments) {
        // Writing to a string fails only if a Display does, and those here do not.
        let _ = self.out.write_fmt(text);
    }
}

/// Formats text as XML content or attribute value; characters that XML forbids become U+FFFD.
fn escaped(text: &str) -> String {
    let allowed = text.chars().map(|c| match c {
        '\t' | '\n' => c,
        '\0'..'\u{20}' | '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER,
        _ => c,
    });
    let text = allowed.collect::<String>().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&apos;")
}

/// Half the diagonal of a diamond, px.
pub(super) const HALF_DIAMOND: f64 = 4.2;

/// Formats a rectangle as path data.
fn rectangle((left, right): (f64, f64), (top, bottom): (f64, f64)) -> String {
    format!("M{} {}H{}V{}H{}z", Px(left), Px(top), Px(right), Px(bottom), Px(left))
}

/// Returns the stripes of a bar of a dashed or dotted series as path data, for print in grey; `None` for a full bar.
pub(super) fn stripes((left, right): (f64, f64), (top, bottom): (f64, f64), stroke: Stroke) -> Option<String> {
    const STEP: f64 = 4.5;
    let third = (bottom - top) / 3.0;
    let level = [(top, bottom - 2.0 * third), (top + 2.0 * third, bottom)];
    let upright = (0..).map(|stripe| right - STEP * f64::from(stripe)).take_while(|x| *x > left);
    match stroke {
        Stroke::Dashed => Some(upright.map(|x| rectangle(((x - 0.6 * STEP).max(left), x), (top, bottom))).collect()),
        Stroke::Dotted => Some(level.map(|y| rectangle((left, right), y)).concat()),
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
            let [x, y] = [x, y].map(|length| Px((10.0 * length).round() / 10.0));
            d.push_str(&format!("M{x} {y}h0"));
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
