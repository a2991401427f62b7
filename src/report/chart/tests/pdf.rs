//! The PDF of a chart, taken apart again.

use super::super::{Axis, Bar, Chart, ChartWidth, Colour, FilmStrip, Look, Panel, Series, Shape, pdf};

/// The body of the objects that have all of `marks` in their dictionaries, streams unpacked.
fn objects(file: &[u8], marks: &[&str]) -> Vec<(String, Vec<u8>)> {
    let find = |from: usize, what: &[u8]| file[from..].windows(what.len()).position(|w| w == what).map(|at| from + at);
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(start) = find(from, b" 0 obj") {
        let end = find(start, b"endobj").expect("an end");
        let stream = find(start, b"stream\n").filter(|at| *at < end);
        let head = String::from_utf8_lossy(&file[start..stream.unwrap_or(end)]).into_owned();
        let body = stream.map_or_else(Vec::new, |at| {
            miniz_oxide::inflate::decompress_to_vec_zlib(&file[at + 7..end]).expect("packed by zlib")
        });
        if marks.iter().all(|mark| head.contains(mark)) {
            found.push((head, body));
        }
        from = end;
    }
    found
}

fn chart(name: &str) -> Chart {
    let bar = |row, to| {
        let bar = Bar { row, to, interval: Some((to - 0.1, to + 0.1)), label: "0.50".to_owned(), ..Bar::default() };
        Series::new("effect of F_cr", Colour::Series(0)).mark(Shape::Bar(bar))
    };
    let rows = Axis::from_names("", vec![name.to_owned(), "x2".to_owned()]);
    Chart::new("Bars & more", "Seen.")
        .panels([Panel::new(Axis::new("index", "µm"), rows).with([bar(0, 0.5), bar(1, 0.2)])])
}

#[test]
fn a_page_has_the_size_of_the_picture_and_its_faces_inside() {
    let width = ChartWidth::Paper("88mm".parse().expect("a width"));
    let svg = chart("thickness").svg_at(width).expect("a figure");
    let file = pdf(&svg).expect("a page");
    assert_eq!(file, pdf(&svg).expect("a page"), "the same bytes");
    let page = &objects(&file, &["/Type /Page\n"])[0].0;
    let bounds: Vec<f64> = page
        .split("/MediaBox [")
        .nth(1)
        .expect("a size")
        .split(']')
        .next()
        .expect("an end")
        .split(' ')
        .map(|number| number.parse().expect("a number"))
        .collect();
    let points = 88.0 / 25.4 * 72.0;
    assert!((bounds[2] - points).abs() < 0.01 && bounds[3] > 20.0 && bounds[..2] == [0.0, 0.0], "{bounds:?}");
    let faces = objects(&file, &["/Length1"]);
    // Letters of these are all regular.
    assert_eq!(faces.len(), 1);
    for (_, face) in &faces {
        assert_eq!(face[..4], [0, 1, 0, 0], "TrueType");
        assert!(face.len() < 20_000, "a subset, not {} bytes", face.len());
    }
    let descriptor = &objects(&file, &["/FontDescriptor", "/FontFile2"])[0].0;
    assert!(descriptor.contains("+ApportionSans-Regular"), "{descriptor}");
    assert!(String::from_utf8_lossy(&file).contains("(Bars & more)"));
}

#[test]
fn texts_can_be_read_back() {
    let file = pdf(&chart("Größe").svg().expect("a figure")).expect("a page");
    // Both faces: the title is bold.
    let maps = objects(&file, &["/Type /CMap"]);
    assert_eq!(maps.len(), 2);
    let regular = String::from_utf8_lossy(&maps[0].1).into_owned();
    for letter in "GrößeFcrµm05.".chars() {
        assert!(regular.contains(&format!("<{:04X}>", letter as u32)), "{letter}: {regular}");
    }
    let drawn = objects(&file, &["/Filter /FlateDecode"])
        .into_iter()
        .find(|(head, _)| !head.contains("/Type") && !head.contains("/Length1"));
    let drawn = String::from_utf8_lossy(&drawn.expect("the drawing").1).into_owned();
    assert!(drawn.contains(" TJ") && drawn.contains("/F0 1 Tf") && drawn.contains("/F1 1 Tf"), "{drawn}");
    // Neither pixels nor numbers that are none.
    assert!(!String::from_utf8_lossy(&file).contains("/Image") && !drawn.contains("NaN") && !drawn.contains("inf"));
}

#[test]
fn pictures_are_cut_off_at_their_frames() {
    let strip = FilmStrip {
        title: "Frames".to_owned(),
        caption: String::new(),
        description: String::new(),
        frames: vec![("one".to_owned(), String::new()), ("two".to_owned(), String::new())],
        columns: (2, 2),
        aspect: 0.5,
    };
    let strip = strip.chart(|_, sketch| {
        sketch.circle((0.0, 0.0), 50.0, Look::area("#000000"));
        sketch.text("F_T", (20.0, 20.0), false);
    });
    let file = pdf(&strip.svg().expect("a strip")).expect("a page");
    let drawn = objects(&file, &["/Filter /FlateDecode"])
        .into_iter()
        .map(|(_, body)| String::from_utf8_lossy(&body).into_owned());
    let drawn = drawn.into_iter().find(|body| body.contains(" TJ")).expect("the drawing");
    assert_eq!(drawn.matches("W\nn\n").count(), 2, "{drawn}");
}

#[test]
fn what_charts_do_not_have_is_refused() {
    let svg = |body: &str| format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">{body}</svg>"#);
    let said = |body: &str| pdf(&svg(body)).expect_err("refused").to_string();
    assert!(said(r#"<g opacity="0.5"><path d="M0 0h5v5z"/><path d="M2 2h5v5z"/></g>"#).contains("opacity of a group"));
    let gradient = r#"<linearGradient id="a"><stop stop-color="red"/><stop offset="1"/></linearGradient>
        <rect width="5" height="5" fill="url(#a)"/>"#;
    assert!(said(gradient).contains("gradient"));
    assert!(pdf("<svg").expect_err("no XML").to_string().contains("well-formed"));
    let large = r#"<svg xmlns="http://www.w3.org/2000/svg" width="30000" height="10"/>"#;
    assert!(pdf(large).expect_err("too large").to_string().contains("at most 14400"));
}
