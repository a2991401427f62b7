//! The embedded faces in a PDF, cut to the letters that are used.

use std::collections::BTreeMap;

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use resvg::tiny_skia::Transform;
use resvg::usvg::Tree;
use resvg::usvg::layout::PositionedGlyph;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use subsetter::GlyphRemapper;

use super::font::{BOLD, FAMILY, REGULAR, Weight};

/// The encoding of glyphs by two bytes.
const IDENTITY: Name<'static> = Name(b"Identity-H");
const SYSTEM: SystemInfo<'static> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// Units of PDF per em.
const EM: f32 = 1000.0;
/// Glyphs this far off the line of those before begin a line of their own, em.
const OFF_LINE: f32 = 1e-3;
/// A class of bold faces (OpenType, usWeightClass).
const BOLD_CLASS: u16 = 600;

/// A face, and which of its glyphs are used.
pub(super) struct PdfFont {
    weight: Weight,
    glyphs: GlyphRemapper,
    /// The texts that the glyphs stand for, by their new numbers.
    texts: BTreeMap<u16, String>,
    /// Advances by the old numbers, PDF units.
    advances: BTreeMap<u16, f32>,
}

/// Glyphs on one line.
pub(super) struct Run {
    /// From em of the first glyph, upwards, to the coordinates of the text.
    pub at: Transform,
    /// What is subtracted from the pen before each glyph, thousandths of an em, and its new number.
    pub glyphs: Vec<(f32, u16)>,
}

impl PdfFont {
    pub fn new(weight: Weight) -> Self {
        Self { weight, glyphs: GlyphRemapper::new(), texts: BTreeMap::new(), advances: BTreeMap::new() }
    }

    /// What font number `number` is called on the page.
    pub fn name(number: usize) -> String {
        format!("F{number}")
    }

    pub fn is_used(&self) -> bool {
        !self.texts.is_empty()
    }

    fn bytes(&self) -> &'static [u8] {
        match self.weight {
            Weight::Regular => REGULAR,
            Weight::Bold => BOLD,
        }
    }

    fn face(&self) -> Result<FontRef<'static>, String> {
        FontRef::new(self.bytes()).map_err(|error| error.to_string())
    }

    /// Takes a glyph that stands for `text`; gives its new number.
    fn take(&mut self, glyph: u16, text: &str) -> u16 {
        let number = self.glyphs.remap(glyph);
        self.texts.entry(number).or_insert_with(|| text.to_owned());
        number
    }

    /// The advance of a glyph, PDF units.
    fn advance(&mut self, glyph: u16) -> f32 {
        if let Some(advance) = self.advances.get(&glyph) {
            return *advance;
        }
        let face = self.face().ok();
        let advance = face.and_then(|face| {
            let metrics = face.glyph_metrics(Size::new(EM), LocationRef::default());
            metrics.advance_width(GlyphId::new(u32::from(glyph)))
        });
        *self.advances.entry(glyph).or_insert(advance.unwrap_or(0.0))
    }

    /// Writes the font as object `at`; `new` gives numbers for the objects that it needs. An error says why it cannot be embedded.
    pub fn write(mut self, pdf: &mut Pdf, at: Ref, new: &mut dyn FnMut() -> Ref) -> Result<(), String> {
        let subset = subsetter::subset(self.bytes(), 0, &self.glyphs).map_err(|error| error.to_string())?;
        let [cid, descriptor, unicode, data] = std::array::from_fn(|_| new());
        // Subsets have six letters before their names, different ones for different subsets (ISO 32000-1, 9.6.4).
        let mut hash = crc32fast::hash(&subset);
        let tag: String = (0..6)
            .map(|_| {
                let letter = b'A' + (hash % 26) as u8;
                hash /= 26;
                char::from(letter)
            })
            .collect();
        let style = match self.weight {
            Weight::Regular => "Regular",
            Weight::Bold => "Bold",
        };
        let name = format!("{tag}+{}-{style}", FAMILY.replace(' ', ""));
        let name = Name(name.as_bytes());
        pdf.type0_font(at).base_font(name).encoding_predefined(IDENTITY).descendant_font(cid).to_unicode(unicode);
        let old: Vec<u16> = self.glyphs.remapped_gids().collect();
        let widths: Vec<f32> = old.into_iter().map(|glyph| self.advance(glyph)).collect();
        let mut of_cid = pdf.cid_font(cid);
        of_cid.subtype(CidFontType::Type2).base_font(name).system_info(SYSTEM).font_descriptor(descriptor);
        of_cid.default_width(0.0).cid_to_gid_map_predefined(Name(b"Identity"));
        of_cid.widths().consecutive(0, widths);
        of_cid.finish();
        let metrics = self.face()?.metrics(Size::new(EM), LocationRef::default());
        let bounds = metrics.bounds.unwrap_or_default();
        let mut described = pdf.font_descriptor(descriptor);
        described.name(name).flags(FontFlags::NON_SYMBOLIC).italic_angle(0.0);
        described.bbox(Rect::new(bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max));
        described
            .ascent(metrics.ascent)
            .descent(metrics.descent)
            .cap_height(metrics.cap_height.unwrap_or(metrics.ascent));
        // About the stems of Helvetica and Helvetica Bold.
        described.stem_v(if self.weight == Weight::Bold { 140.0 } else { 88.0 }).font_file2(data);
        described.finish();
        let mut map = UnicodeCmap::new(Name(b"Custom"), SYSTEM);
        for (glyph, text) in self.texts.iter().filter(|(_, text)| !text.is_empty()) {
            map.pair_with_multiple(*glyph, text.chars());
        }
        let map = compressed(&map.finish());
        pdf.cmap(unicode, &map).filter(Filter::FlateDecode);
        let packed = compressed(&subset);
        let mut stream = pdf.stream(data, &packed);
        stream.filter(Filter::FlateDecode).pair(Name(b"Length1"), subset.len() as i32);
        stream.finish();
        Ok(())
    }
}

