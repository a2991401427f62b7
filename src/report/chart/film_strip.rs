//! Frames in rows, each with two lines of text above it.

use super::figure::{Figure, Words};
use super::model::{Chart, Drawing, Picture};
use super::path::open;
use super::style::{BODY, ChartWidth, MARGIN, MUTED, Medium, PANEL_TITLE, TICK};
use super::svg::{Anchor, Attributes, Canvas, Px, Text};
use super::text::shorten;

/// Between frames, px.
const GAP: f64 = 14.0;
/// Room for the two lines above a frame, px.
const HEAD: f64 = 34.0;

/// A film strip: what it says, and what stands above each frame.
#[derive(Clone, Debug)]
pub struct FilmStrip {
    /// Headline.
    pub title: String,
    /// One sentence under the frames.
    pub caption: String,
    /// What is drawn, for who cannot see it.
    pub description: String,
    /// For each frame its name, and what is said of it in smaller letters.
    pub frames: Vec<(String, String)>,
    /// Columns of the wide and of the narrow strip.
    pub columns: (usize, usize),
    /// Height of a frame for a width of 1.
    pub aspect: f64,
}

impl FilmStrip {
    /// The strip at both widths; `draw` draws the frame of a number.
    pub fn chart(&self, draw: impl Fn(usize, &mut Sketch)) -> Chart {
        let at = |width| {
            let [document, inline] = [false, true].map(|inline| self.drawn(Medium { width, inline }, &draw));
            Drawing { document, inline }
        };
        let picture = Picture { wide: at(ChartWidth::Wide), narrow: at(ChartWidth::Narrow) };
        Chart::from_picture(&self.title, &self.caption, picture)
    }

    fn drawn(&self, medium: Medium, draw: &impl Fn(usize, &mut Sketch)) -> String {
        let columns = medium.width.choose(self.columns.0, self.columns.1).max(1);
        let gaps = (columns - 1) as f64 * GAP;
        let frame = (medium.width.px() - 2.0 * MARGIN - gaps) / columns as f64;
        let height = (frame * self.aspect).round();
        let mut figure = Figure::begin(medium, Words { title: &self.title, caption: &self.caption }, &[]);
        let top = figure.top + 6.0;
        let rows = self.frames.len().div_ceil(columns);
        for (number, (name, note)) in self.frames.iter().enumerate() {
            let left = MARGIN + (number % columns) as f64 * (frame + GAP);
            let top = top + (number / columns) as f64 * (HEAD + height + GAP / 2.0);
            let canvas = &mut figure.canvas;
            canvas.open("g", &[("class", &"frame")]);
            let line = shorten(name, frame, PANEL_TITLE);
            canvas.text(&Text::new(&line, (left, top + 13.0), PANEL_TITLE).whole(name));
            let line = shorten(note, frame, TICK);
            canvas.text(&Text::new(&line, (left, top + 27.0), TICK).fill(MUTED).whole(note));
            let mut sketch = Sketch { canvas, width: frame, height };
            sketch.window((left, top + HEAD), (frame, height), |sketch| draw(number, sketch));
            canvas.close("g");
        }
        let bottom = top + rows as f64 * (HEAD + height + GAP / 2.0) - GAP / 2.0;
        figure.finish(bottom, &self.description)
    }
}

/// How a shape looks.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Colour inside, or `none`.
    pub fill: &'static str,
    /// Colour of the outline, or `none`.
    pub stroke: &'static str,
    /// Width of the outline, px.
    pub width: f64,
    /// Dashes of the outline, or `none`.
    pub dash: &'static str,
}

impl Look {
    /// A line.
    pub const fn line(stroke: &'static str, width: f64) -> Self {
        Self { fill: "none", stroke, width, dash: "none" }
    }

    /// An area.
    pub const fn area(fill: &'static str) -> Self {
        Self { fill, stroke: "none", width: 0.0, dash: "none" }
    }
}

/// A rectangle to draw on, its origin at the upper left corner, px. Numbers that are not finite draw nothing.
pub struct Sketch<'a> {
    canvas: &'a mut Canvas,
    /// Its width, px.
    pub width: f64,
    /// Its height, px.
    pub height: f64,
}

