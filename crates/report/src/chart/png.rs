//! SVG to PNG with the embedded faces, the same picture on every machine.

use std::sync::{Arc, LazyLock};

use png::{BitDepth, ColorType, DeflateCompression, Encoder, EncodingError, Filter, PixelDimensions, Unit};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{self, Options, Tree, fontdb, roxmltree};
use thiserror::Error;

use super::text::{BOLD, FAMILY, REGULAR};

/// Pixels per px of the SVG: sharp on dense screens and in print.
const PNG_SCALE: f64 = 2.0;
/// Maximum number of pixels of a picture: 256 MB while it is drawn.
const MAX_PIXELS: f64 = 64.0e6;

/// Why a chart could not be converted to another format.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The text is not an SVG.
    #[error("the chart is not a drawable SVG: {0}")]
    Svg(#[from] usvg::Error),
    /// More pixels than are allowed.
    #[error("a picture of {width:.0} x {height:.0} pixels is too large, at most 64 million pixels can be drawn")]
    TooLarge {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
    /// The encoder failed.
    #[error("the picture could not be encoded as PNG: {0}")]
    Encode(#[from] EncodingError),
    /// The SVG cannot be converted to a page.
    #[cfg(feature = "pdf")]
    #[error("the chart cannot be written as PDF: {0}")]
    Pdf(svg2pdf::ConversionError),
}

static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(REGULAR.to_vec());
    fonts.load_font_data(BOLD.to_vec());
    // Text in an unknown family is dropped silently, so every generic family has a face.
    fonts.set_serif_family(FAMILY);
    fonts.set_sans_serif_family(FAMILY);
    fonts.set_cursive_family(FAMILY);
    fonts.set_fantasy_family(FAMILY);
    fonts.set_monospace_family(FAMILY);
    Arc::new(fonts)
});

/// Returns the options for reading SVG: only the embedded faces.
pub(super) fn options() -> Options<'static> {
    Options { font_family: FAMILY.to_owned(), fontdb: FONTS.clone(), ..Options::default() }
}

/// Pixels per inch of a picture for paper, as journals require for lines and letters.
const PAPER_DPI: f64 = 600.0;
/// Pixels per inch of 1 px of an SVG (CSS).
pub(super) const CSS_DPI: f64 = 96.0;

/// Draws an SVG chart of this crate as a PNG picture on white: 2 pixels per px, or 600 per inch where the
/// chart has its width on paper. The file holds the resolution, so that it is set in its size.
///
/// # Errors
/// [`PictureError`] if the text is not an SVG or the picture would be too large.
///
/// # Example
/// ```
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="30" height="20"/>"#;
/// let png = apportion_report::chart::png(svg)?;
/// assert!(png.starts_with(b"\x89PNG"));
/// # Ok::<(), apportion_report::chart::PictureError>(())
/// ```
pub fn png(svg: &str) -> Result<Vec<u8>, PictureError> {
    let document = roxmltree::Document::parse(svg).map_err(usvg::Error::ParsingFailed)?;
    let tree = Tree::from_xmltree(&document, &options())?;
    let is_paper = document.root_element().attribute("width").is_some_and(|width| width.ends_with("mm"));
    let scale = if is_paper { PAPER_DPI / CSS_DPI } else { PNG_SCALE };
    let width = (f64::from(tree.size().width()) * scale).ceil();
    let height = (f64::from(tree.size().height()) * scale).ceil();
    let size = Some((width, height)).filter(|(width, height)| width * height <= MAX_PIXELS);
    let pixels = size.and_then(|(width, height)| Pixmap::new(width as u32, height as u32));
    let mut pixels = pixels.ok_or(PictureError::TooLarge { width, height })?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale as f32, scale as f32), &mut pixels.as_mut());
    Ok(encoded(&pixels, scale * CSS_DPI)?)
}

/// Encodes an opaque picture with its pixels per inch. Charts are mostly repeated lines: PNG filters, which predict a
/// pixel from its neighbours, make their files larger; higher compression levels take longer and save little.
fn encoded(pixels: &Pixmap, dpi: f64) -> Result<Vec<u8>, EncodingError> {
    const METRE: f64 = 39.370_078_740_157_48;
    let per_metre = (dpi * METRE).round() as u32;
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_deflate_compression(DeflateCompression::Level(1));
    encoder.set_filter(Filter::NoFilter);
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    let mut colours = vec![0; pixels.data().len() / 4 * 3];
    for (colour, pixel) in colours.chunks_exact_mut(3).zip(pixels.data().chunks_exact(4)) {
        colour.copy_from_slice(&pixel[..3]);
    }
    encoder.write_header()?.write_image_data(&colours)?;
    Ok(file)
}
