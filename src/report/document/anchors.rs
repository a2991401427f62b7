//! Where links lead: anchors that exist once, files beside the page.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::{DocumentError, Part, Section};

/// Anchors of the page's frame.
const OWN: [&str; 2] = ["contents", "content"];

/// Checks that every anchor is well formed and unique, and that every link to an anchor leads somewhere.
pub(super) fn check(sections: &[&Section]) -> Result<(), DocumentError> {
    let mut anchors: BTreeSet<&str> = OWN.into();
    let mut links = Vec::new();
    let add = |id: &str| match well_formed(id) {
        true => Ok(()),
        false => {
            Err(DocumentError::Anchor { id: id.to_owned(), problem: "is not made of letters, digits and hyphens" })
        }
    };
    let mut found = Vec::new();
    for section in sections {
        found.push(section.id.as_str());
        collect(&section.parts, (&mut found, &mut links));
    }
    for id in found {
        add(id)?;
        if !anchors.insert(id) {
            return Err(DocumentError::Anchor { id: id.to_owned(), problem: "is there twice" });
        }
    }
    match links.into_iter().find(|link| link.strip_prefix('#').is_some_and(|id| !anchors.contains(id))) {
        None => Ok(()),
        Some(link) => Err(DocumentError::Anchor {
            id: link.trim_start_matches('#').to_owned(),
            problem: "is linked to and not there",
        }),
    }
}

fn collect<'a>(parts: &'a [Part], (anchors, links): (&mut Vec<&'a str>, &mut Vec<&'a str>)) {
    super::visit(parts, &mut |part| match part {
        Part::Figure(figure) => anchors.push(&figure.id),
        Part::Gallery(figures) => anchors.extend(figures.iter().map(|figure| figure.id.as_str())),
        Part::Table(table) => {
            let cells = || table.rows.iter().flatten();
            links.extend(cells().filter_map(|cell| cell.to.as_deref()));
            links.extend(cells().flat_map(|cell| &cell.links).map(|link| link.to.as_str()));
        }
        Part::Links(list) => links.extend(list.iter().map(|link| link.to.as_str())),
        _ => (),
    });
}

fn well_formed(id: &str) -> bool {
    id.starts_with(|c: char| c.is_ascii_alphabetic()) && id.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
}

/// `to` as a reference that can only be an anchor of this page, or a file beside or below it.
pub(super) fn href(to: &str) -> String {
    if let Some(anchor) = to.strip_prefix('#') {
        return format!("#{}", encoded(anchor, ""));
    }
    encoded(to.trim_start_matches('/'), "/")
}

/// Everything but letters, digits, `-`, `_`, `.`, `~` and what is `kept`, percent-encoded (RFC 3986).
fn encoded(text: &str, kept: &str) -> String {
    let mut encoded = String::with_capacity(text.len());
    for byte in text.bytes() {
        let c = char::from(byte);
        if c.is_ascii_alphanumeric() || "-_.~".contains(c) || kept.contains(c) {
            encoded.push(c);
        } else {
            // Writing to a string does not fail.
            let _ = write!(encoded, "%{byte:02X}");
        }
    }
    encoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_stay_beside_the_page() {
        assert_eq!(href("shares.csv"), "shares.csv");
        assert_eq!(href("a b/µ.svg"), "a%20b/%C2%B5.svg");
        assert_eq!(href("#claims"), "#claims");
        assert_eq!(href("javascript:alert(1)"), "javascript%3Aalert%281%29");
        assert_eq!(href("//example.org/x"), "example.org/x");
        assert_eq!(href("\"><script>"), "%22%3E%3Cscript%3E");
    }

    #[test]
    fn anchors_are_letters_digits_and_hyphens() {
        assert!(well_formed("figure-1"));
        for id in ["", "1", "a b", "a_b", "-a", "ä"] {
            assert!(!well_formed(id), "{id}");
        }
    }
}
