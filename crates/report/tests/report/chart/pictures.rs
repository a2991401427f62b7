//! Pictures and pages of charts, and the colours and faces in them.

use std::collections::BTreeSet;

use apportion_report::chart::{PaperWidth, PictureError, pdf};
use resvg::tiny_skia::Pixmap;
use resvg::usvg::{Group, Node};

use super::*;

/// Returns the number of dark pixels, and the width.
fn dark(svg: &str) -> (usize, u32) {
    let pixels = Pixmap::decode_png(&png(svg).expect("a valid SVG")).expect("a PNG");
    (pixels.pixels().iter().filter(|p| p.red() < 100 && p.alpha() == 255).count(), pixels.width())
}

fn standard(attributes: &str) -> usize {
    let head = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="40">"#;
    dark(&format!(r#"{head}<text x="5" y="25" font-size="20" {attributes}>Standard</text></svg>"#)).0
}

#[test]
fn text_of_every_family_and_weight_is_drawn() {
    let families = [
        "serif",
        "sans-serif",
        "monospace",
        "cursive",
        "fantasy",
        "'No such family', sans-serif",
        "Arial, 'Liberation Sans', Helvetica, sans-serif",
    ];
    let counts = families.map(|family| standard(&format!(r#"font-family="{family}""#)));
    assert!(counts[0] > 300 && counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    let bold = standard(r#"font-weight="bold""#);
    assert!(bold > counts[0] * 6 / 5, "{bold} of {}", counts[0]);
}

#[test]
fn files_say_how_large_they_are_on_paper() {
    let density = |svg: &str| {
        let (bytes, (dark, width)) = (png(svg).expect("a valid SVG"), dark(svg));
        assert!(dark == 0 && &bytes[37..41] == b"pHYs", "{:?}", &bytes[..60]);
        (u32::from_be_bytes([bytes[41], bytes[42], bytes[43], bytes[44]]), width)
    };
    let svg = |size: &str| format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 5" {size}/>"#);
    assert_eq!(density(&svg(r#"width="25.4mm" height="12.7mm""#)), (23_622, 600));
    assert_eq!(density(&svg(r#"width="100" height="50""#)), (7559, 200));
}

#[test]
fn invalid_pictures_are_refused() {
    assert!(matches!(png("<svg"), Err(PictureError::Svg(_))));
    assert!(matches!(png("<html/>"), Err(PictureError::Svg(_))));
    let huge = r#"<svg xmlns="http://www.w3.org/2000/svg" width="9000" height="9000"/>"#;
    assert!(matches!(png(huge), Err(PictureError::TooLarge { width: 18000.0, height: 18000.0 })));
}

#[test]
fn a_page_has_the_size_of_the_picture_and_its_faces_inside() {
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="88mm" height="44mm" viewBox="0 0 338 169">
        <text x="5" y="25" font-family="Arial">Größe</text></svg>"#;
    let file = pdf(svg).expect("a page");
    let file = String::from_utf8_lossy(&file);
    // 88 mm are 249.45 points.
    assert!(file.contains("/MediaBox [0 0 249.4") && file.contains("/FontFile2 "), "{file}");
    assert!(matches!(pdf("<svg"), Err(PictureError::Svg(_))));
}

/// The relative luminance of a colour (WCAG 2.2).
fn luminance(hex: &str) -> f64 {
    let channel = |at: usize| {
        let part = f64::from(u8::from_str_radix(&hex[at..at + 2], 16).unwrap()) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { libm::pow((part + 0.055) / 1.055, 2.4) }
    };
    0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
}

/// The lightness of a colour (CIE 1976), 0 to 100.
fn lightness(hex: &str) -> f64 {
    116.0 * libm::cbrt(luminance(hex)) - 16.0
}

/// The colours of series until they begin again.
fn colours() -> Vec<&'static str> {
    let first = Colour::Series(0).hex();
    let others = (1..100).map(|number| Colour::Series(number).hex()).take_while(|hex| *hex != first);
    std::iter::once(first).chain(others).collect()
}

#[test]
fn marks_have_enough_contrast() {
    let rule = Mark::rule(0.5, "half");
    let svg = svg(vec![Panel::new(Axis::new("Time", "ms"), Axis::new("Pressure", "bar")).with([rule])]);
    let document = Document::parse(&svg).expect("well-formed");
    let letters = document.descendants().filter(|node| node.has_tag_name("text"));
    let letters: BTreeSet<&str> = letters.filter_map(|node| node.attribute("fill")).collect();
    let ink = document.root_element().attribute("fill").expect("a colour of letters");
    assert_eq!((colours().len(), letters.len(), ink), (11, 1, Colour::Reference.hex()));
    for hex in colours().into_iter().chain(letters).chain([ink]) {
        let contrast = 1.05 / (luminance(hex) + 0.05);
        assert!(contrast >= 3.0, "{hex}: {contrast}");
    }
}

#[test]
fn series_differ_in_grey() {
    let of: Vec<f64> = colours().into_iter().map(lightness).collect();
    for (place, a) in of.iter().enumerate() {
        for (other, b) in of.iter().enumerate().take(place) {
            let least = if place < 4 { 10.0 } else { 0.1 };
            assert!((a - b).abs() >= least, "{other} and {place}: {b} and {a}");
        }
    }
    // The series that are next to each other in a bar.
    assert!((of[4] - of[5]).abs() > 10.0);
}

#[test]
fn shades_grow_darker() {
    let lightness = |shade: usize| lightness(Colour::Shade(shade).hex());
    assert!((1..9).all(|shade| lightness(shade) < lightness(shade - 1)));
    assert_eq!(Colour::Shade(usize::MAX).hex(), Colour::Shade(8).hex());
}

#[test]
fn texts_on_paper_have_seven_to_nine_points() {
    let width = |text: &str| text.parse::<PaperWidth>().map(PaperWidth::millimetres);
    assert_eq!(width(" 3.5 in"), Ok(88.9));
    assert_eq!(width("18cm"), Ok(180.0));
    for wrong in ["", "88", "mm", "301mm", "-88mm", "NaNmm", "88 mm mm", "1e400mm"] {
        assert!(width(wrong).unwrap_err().contains("60mm to 300mm"), "{wrong}");
    }
    // Names of rows are above their bars in a column of a journal, as on a phone, and left of them on a page.
    for (paper, beside) in [("88mm", false), ("180mm", true)] {
        let rows = Axis::from_names("", vec!["x1".to_owned()]);
        let bar = series(0).mark(Shape::Bar(Bar::percent(0, Some(40.0), None)));
        let chart = chart(vec![Panel::new(Axis::new("Share", "%"), rows).titled("Total").with([bar])]);
        let svg = chart.svg_at(ChartWidth::Paper(paper.parse().unwrap()));
        let document = Document::parse(&svg).expect("well-formed");
        let root = document.root_element();
        let millimetres: f64 = paper.trim_end_matches("mm").parse().unwrap();
        let px: f64 = root.attribute("viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
        let texts: Vec<_> = root.descendants().filter(|node| node.has_tag_name("text")).collect();
        for text in &texts {
            let points = reading::number(text, "font-size") * millimetres / px / 25.4 * 72.0;
            assert!((7.0..=9.0).contains(&points), "{points} pt: {text:?}");
        }
        let name = texts.iter().find(|text| text.text() == Some("x1")).expect("the name of the row");
        assert_eq!(name.attribute("text-anchor") == Some("end"), beside, "{paper}");
    }
}

/// The glyphs of all texts, with what they stand for.
fn glyphs(group: &Group) -> Vec<(String, bool)> {
    let of = |node: &Node| match node {
        Node::Group(group) => glyphs(group),
        Node::Text(text) => {
            let glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
            glyphs.map(|glyph| (glyph.text.clone(), glyph.id.0 != 0)).collect()
        }
        _ => Vec::new(),
    };
    group.children().iter().flat_map(of).collect()
}

#[test]
fn labels_and_units_of_the_field_are_covered() {
    let needed = "µ·⋅×±−–—…°′″≤≥≠≈∞√∂∑∫→←₀₁₂₃₄₅₆₇₈₉₊₋⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺‘’“”•αβγδεθλμνπρσφωΓΔΘΛΣΦΩÅéöűñ\u{2011}\u{202f}\u{a0}";
    for weight in ["normal", "bold"] {
        let drawn = |text: &str| {
            let text = text.replace('&', "&amp;").replace('<', "&lt;");
            let head =
                format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="900" height="40" font-weight="{weight}">"#);
            glyphs(reading::tree(&format!("{head}<text y=\"20\" font-size=\"9\">{text}</text></svg>")).root())
        };
        let all: String = needed.chars().chain('!'..='~').collect();
        let missing: Vec<String> = drawn(&all).into_iter().filter(|(_, known)| !known).map(|(text, _)| text).collect();
        assert!(missing.is_empty(), "{weight}: {missing:?}");
        assert!(drawn(&all).len() > 150);
        assert_eq!(drawn("粒"), [("粒".to_owned(), false)]);
    }
}
