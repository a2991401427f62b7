//! The frame of every figure: title and legend above, caption below, text for screen readers.

use std::fmt::Display;

use super::model::{Bar, Chart, Mark, Panel, Shape, Stroke};
use super::style::{BODY, Colour, INK, MARGIN, MUTED, Medium, PAPER, PaperWidth, TITLE};
use super::svg::{Attributes, Canvas, Px, Text, stripes};
use super::text::{FAMILIES, wrap, wrap_within};

/// Gap between a key and its name, px.
const KEY_GAP: f64 = 6.0;
/// Gap between legend entries, px.
const ENTRY_GAP: f64 = 18.0;
/// Distance of legend rows, px.
const ROW: f64 = 17.0;

/// The symbol before a name in the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Key {
    Swatch(Colour, Stroke),
    Line(Colour, Stroke),
    Diamond,
    Whisker,
}

impl Key {
    fn width(self) -> f64 {
        match self {
            Key::Swatch(..) => 12.0,
            Key::Line(_, stroke) if stroke.has_line() => 24.0,
            Key::Whisker => 16.0,
            Key::Line(..) | Key::Diamond => 9.0,
        }
    }
}

/// One entry of the legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub name: String,
    pub key: Key,
}

/// A figure with its head drawn; `finish` adds the foot.
pub(super) struct Figure<'a> {
    pub canvas: Canvas,
    /// The upper edge of the free room, px.
    pub top: f64,
    width: f64,
    medium: Medium<'a>,
    chart: &'a Chart,
}

impl<'a> Figure<'a> {
    pub fn begin(medium: Medium<'a>, chart: &'a Chart) -> Self {
        let top = if medium.has_words() { MARGIN } else { 0.0 };
        let mut figure = Self { canvas: Canvas::default(), top, width: medium.width.px(), medium, chart };
        if medium.has_words() {
            figure.title();
        }
        let legend = chart.legend();
        if !legend.is_empty() {
            figure.legend(&legend);
        }
        figure
    }

    fn title(&mut self) {
        self.canvas.open("g", &[("class", &"title")]);
        for line in wrap(&self.chart.title, self.width - 2.0 * MARGIN, TITLE) {
            self.top += TITLE.leading();
            let baseline = self.top - 0.3 * TITLE.size;
            self.canvas.text(&Text::new(&line, (MARGIN, baseline), TITLE));
        }
        self.canvas.close("g");
    }

    /// Draws the caption under `bottom` and returns the SVG document. Screen readers read the axes after the caption.
    pub fn finish(mut self, bottom: f64) -> String {
        let bottom = if self.medium.has_words() { self.caption(bottom) + MARGIN } else { bottom };
        let (width, height) = (self.width, bottom.ceil());
        let view = format!("0 0 {width} {height}");
        let mut page = Canvas::default();
        let paper = self.medium.width.paper().map(PaperWidth::millimetres);
        let sizes = [width, height].map(|length| match paper {
            Some(millimetres) => format!("{}mm", Px(length * millimetres / width)),
            None => length.to_string(),
        });
        // Not every browser links a picture to its title and description by itself.
        let ids = self.medium.id.map(|id| ["title", "desc"].map(|element| format!("{id}-{element}")));
        let [title_id, description_id] =
            [0, 1].map(|element| ids.iter().map(|ids| ("id", &ids[element] as &dyn Display)).collect::<Vec<_>>());
        let mut attributes: Vec<(&str, &dyn Display)> = Vec::new();
        if let Some([title, description]) = &ids {
            attributes.extend_from_slice(&[("aria-labelledby", title), ("aria-describedby", description)]);
        }
        attributes.push(("xmlns", &"http://www.w3.org/2000/svg"));
        if ids.is_none() {
            attributes.extend_from_slice(&[("width", &sizes[0]), ("height", &sizes[1])]);
        }
        attributes.extend_from_slice(&[("viewBox", &view), ("role", &"img")]);
        if ids.is_some() {
            attributes.push(("aria-label", &self.chart.title));
        }
        attributes.extend_from_slice(&[("font-family", &FAMILIES), ("fill", &INK)]);
        page.open("svg", &attributes);
        page.content("title", &title_id, &self.chart.title);
        page.content("desc", &description_id, &format!("{} {}", self.chart.caption, self.chart.axes()));
        page.leaf("rect", &[("width", &width), ("height", &height), ("fill", &PAPER)]);
        page.out.push_str(&self.canvas.out);
        page.close("svg");
        page.out
    }

    /// Draws the caption and returns its last baseline.
    fn caption(&mut self, bottom: f64) -> f64 {
        let mut y = bottom;
        let caption = wrap(&self.chart.caption, self.width - 2.0 * MARGIN, BODY);
        self.canvas.open("g", &[("class", &"caption")]);
        for (row, line) in caption.iter().enumerate() {
            y += if row == 0 { 8.0 + BODY.size } else { BODY.leading() };
            self.canvas.text(&Text::new(line, (MARGIN, y), BODY).fill(MUTED));
        }
        self.canvas.close("g");
        y
    }

