//! The embedded faces: their bytes, the advances of their glyphs and the characters they cover.
//!
//! The faces are subsets of Liberation Sans, whose advances equal Arial's, so a layout measured here
//! also holds in a browser that draws the chart with Arial, Helvetica or Liberation Sans.

use std::collections::HashMap;
use std::sync::LazyLock;

use ttf_parser::Face as FontFace;

/// Family name of the embedded faces.
#[cfg(feature = "png")]
pub(super) const FAMILY: &str = "Apportion Sans";
/// Families named in the SVG, except the generic one of equal metrics.
pub(super) const FAMILIES: &str = "Arial, 'Liberation Sans', Helvetica, sans-serif";
/// Bytes of the regular face (TrueType).
pub(super) static REGULAR: &[u8] = include_bytes!("../../fonts/ApportionSans-Regular.ttf");
/// Bytes of the bold face (TrueType).
pub(super) static BOLD: &[u8] = include_bytes!("../../fonts/ApportionSans-Bold.ttf");

/// Advance in em assumed for a character that the faces lack: that of an ideograph, the widest usual case.
const UNKNOWN_ADVANCE: f64 = 1.0;

/// Regular or bold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

/// A face at a size in user units of the SVG (px).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    pub size: f64,
    pub weight: Weight,
}

impl Face {
    /// Returns the regular face.
    pub const fn regular(size: f64) -> Self {
        Self { size, weight: Weight::Regular }
    }

    /// Returns the bold face.
    pub const fn bold(size: f64) -> Self {
        Self { size, weight: Weight::Bold }
    }

    /// Returns the width of one line of text, px. Kerning, which only reduces it, is ignored.
    pub fn width(self, text: &str) -> f64 {
        let advances = match self.weight {
            Weight::Regular => &*REGULAR_ADVANCES,
            Weight::Bold => &*BOLD_ADVANCES,
        };
        let em: f64 = text.chars().map(|c| advances.get(&c).copied().unwrap_or(UNKNOWN_ADVANCE)).sum();
        em * self.size
    }

    /// Returns the distance from one baseline to the next, px.
    pub fn leading(self) -> f64 {
        1.25 * self.size
    }

    /// Returns the height of a capital letter, px (Liberation Sans: 1409 of 2048 units).
    pub fn cap_height(self) -> f64 {
        0.688 * self.size
    }
}

static REGULAR_ADVANCES: LazyLock<HashMap<char, f64>> = LazyLock::new(|| advances(REGULAR));
static BOLD_ADVANCES: LazyLock<HashMap<char, f64>> = LazyLock::new(|| advances(BOLD));

/// Returns the advances in em by character; empty if the bytes are not a font, which a test excludes.
fn advances(font: &[u8]) -> HashMap<char, f64> {
    let Ok(font) = FontFace::parse(font, 0) else { return HashMap::new() };
    let em = f64::from(font.units_per_em());
    let mut advances = HashMap::new();
    for table in font.tables().cmap.iter().flat_map(|cmap| cmap.subtables).filter(|table| table.is_unicode()) {
        table.codepoints(|code| {
            let advance = table.glyph_index(code).and_then(|glyph| font.glyph_hor_advance(glyph));
            advances.extend(char::from_u32(code).zip(advance.map(|advance| f64::from(advance) / em)));
        });
    }
    advances
}
