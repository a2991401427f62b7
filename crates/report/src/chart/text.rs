//! Line breaks and shortening of text to a width, the numbers in a chart, and the embedded faces.
//!
//! The faces are subsets of Liberation Sans, whose advances equal Arial's, so a layout measured here also holds in a
//! browser that draws the chart with Arial, Helvetica or Liberation Sans.

use std::collections::HashMap;
use std::sync::LazyLock;

use ttf_parser::Face as FontFace;

/// Breaks text into lines no wider than `width` px: at white space, and inside a word that is wider by itself. White
/// space is normalised, so empty text gives no line.
pub(super) fn wrap(text: &str, width: f64, face: Face) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let joined = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if face.width(&joined) <= width {
            line = joined;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for c in word.chars() {
            line.push(c);
            if line.len() > c.len_utf8() && face.width(&line) > width {
                line.pop();
                lines.push(std::mem::replace(&mut line, c.to_string()));
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Shortens a text to one line no wider than `width` px; an ellipsis replaces the rest.
pub(super) fn shorten(text: &str, width: f64, face: Face) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if face.width(&line) <= width {
        return line;
    }
    let mut used = face.width("…");
    let mut kept = String::new();
    for c in line.chars() {
        used += face.width(c.encode_utf8(&mut [0; 4]));
        if used > width {
            break;
        }
        kept.push(c);
    }
    format!("{}…", kept.trim_end())
}

/// Breaks text into at most `max_lines` lines no wider than `width` px; the last one is shortened if there is more.
pub(super) fn wrap_within(text: &str, width: f64, max_lines: usize, face: Face) -> Vec<String> {
    let mut lines = wrap(text, width, face);
    if lines.len() > max_lines {
        let rest = lines.split_off(max_lines.saturating_sub(1)).join(" ");
        lines.push(shorten(&rest, width, face));
    }
    lines
}

/// Formats a share in percent with one decimal and a true minus sign; magnitudes from 1e5 as a power of ten.
pub(super) fn percent(value: f64) -> String {
    let text = if value.abs() < 1e5 { format!("{value:.1}") } else { format!("{value:.1e}") };
    minus(if text == "-0.0" { "0.0" } else { &text })
}

/// Replaces hyphens that serve as minus signs.
pub(super) fn minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// Formats `10ⁿ` in superscript characters.
pub(super) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let mut text = String::from("10");
    for c in exponent.to_string().chars() {
        text.push(c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]));
    }
    text
}

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