    fn legend(&mut self, entries: &[Entry]) {
        let right = self.width - MARGIN;
        self.canvas.open("g", &[("class", &"legend")]);
        let (mut x, mut y) = (MARGIN, self.top + 5.0 + ROW / 2.0);
        for entry in entries {
            let key = entry.key.width() + KEY_GAP;
            let max_lines = self.medium.width.choose(1, 3);
            let name = wrap_within(&entry.name, right - MARGIN - key, max_lines, BODY);
            let length = key + name.iter().map(|line| BODY.width(line)).fold(0.0, f64::max);
            if x > MARGIN && x + length > right {
                (x, y) = (MARGIN, y + ROW);
            }
            self.key(entry.key, (x, y));
            for (row, line) in name.iter().enumerate() {
                y += if row == 0 { 0.0 } else { BODY.leading() };
                let at = (x + key, y + BODY.cap_height() / 2.0);
                let text = Text::new(line, at, BODY);
                self.canvas.text(&if name.len() == 1 { text.tooltip(&entry.name) } else { text });
            }
            x += length + ENTRY_GAP;
        }
        self.canvas.close("g");
        self.top = y + ROW / 2.0;
    }

    /// Draws a key with its left end at `x` and its middle at height `y`.
    fn key(&mut self, key: Key, (x, y): (f64, f64)) {
        let right = x + key.width();
        let middle = ((x + right) / 2.0, y);
        let canvas = &mut self.canvas;
        match key {
            Key::Swatch(colour, stroke) => {
                let (left, top, fill) = (Px(x), Px(y - 5.0), colour.hex());
                let area: Attributes =
                    &[("x", &left), ("y", &top), ("width", &"12"), ("height", &"10"), ("fill", &fill)];
                // The outline separates the lightest shades from the paper, as in the map.
                let rim: Attributes = match colour {
                    Colour::Shade(_) => &[("stroke", &MUTED), ("stroke-width", &"0.6")],
                    _ => &[],
                };
                match stripes((x, right), (y - 5.0, y + 5.0), stroke) {
                    Some(d) => canvas.leaf("path", &[("d", &d), ("fill", &fill)]),
                    None => canvas.leaf("rect", &[area, rim].concat()),
                }
            }
            Key::Line(colour, stroke) => {
                if stroke.has_line() {
                    let (colour, dash) = (colour.hex(), stroke.dash());
                    canvas.open("g", &[("stroke", &colour), ("stroke-width", &"1.8"), ("stroke-dasharray", &dash)]);
                    canvas.line((x, y), (right, y));
                    canvas.close("g");
                }
                if stroke.has_points() {
                    canvas.point(middle, colour);
                }
            }
            Key::Diamond => canvas.diamond(middle),
            Key::Whisker => canvas.whisker((x, right), y, 7.0),
        }
    }
}

impl Chart {
    /// Returns every series with a name once, in the order of the marks; then intervals and published values, if any.
    pub(super) fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for Mark { series, shape } in self.marks() {
            let key = match shape {
                Shape::Line(_) => Key::Line(series.colour, series.stroke),
                Shape::Dots(_) | Shape::Point(_) => Key::Line(series.colour, Stroke::Points),
                Shape::Bar(_) | Shape::Tile(_) => Key::Swatch(series.colour, series.stroke),
                _ => continue,
            };
            let other = match shape {
                Shape::Bar(bar) => {
                    bar.of_other().map(|(.., series)| (series, Key::Swatch(series.colour, series.stroke)))
                }
                _ => None,
            };
            for (series, key) in std::iter::once((series, key)).chain(other) {
                let entry = Entry { name: series.name.clone(), key };
                if !series.name.trim().is_empty() && !entries.contains(&entry) {
                    entries.push(entry);
                }
            }
        }
        let mut bars = self.panels.iter().flat_map(Panel::bars).map(|(_, bar)| bar);
        if bars.clone().any(|bar| bar.drawn().is_some_and(|bar| bar.interval.is_some())) {
            entries.push(Entry { name: "95 % interval".to_owned(), key: Key::Whisker });
        }
        if bars.any(|bar| bar.diamond().is_some()) {
            entries.push(Entry { name: "published".to_owned(), key: Key::Diamond });
        }
        entries
    }

    /// Describes the axes of its panels; the numbers are in tables.
    pub(super) fn axes(&self) -> String {
        let mut sentences = Vec::new();
        for Panel { title, x, y, .. } in &self.panels {
            let title = if title.trim().is_empty() { String::new() } else { format!("{}: ", title.trim()) };
            let vertical = match y.names.is_empty() {
                true => format!(", vertical axis {}", y.title(0)),
                false => format!(", rows {}", y.names.join(", ")),
            };
            sentences.push(format!("{title}horizontal axis {}{vertical}.", x.title(0)));
        }
        sentences.join(" ")
    }

    /// Describes a drawn bar: names, value, interval, published value.
    pub(super) fn bar_in_words(&self, panel: &Panel, series: &str, bar: &Bar) -> String {
        let mut value = bar.value_text.clone();
        if value.is_empty() {
            if bar.from != 0.0 && bar.from != bar.to {
                value.push_str(&format!("{} to ", bar.number(bar.from)));
            }
            value.push_str(&bar.number(bar.to));
            if let Some((low, high)) = bar.interval {
                value.push_str(&format!(" ({} to {})", bar.number(low), bar.number(high)));
            }
        }
        let published = bar.diamond().map(|value| format!(", published {}", bar.number(value)));
        let row = panel.y.names.get(bar.row).map_or("", String::as_str);
        format!("{row}, {series}: {value}{}", published.unwrap_or_default())
    }
}
