//! Targets of links: anchors of the page, and files in its folder.

/// Returns `to` as a reference that can only be an anchor of this page, or a file next to it or below it.
pub(super) fn href(to: &str) -> String {
    if let Some(anchor) = to.strip_prefix('#') {
        return format!("#{}", encoded(anchor, ""));
    }
    encoded(to.trim_start_matches('/'), "/")
}

/// Percent-encodes everything but letters, digits, `-`, `_`, `.`, `~` and the characters in `kept` (RFC 3986).
fn encoded(text: &str, kept: &str) -> String {
    let letter = |byte: u8| {
        let c = char::from(byte);
        let is_kept = c.is_ascii_alphanumeric() || "-_.~".contains(c) || kept.contains(c);
        if is_kept { c.to_string() } else { format!("%{byte:02X}") }
    };
    text.bytes().map(letter).collect()
}
