//! SVG to PDF: the same picture as vectors and real text, in its size on paper.

use std::collections::BTreeMap;

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Path as Outline, PathSegment, Transform};
use resvg::usvg::{
    Fill, FillRule, Group, LineCap, LineJoin, Node, Paint, PaintOrder, Path, Stroke, Text, Tree, roxmltree,
};
use thiserror::Error;

use super::font::Weight;
use super::pdf_font::{PdfFont, compressed, shown};
use super::png::options;

/// Points per px of an SVG (CSS: 96 px and 72 pt are an inch).
const POINTS: f32 = 0.75;
/// Longest side of a page, points: more is not allowed (ISO 32000-1, annex C).
const LONGEST: f32 = 14_400.0;

/// Why an SVG could not be made a PDF.
#[derive(Debug, Error)]
pub enum PdfError {
    /// Not well-formed XML.
    #[error("the chart is not well-formed XML: {0}")]
    Xml(String),
    /// Well-formed, but no SVG picture.
    #[error("the chart is not a drawable SVG: {0}")]
    Svg(String),
    /// Something that charts of this crate do not have.
    #[error("{0} cannot be written to a PDF")]
    Unsupported(&'static str),
    /// More than a page may have.
    #[error("a page of {width:.0} x {height:.0} points is too large, at most 14400 are allowed")]
    TooLarge {
        /// Width in points.
        width: f32,
        /// Height in points.
        height: f32,
    },
    /// The embedded font cannot be cut to the letters that are used.
    #[error("the font cannot be embedded: {0}")]
    Font(String),
}

/// Writes an SVG chart of this crate as a PDF of one page, which is as large as the picture: 72 points are 96 px, or the
/// millimetres that the SVG names. Marks are vectors; texts are text that can be searched and copied, in the embedded faces cut to
/// the letters that occur. The same SVG gives the same bytes.
///
/// # Errors
/// [`PdfError`] if the text is no SVG, has what charts do not have (pictures, gradients, masks, filters), or is too large.
///
/// # Example
/// ```
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="96" height="48"><path d="M0 0L96 48" stroke="black"/></svg>"#;
/// let pdf = apportion::report::chart::pdf(svg)?;
/// assert!(pdf.starts_with(b"%PDF-1.4"));
/// # Ok::<(), apportion::report::chart::PdfError>(())
/// ```
pub fn pdf(svg: &str) -> Result<Vec<u8>, PdfError> {
    let document = roxmltree::Document::parse(svg).map_err(|error| PdfError::Xml(error.to_string()))?;
    let tree = Tree::from_xmltree(&document, &options()).map_err(|error| PdfError::Svg(error.to_string()))?;
    let (width, height) = (tree.size().width() * POINTS, tree.size().height() * POINTS);
    if width.max(height) > LONGEST {
        return Err(PdfError::TooLarge { width, height });
    }
    let mut page = Page::new(&tree);
    // The origin of SVG is the upper left corner, that of PDF the lower left one.
    page.content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, height]);
    page.group(tree.root())?;
    let title = document.root_element().children().find(|node| node.has_tag_name("title")).and_then(|node| node.text());
    page.file(title.unwrap_or_default(), (width, height))
}

/// A page being drawn.
struct Page<'a> {
    tree: &'a Tree,
    content: Content,
    fonts: [PdfFont; 2],
    /// Numbers of the graphics states by their opacities of filling and stroke, in thousandths.
    opacities: BTreeMap<(u16, u16), usize>,
}

impl<'a> Page<'a> {
    fn new(tree: &'a Tree) -> Self {
        let fonts = [Weight::Regular, Weight::Bold].map(PdfFont::new);
        Self { tree, content: Content::new(), fonts, opacities: BTreeMap::new() }
    }

