//! SVG to PDF: the same picture as vectors and text, in its size on paper.

use resvg::usvg::Tree;
use svg2pdf::{ConversionOptions, PageOptions, to_pdf};

use super::png::{CSS_DPI, PictureError, options};

/// Converts an SVG chart of this crate to a PDF of one page of the size of the picture: 72 points are 96 px, or the
/// millimetres that the SVG gives. Marks are vectors; texts can be searched and copied, in subsets of the embedded
/// faces.
///
/// # Errors
/// [`PictureError`] if the text is not an SVG, or holds something that cannot be drawn on a page.
///
/// # Example
/// ```
/// let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="96" height="48"><path d="M0 0L96 48" stroke="black"/></svg>"#;
/// let pdf = apportion_report::chart::pdf(svg)?;
/// assert!(pdf.starts_with(b"%PDF-1."));
/// # Ok::<(), apportion_report::chart::PictureError>(())
/// ```
pub fn pdf(svg: &str) -> Result<Vec<u8>, PictureError> {
    let tree = Tree::from_str(svg, &options())?;
    to_pdf(&tree, ConversionOptions::default(), PageOptions { dpi: CSS_DPI as f32 }).map_err(PictureError::Pdf)
}