/// For the filter `FlateDecode`.
pub(super) fn compressed(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, 6)
}

/// The glyphs of a text of one look as runs, each with the number of its font among `fonts`.
pub(super) fn shown(tree: &Tree, glyphs: &[PositionedGlyph], fonts: &mut [PdfFont; 2]) -> Vec<(usize, Run)> {
    let mut runs: Vec<(usize, Run)> = Vec::new();
    // Where the last glyph of the run ends, em.
    let mut pen = 0.0;
    for glyph in glyphs {
        let is_bold = tree.fontdb().face(glyph.font).is_some_and(|face| face.weight.0 >= BOLD_CLASS);
        let number = usize::from(is_bold);
        let font = &mut fonts[number];
        let units = font.face().map_or(1, |face| face.metrics(Size::unscaled(), LocationRef::default()).units_per_em);
        let em = f32::from(units);
        let at = glyph.outline_transform().pre_concat(Transform::from_scale(em, em));
        // The faces have far fewer glyphs than that; number 0 is the box of letters that are missing.
        let id = u16::try_from(glyph.id.0).unwrap_or(0);
        let (new, advance) = (font.take(id, &glyph.text), font.advance(id) / EM);
        let place = runs.last().filter(|(before, _)| *before == number).and_then(|(_, run)| along(run.at, at));
        match (place, runs.last_mut()) {
            (Some(place), Some((_, run))) => {
                let adjust = ((pen - place) * EM * 10.0).round() / 10.0;
                run.glyphs.push((adjust, new));
                pen = place + advance;
            }
            _ => {
                runs.push((number, Run { at, glyphs: vec![(0.0, new)] }));
                pen = advance;
            }
        }
    }
    runs
}

/// How far along the line of `first` a glyph stands, em; `None` if it does not stand on it.
fn along(first: Transform, at: Transform) -> Option<f32> {
    let is_alike =
        [first.sx - at.sx, first.sy - at.sy, first.kx - at.kx, first.ky - at.ky].iter().all(|d| d.abs() < 1e-4);
    let mut place = resvg::tiny_skia::Point::from_xy(at.tx, at.ty);
    first.invert()?.map_point(&mut place);
    (is_alike && place.y.abs() < OFF_LINE).then_some(place.x)
}