    fn group(&mut self, group: &Group) -> Result<(), PdfError> {
        if group.mask().is_some() || !group.filters().is_empty() || group.opacity().get() < 1.0 {
            return Err(PdfError::Unsupported("a mask, a filter or an opacity of a group"));
        }
        self.content.save_state();
        if let Some(clip) = group.clip_path() {
            let to_page = group.abs_transform().pre_concat(clip.transform());
            self.clip(clip.root(), to_page);
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group)?,
                Node::Path(path) if path.is_visible() => self.path(path)?,
                Node::Path(_) => (),
                Node::Text(text) => self.text(text)?,
                Node::Image(_) => return Err(PdfError::Unsupported("a picture of pixels")),
            }
        }
        self.content.restore_state();
        Ok(())
    }

    /// Cuts off what is outside of the outlines below `group`.
    fn clip(&mut self, group: &Group, to_page: Transform) {
        for node in group.children() {
            match node {
                Node::Path(path) => {
                    if let Some(outline) = path.data().clone().transform(to_page) {
                        self.outline(&outline);
                    }
                }
                Node::Group(inner) => self.clip(inner, to_page.pre_concat(inner.transform())),
                Node::Text(_) | Node::Image(_) => (),
            }
        }
        self.content.clip_nonzero().end_path();
    }

    fn path(&mut self, path: &Path) -> Result<(), PdfError> {
        let (fill, stroke) = match path.paint_order() {
            PaintOrder::StrokeAndFill if path.fill().is_some() && path.stroke().is_some() => {
                self.painted(path, (None, path.stroke()))?;
                (path.fill(), None)
            }
            _ => (path.fill(), path.stroke()),
        };
        self.painted(path, (fill, stroke))
    }

    /// An outline, filled, stroked, or both.
    fn painted(&mut self, path: &Path, (fill, stroke): (Option<&Fill>, Option<&Stroke>)) -> Result<(), PdfError> {
        self.content.save_state();
        self.content.transform(matrix(path.abs_transform()));
        let opacity = |opacity: Option<f32>| opacity.unwrap_or(1.0);
        self.opacity(
            opacity(fill.map(|fill| fill.opacity().get())),
            opacity(stroke.map(|stroke| stroke.opacity().get())),
        );
        if let Some(fill) = fill {
            let [r, g, b] = colour(fill.paint())?;
            self.content.set_fill_rgb(r, g, b);
        }
        if let Some(stroke) = stroke {
            self.stroke(stroke)?;
        }
        self.outline(path.data());
        let is_even_odd = fill.is_some_and(|fill| fill.rule() == FillRule::EvenOdd);
        match (fill.is_some(), stroke.is_some()) {
            (true, true) if is_even_odd => self.content.fill_even_odd_and_stroke(),
            (true, true) => self.content.fill_nonzero_and_stroke(),
            (true, false) if is_even_odd => self.content.fill_even_odd(),
            (true, false) => self.content.fill_nonzero(),
            (false, true) => self.content.stroke(),
            (false, false) => self.content.end_path(),
        };
        self.content.restore_state();
        Ok(())
    }

    fn stroke(&mut self, stroke: &Stroke) -> Result<(), PdfError> {
        let [r, g, b] = colour(stroke.paint())?;
        self.content.set_stroke_rgb(r, g, b).set_line_width(stroke.width().get());
        self.content.set_line_cap(match stroke.linecap() {
            LineCap::Butt => LineCapStyle::ButtCap,
            LineCap::Round => LineCapStyle::RoundCap,
            LineCap::Square => LineCapStyle::ProjectingSquareCap,
        });
        self.content.set_line_join(match stroke.linejoin() {
            LineJoin::Round => LineJoinStyle::RoundJoin,
            LineJoin::Bevel => LineJoinStyle::BevelJoin,
            LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
        });
        self.content.set_miter_limit(stroke.miterlimit().get());
        self.content.set_dash_pattern(stroke.dasharray().unwrap_or_default().iter().copied(), stroke.dashoffset());
        Ok(())
    }

    fn opacity(&mut self, fill: f32, stroke: f32) {
        let thousandths = |opacity: f32| (1000.0 * opacity).round() as u16;
        let key = (thousandths(fill), thousandths(stroke));
        if key != (1000, 1000) {
            let next = self.opacities.len();
            let number = *self.opacities.entry(key).or_insert(next);
            self.content.set_parameters(Name(format!("G{number}").as_bytes()));
        }
    }

    fn outline(&mut self, outline: &Outline) {
        let mut last = (0.0, 0.0);
        for segment in outline.segments() {
            match segment {
                PathSegment::MoveTo(p) => {
                    self.content.move_to(p.x, p.y);
                    last = (p.x, p.y);
                }
                PathSegment::LineTo(p) => {
                    self.content.line_to(p.x, p.y);
                    last = (p.x, p.y);
                }
                // A parabola as a cubic curve.
                PathSegment::QuadTo(c, p) => {
                    let near = |from: f32, control: f32| from + 2.0 / 3.0 * (control - from);
                    let (a, b) = ((near(last.0, c.x), near(last.1, c.y)), (near(p.x, c.x), near(p.y, c.y)));
                    self.content.cubic_to(a.0, a.1, b.0, b.1, p.x, p.y);
                    last = (p.x, p.y);
                }
                PathSegment::CubicTo(a, b, p) => {
                    self.content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y);
                    last = (p.x, p.y);
                }
                PathSegment::Close => {
                    self.content.close_path();
                }
            }
        }
    }

    /// A text: the rims of its letters as outlines, so that no letter is there twice, then the letters as text.
    fn text(&mut self, text: &Text) -> Result<(), PdfError> {
        self.rims(text.flattened())?;
        let to_page = text.abs_transform();
        for span in text.layouted().iter().filter(|span| span.visible) {
            let Some(fill) = &span.fill else { continue };
            let [r, g, b] = colour(fill.paint())?;
            self.content.save_state();
            self.opacity(fill.opacity().get(), 1.0);
            self.content.set_fill_rgb(r, g, b).begin_text();
            for (font, run) in shown(self.tree, &span.positioned_glyphs, &mut self.fonts) {
                self.content.set_font(Name(PdfFont::name(font).as_bytes()), 1.0);
                self.content.set_text_matrix(matrix(to_page.pre_concat(run.at)));
                let mut positioned = self.content.show_positioned();
                let mut items = positioned.items();
                for (adjust, glyph) in &run.glyphs {
                    if *adjust != 0.0 {
                        items.adjust(*adjust);
                    }
                    items.show(pdf_writer::Str(&glyph.to_be_bytes()));
                }
            }
            self.content.end_text().restore_state();
        }
        Ok(())
    }

    fn rims(&mut self, outlines: &Group) -> Result<(), PdfError> {
        for node in outlines.children() {
            match node {
                Node::Group(group) => self.rims(group)?,
                Node::Path(path) if path.stroke().is_some() => self.painted(path, (None, path.stroke()))?,
                _ => (),
            }
        }
        Ok(())
    }

    /// The file.
    fn file(self, title: &str, (width, height): (f32, f32)) -> Result<Vec<u8>, PdfError> {
        let mut next = 0;
        let mut new = || {
            next += 1;
            Ref::new(next)
        };
        let [catalog, pages, page, content, info] = std::array::from_fn(|_| new());
        let mut pdf = Pdf::new();
        // The least version with opacities, which every typesetter takes.
        pdf.set_version(1, 4);
        pdf.catalog(catalog).pages(pages).lang(TextStr("en"));
        pdf.pages(pages).kids([page]).count(1);
        let used: Vec<(usize, PdfFont, Ref)> = self
            .fonts
            .into_iter()
            .enumerate()
            .filter(|(_, font)| font.is_used())
            .map(|(n, font)| (n, font, new()))
            .collect();
        let states: Vec<((u16, u16), usize, Ref)> =
            self.opacities.into_iter().map(|(key, n)| (key, n, new())).collect();
        let mut on_page = pdf.page(page);
        on_page.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(content);
        let mut resources = on_page.resources();
        let mut fonts = resources.fonts();
        for (number, _, at) in &used {
            fonts.pair(Name(PdfFont::name(*number).as_bytes()), *at);
        }
        fonts.finish();
        let mut of_page = resources.ext_g_states();
        for (_, number, at) in &states {
            of_page.pair(Name(format!("G{number}").as_bytes()), *at);
        }
        of_page.finish();
        resources.finish();
        on_page.finish();
        for ((fill, stroke), _, at) in states {
            let part = |thousandths: u16| f32::from(thousandths) / 1000.0;
            pdf.ext_graphics(at).non_stroking_alpha(part(fill)).stroking_alpha(part(stroke));
        }
        let drawn = compressed(&self.content.finish());
        pdf.stream(content, &drawn).filter(Filter::FlateDecode);
        for (_, font, at) in used {
            font.write(&mut pdf, at, &mut new).map_err(PdfError::Font)?;
        }
        let producer = format!("apportion {}", env!("CARGO_PKG_VERSION"));
        pdf.document_info(info).title(TextStr(title)).producer(TextStr(&producer));
        Ok(pdf.finish())
    }
}

fn colour(paint: &Paint) -> Result<[f32; 3], PdfError> {
    match paint {
        Paint::Color(colour) => Ok([colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0)),
        _ => Err(PdfError::Unsupported("a gradient or a pattern")),
    }
}

fn matrix(t: Transform) -> [f32; 6] {
    [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty]
}
