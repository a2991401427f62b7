//! Line breaks and shortening of text to a width, and the numbers in a chart.

use super::font::Face;

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
    let fits = |c: &char| {
        used += face.width(c.encode_utf8(&mut [0; 4]));
        used <= width
    };
    let kept: String = line.chars().take_while(fits).collect();
    format!("{}…", kept.trim_end())
}

/// Breaks text into at most `most` lines no wider than `width` px; the last one is shortened if there is more.
pub(super) fn wrap_within(text: &str, width: f64, most: usize, face: Face) -> Vec<String> {
    let mut lines = wrap(text, width, face);
    if lines.len() > most {
        let rest = lines.split_off(most.saturating_sub(1)).join(" ");
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
