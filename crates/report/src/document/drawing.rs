//! Charts inside a page: the drawings of each, with names for screen readers.

use crate::chart::{Chart, ChartWidth};

/// Draws `chart` as an element whose identifiers begin with `id`.
pub(super) fn drawn(id: &str, chart: &Chart, width: ChartWidth) -> String {
    let kind = if width == ChartWidth::Wide { "wide" } else { "narrow" };
    named(&chart.inline(width), &format!("{id}-{kind}"))
}

/// Links the picture to its title and description by identifiers, which not every browser does by itself.
fn named(svg: &str, id: &str) -> String {
    let Some(body) = svg.strip_prefix("<svg") else { return svg.to_owned() };
    let mut labels = String::new();
    let mut body = body.to_owned();
    for (element, attribute) in [("title", "aria-labelledby"), ("desc", "aria-describedby")] {
        let tag = format!("<{element}>");
        // The first one belongs to the whole picture: parts have theirs inside.
        if body.contains(&tag) {
            body = body.replacen(&tag, &format!("<{element} id=\"{id}-{element}\">"), 1);
            labels.push_str(&format!(" {attribute}=\"{id}-{element}\""));
        }
    }
    format!("<svg{labels}{body}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_named_by_its_title_and_description() {
        let svg = "<svg role=\"img\"><title>T</title><desc>D</desc><g><title>part</title></g></svg>";
        assert_eq!(
            named(svg, "f-wide"),
            "<svg aria-labelledby=\"f-wide-title\" aria-describedby=\"f-wide-desc\" role=\"img\">\
             <title id=\"f-wide-title\">T</title><desc id=\"f-wide-desc\">D</desc><g><title>part</title></g></svg>"
        );
        assert_eq!(named("<svg></svg>", "f"), "<svg></svg>");
    }
}
