//! The frame of every figure: title and legend above, caption below, text for screen readers.

use super::font::FAMILIES;
use super::marks::DIAMOND;
use super::style::{BODY, INK, MARGIN, MUTED, PAPER, Role, TITLE};
use super::svg::{Canvas, Px, Text};
use super::text::{shorten, wrap};

/// Gap between a key and its name, px.
const KEY_GAP: f64 = 6.0;
/// Gap between legend entries, px.
const ENTRY_GAP: f64 = 18.0;
/// Distance of legend rows, px.
const ROW: f64 = 17.0;

/// The mark that stands before a name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Key {
    Swatch(Role),
    Line { role: Role, dash: &'static str, line: bool, points: bool },
    Diamond,
    Whisker,
    Cross,
}

impl Key {
    fn width(self) -> f64 {
        match self {
            Key::Swatch(_) => 12.0,
            Key::Line { line: true, .. } => 24.0,
            Key::Whisker => 8.0,
            Key::Line { .. } | Key::Diamond | Key::Cross => 9.0,
        }
    }
}

/// One entry of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub name: String,
    pub key: Key,
}

/// What a figure says about itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Words<'a> {
    pub title: &'a str,
    pub caption: &'a str,
}

/// A figure whose head is drawn; `finish` adds the foot.
pub(super) struct Figure<'a> {
    pub canvas: Canvas,
    /// The upper edge of the room still free, px.
    pub top: f64,
    width: f64,
    words: Words<'a>,
}

impl<'a> Figure<'a> {
    /// Draws title and legend of a figure `width` px wide.
    pub fn begin(width: f64, words: Words<'a>, legend: &[Entry]) -> Self {
        let mut figure = Self { canvas: Canvas::default(), top: MARGIN, width, words };
        figure.canvas.open("g", &[("class", &"title")]);
        for line in wrap(words.title, width - 2.0 * MARGIN, TITLE) {
            figure.top += TITLE.leading();
            let baseline = figure.top - 0.3 * TITLE.size;
            figure.canvas.text(&Text::new(&line, (MARGIN, baseline), TITLE));
        }
        figure.canvas.close("g");
        if !legend.is_empty() {
            figure.legend(legend);
        }
        figure
    }

    /// The caption under `bottom`, then the whole as an SVG document. `description` is read out by screen
    /// readers after the caption.
    pub fn finish(mut self, bottom: f64, description: &str) -> String {
        let mut y = bottom;
        let caption = wrap(self.words.caption, self.width - 2.0 * MARGIN, BODY);
        self.canvas.open("g", &[("class", &"caption")]);
        for (row, line) in caption.iter().enumerate() {
            y += if row == 0 { 8.0 + BODY.size } else { BODY.leading() };
            self.canvas.text(&Text::new(line, (MARGIN, y), BODY).fill(MUTED));
        }
        self.canvas.close("g");
        let (width, height) = (self.width.ceil(), (y + MARGIN).ceil());
        let view = format!("0 0 {width} {height}");
        let mut page = Canvas::default();
        page.open(
            "svg",
            &[
                ("xmlns", &"http://www.w3.org/2000/svg"),
                ("width", &width),
                ("height", &height),
                ("viewBox", &view),
                ("role", &"img"),
                ("font-family", &FAMILIES),
                ("fill", &INK),
            ],
        );
        page.content("title", &[], self.words.title);
        page.content("desc", &[], &format!("{} {description}", self.words.caption));
        page.leaf("rect", &[("width", &width), ("height", &height), ("fill", &PAPER)]);
        page.append(self.canvas);
        page.close("svg");
        page.into_string()
    }

    fn legend(&mut self, entries: &[Entry]) {
        let right = self.width - MARGIN;
        self.canvas.open("g", &[("class", &"legend")]);
        let (mut x, mut y) = (MARGIN, self.top + 5.0 + ROW / 2.0);
        for entry in entries {
            let key = entry.key.width() + KEY_GAP;
            let name = shorten(&entry.name, right - MARGIN - key, BODY);
            let length = key + BODY.width(&name);
            if x > MARGIN && x + length > right {
                (x, y) = (MARGIN, y + ROW);
            }
            self.key(entry.key, (x, y));
            let at = (x + key, y + BODY.cap_height() / 2.0);
            self.canvas.text(&Text::new(&name, at, BODY).whole(&entry.name));
            x += length + ENTRY_GAP;
        }
        self.canvas.close("g");
        self.top = y + ROW / 2.0;
    }

    /// Draws a key whose left end is at `x`, its middle at height `y`.
    fn key(&mut self, key: Key, (x, y): (f64, f64)) {
        let right = x + key.width();
        let middle = ((x + right) / 2.0, y);
        let canvas = &mut self.canvas;
        match key {
            Key::Swatch(role) => {
                let (left, top, fill) = (Px(x), Px(y - 5.0), role.colour());
                canvas.leaf("rect", &[("x", &left), ("y", &top), ("width", &"12"), ("height", &"10"), ("fill", &fill)]);
            }
            Key::Line { role, dash, line, points } => {
                if line {
                    let stroke = role.colour();
                    canvas.open("g", &[("stroke", &stroke), ("stroke-width", &"1.8"), ("stroke-dasharray", &dash)]);
                    canvas.line((x, y), (right, y));
                    canvas.close("g");
                }
                if points {
                    canvas.point(middle, role);
                }
            }
            Key::Diamond => canvas.diamond(middle, DIAMOND),
            Key::Whisker => canvas.whisker(middle.0, (y - 5.0, y + 5.0), 7.0),
            Key::Cross => canvas.cross(middle),
        }
    }
}
