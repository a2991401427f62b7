//! Plain text as HTML: symbols with subscripts, everything escaped, and targets of links.

use apportion_base::text::symbol;

use crate::format::split_word;

/// Converts `text` to HTML that may be used in an element or in a quoted attribute.
///
/// Everything is escaped and control characters are dropped. `X_abc`, a single Latin or Greek letter with a subscript
/// of at most four letters or digits (or the name of a Greek letter), is set as `<var>X</var><sub>abc</sub>`; a star
/// may follow. Longer names and file names stay as they are. Text between backticks is set as code. An estimate and its
/// error, and a number and its `%`, are joined by no-break spaces.
///
/// ```
/// use apportion_report::document::symbols;
///
/// assert_eq!(symbols("F_cr < 5 nN"), "<var>F</var><sub>cr</sub> &lt; 5 nN");
/// assert_eq!(symbols("see my_file and x_1.csv"), "see my_file and x_1.csv");
/// ```
pub fn symbols(text: &str) -> String {
    let mut html = String::with_capacity(text.len() + text.len() / 8);
    let mut rest = text;
    while let Some((before, code, after)) = code_span(rest) {
        html.push_str(&prose(before));
        html.push_str(&format!("<code>{}</code>", escaped(code)));
        rest = after;
    }
    html + &prose(rest)
}

/// Splits at the first pair of backticks into the text before, between and after them.
fn code_span(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once('`')?;
    let (code, after) = rest.split_once('`')?;
    let fits = !code.is_empty() && !code.starts_with(' ') && !code.ends_with(' ');
    fits.then_some((before, code, after))
}

fn prose(text: &str) -> String {
    let text = clean(text).replace(" ± ", "\u{a0}±\u{a0}").replace(" %", "\u{a0}%");
    let mut html = String::with_capacity(text.len() + 16);
    let mut rest = &text[..];
    while !rest.is_empty() {
        let before = &text[..text.len() - rest.len()];
        let (word, after) = split_word(rest);
        match symbol(word).filter(|_| !is_in_name(before, after)) {
            Some((letter, below)) => html.push_str(&format!("<var>{letter}</var><sub>{below}</sub>")),
            None => html.push_str(&escaped(word)),
        }
        rest = after;
    }
    html
}

/// Returns whether the word between these texts is a part of a longer name, such as that of a file.
fn is_in_name(before: &str, after: &str) -> bool {
    let hyphenated = before.strip_suffix('-').is_some_and(|start| start.ends_with(char::is_alphanumeric));
    let mut next = after.chars();
    let joint = next.next().filter(|c| matches!(c, '.' | '-' | '/' | '\\'));
    let is_continued = joint.is_some() && next.next().is_some_and(char::is_alphabetic);
    // A slash may divide by another symbol, as in `S_1/S_T`.
    let is_quotient = joint == Some('/') && next.next() == Some('_');
    before.ends_with(['.', '\\', '~', '@', '#', '$']) || hyphenated || (is_continued && !is_quotient)
}

/// Removes control characters (line ends and tabs stay) and those that change the direction of writing.
pub(super) fn clean(text: &str) -> String {
    let allowed = text.chars().filter(|c| match c {
        '\n' | '\t' => true,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fffe}' | '\u{ffff}' => false,
        c => !c.is_control(),
    });
    allowed.collect()
}

/// Cleans the text and escapes the characters that have a meaning in HTML.
pub(super) fn escaped(text: &str) -> String {
    clean(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&#39;")
}

/// Returns `to` as a reference that can only be an anchor of this page, or a file next to it or below it.
pub(super) fn href(to: &str) -> String {
    if let Some(anchor) = to.strip_prefix('#') {
        return format!("#{}", encoded(anchor, ""));
    }
    encoded(to.trim_start_matches('/'), "/")
}

/// Percent-encodes everything but letters, digits, `-`, `_`, `.`, `~` and the characters in `kept` (RFC 3986).
fn encoded(text: &str, kept: &str) -> String {
    let mut url = String::with_capacity(text.len());
    for byte in text.bytes() {
        let c = char::from(byte);
        match c.is_ascii_alphanumeric() || "-_.~".contains(c) || kept.contains(c) {
            true => url.push(c),
            false => url.push_str(&format!("%{byte:02X}")),
        }
    }
    url
}