impl Sketch<'_> {
    /// A part of the sketch with an origin of its own, outside of which nothing is drawn.
    pub fn window(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), draw: impl FnOnce(&mut Sketch)) {
        let (left, top, w, h) = (Px(x), Px(y), Px(width), Px(height));
        // A nested document cuts off what sticks out, without names that would clash on a page.
        let attributes: &[(&str, &dyn std::fmt::Display)] =
            &[("x", &left), ("y", &top), ("width", &w), ("height", &h), ("overflow", &"hidden")];
        self.canvas.open("svg", attributes);
        draw(&mut Sketch { canvas: self.canvas, width, height });
        self.canvas.close("svg");
    }

    /// A polygon, or an open line.
    pub fn path(&mut self, points: &[(f64, f64)], closed: bool, look: Look) {
        if points.len() < 2 || points.iter().any(|(x, y)| !x.is_finite() || !y.is_finite()) {
            return;
        }
        let d = open(points) + if closed { "Z" } else { "" };
        self.shape("path", &[("d", &d), ("stroke-linejoin", &"round")], look);
    }

    /// A circle.
    pub fn circle(&mut self, (x, y): (f64, f64), radius: f64, look: Look) {
        if x.is_finite() && y.is_finite() && radius.is_finite() {
            self.shape("circle", &[("cx", &Px(x)), ("cy", &Px(y)), ("r", &Px(radius))], look);
        }
    }

    fn shape(&mut self, name: &str, geometry: Attributes, look: Look) {
        let width = Px(look.width);
        let look: Attributes = &[
            ("fill", &look.fill),
            ("stroke", &look.stroke),
            ("stroke-width", &width),
            ("stroke-dasharray", &look.dash),
        ];
        self.canvas.leaf(name, &[geometry, look].concat());
    }

    /// An arrow from `at` by `by` with a head 8 px long; one too short for its head is not drawn.
    pub fn arrow(&mut self, at: (f64, f64), by: (f64, f64), colour: &'static str) {
        const HEAD: f64 = 8.0;
        let size = libm::hypot(by.0, by.1);
        if !(size.is_finite() && size > 1.2 * HEAD) {
            return;
        }
        let along = (by.0 / size, by.1 / size);
        let tip = (at.0 + by.0, at.1 + by.1);
        let neck = (tip.0 - HEAD * along.0, tip.1 - HEAD * along.1);
        let half = 0.42 * HEAD;
        self.path(&[at, neck], false, Look::line(colour, 2.2));
        let barbs = [
            tip,
            (neck.0 - half * along.1, neck.1 + half * along.0),
            (neck.0 + half * along.1, neck.1 - half * along.0),
        ];
        self.path(&barbs, true, Look::area(colour));
    }

    /// Text with a white rim that begins at a point; or, `centred`, has its middle there.
    pub fn text(&mut self, text: &str, at: (f64, f64), centred: bool) {
        let anchor = if centred { Anchor::Middle } else { Anchor::Start };
        if at.0.is_finite() && at.1.is_finite() {
            self.canvas.text(&Text::new(text, at, BODY).anchor(anchor).halo());
        }
    }
}

#[cfg(test)]
mod tests {
    use resvg::usvg::roxmltree::Document;

    use super::super::png;
    use super::super::reading::{groups, number, only_finite};
    use super::*;

    fn strip(frames: usize) -> FilmStrip {
        FilmStrip {
            title: "Frames".to_owned(),
            caption: "What is seen.".to_owned(),
            description: String::new(),
            frames: (0..frames).map(|i| (format!("frame {i}"), "a note & more".to_owned())).collect(),
            columns: (3, 2),
            aspect: 0.5,
        }
    }

    #[test]
    fn frames_stand_in_rows_inside_the_strip() {
        let chart = strip(5).chart(|number, sketch| {
            sketch.circle((10.0, 10.0), 5.0, Look::area("#000000"));
            sketch.path(&[(0.0, f64::NAN), (1.0, 1.0)], false, Look::line("#000000", 1.0));
            sketch.arrow((0.0, 0.0), (f64::INFINITY, 0.0), "#000000");
            sketch.text(&number.to_string(), (20.0, 20.0), false);
        });
        for (page, width, rows) in [(ChartWidth::Wide, 720.0, 2), (ChartWidth::Narrow, 360.0, 3)] {
            let svg = chart.svg_at(page).unwrap();
            let document = Document::parse(&svg).unwrap();
            assert!(only_finite(&document));
            assert_eq!(number(&document.root_element(), "width"), width);
            assert_eq!(groups(&document, "frame").len(), 5);
            let height = number(&document.root_element(), "height");
            let windows: Vec<_> = document.descendants().filter(|n| n.has_tag_name("svg")).skip(1).collect();
            let mut tops: Vec<f64> = windows.iter().map(|n| number(n, "y")).collect();
            tops.dedup();
            assert_eq!(tops.len(), rows);
            for window in windows {
                assert!(number(&window, "x") + number(&window, "width") <= width - MARGIN + 0.01);
                assert!(number(&window, "y") + number(&window, "height") < height);
            }
            png(&svg).unwrap();
        }
        for inline in [ChartWidth::Wide, ChartWidth::Narrow].map(|page| chart.inline(page).unwrap()) {
            let document = Document::parse(&inline).unwrap();
            assert!(document.root_element().attribute("width").is_none());
            assert!(groups(&document, "title").is_empty() && groups(&document, "caption").is_empty());
        }
    }

    #[test]
    fn a_strip_without_frames_is_a_picture_too() {
        let svg = strip(0).chart(|_, _| ()).svg().unwrap();
        assert!(Document::parse(&svg).is_ok());
    }
}
