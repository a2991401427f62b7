//! Reads a chart's SVG back, for tests.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::Pixmap;
use resvg::usvg::fontdb::Database;
use resvg::usvg::roxmltree::{Document, Node};
use resvg::usvg::{Options, Tree};

use super::{Chart, ChartWidth, png};

/// The faces of the charts.
static FACES: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut faces = Database::new();
    for face in [
        &include_bytes!("../../../fonts/ApportionSans-Regular.ttf")[..],
        include_bytes!("../../../fonts/ApportionSans-Bold.ttf"),
    ] {
        faces.load_font_data(face.to_vec());
    }
    faces.set_sans_serif_family("Apportion Sans");
    Arc::new(faces)
});

/// Reads an SVG with the faces of the charts.
pub(super) fn tree(svg: &str) -> Tree {
    let options = Options { font_family: "Apportion Sans".to_owned(), fontdb: FACES.clone(), ..Options::default() };
    Tree::from_str(svg, &options).expect("an SVG")
}

/// Width of a line of digits, points, spaces and minus signs in Arial at `size`, px.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let units = |c: char| match c {
        '0'..='9' => 1139.0,
        '.' | ' ' => 569.0,
        'W' => 1933.0,
        '…' => 2048.0,
        '\u{2212}' => 1196.0,
        _ => panic!("no width of {c:?}"),
    };
    text.chars().map(units).sum::<f64>() / 2048.0 * size
}

/// The rectangle of the first plot of lines or points as (left, top, right, bottom), px.
pub(super) fn plot(document: &Document) -> [f64; 4] {
    let lines = groups(document, "axis-lines")[0];
    let lines: Vec<Node> = lines.children().filter(Node::is_element).collect();
    [number(&lines[0], "x1"), number(&lines[0], "y1"), number(&lines[1], "x2"), number(&lines[0], "y2")]
}

/// The texts of a size below a node, with their nodes.
pub(super) fn texts_of_size<'a, 'i>(node: Node<'a, 'i>, size: &str) -> Vec<(Node<'a, 'i>, &'a str)> {
    let texts = node.descendants().filter(|n| n.has_tag_name("text") && n.attribute("font-size") == Some(size));
    texts.map(|n| (n, n.text().unwrap_or_default())).collect()
}

/// The groups of a class, in order.
pub(super) fn groups<'a, 'i>(document: &'a Document<'i>, class: &str) -> Vec<Node<'a, 'i>> {
    document.descendants().filter(|node| node.attribute("class") == Some(class)).collect()
}

/// A numeric attribute.
pub(super) fn number(node: &Node, name: &str) -> f64 {
    node.attribute(name).and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("no {name} in {node:?}"))
}

/// The numbers of path data, for any commands.
pub(super) fn path_numbers(node: &Node) -> Vec<f64> {
    let data = node.attribute("d").expect("a path");
    data.split(|c: char| c.is_ascii_alphabetic() || c == ' ').filter_map(|part| part.parse().ok()).collect()
}

/// All drawn texts below a node, or of the whole document.
pub(super) fn texts<'a>(node: Node<'a, '_>) -> Vec<&'a str> {
    node.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect()
}

/// The line through labelled ticks of a vertical axis: height of zero and px per unit.
pub(super) fn y_axis(axis: &Node) -> (f64, f64) {
    let ticks: Vec<(f64, f64)> = axis
        .descendants()
        .filter(|node| node.has_tag_name("text"))
        .map(|node| {
            let label = node.text().expect("a label").replace('\u{2212}', "-");
            // The baseline lies a fixed length below the tick: it cancels in differences.
            (label.parse().expect("a number"), number(&node, "y"))
        })
        .collect();
    let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
    let scale = (first.1 - last.1) / (last.0 - first.0);
    let zero = axis.descendants().filter(|n| n.has_tag_name("line")).map(|n| number(&n, "y1")).next();
    (zero.expect("a grid line") + first.0 * scale, scale)
}

/// The same of a horizontal axis: place of zero and px per unit.
pub(super) fn x_axis(axis: &Node) -> (f64, f64) {
    let ticks: Vec<(f64, f64)> = axis
        .descendants()
        .filter(|node| node.has_tag_name("text"))
        .filter_map(|node| Some((node.text()?.replace('\u{2212}', "-").parse().ok()?, number(&node, "x"))))
        .collect();
    let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
    let scale = (last.1 - first.1) / (last.0 - first.0);
    (first.1 - first.0 * scale, scale)
}

/// Dark pixels of the PNG in a band of heights given in px of the SVG.
pub(super) fn dark_pixels(svg: &str, from: f64, to: f64) -> usize {
    let picture = png(svg).expect("a picture");
    let pixels = Pixmap::decode_png(&picture).expect("a PNG");
    let document = Document::parse(svg).expect("well-formed");
    let root = document.root_element();
    assert_eq!(f64::from(pixels.width()), 2.0 * number(&root, "width"));
    assert_eq!(f64::from(pixels.height()), 2.0 * number(&root, "height"));
    let rows = (2.0 * from) as u32..(2.0 * to) as u32;
    let dark = |x: u32, y: u32| pixels.pixel(x, y).is_some_and(|p| p.red().max(p.green()).max(p.blue()) < 90);
    rows.map(|y| (0..pixels.width()).filter(|&x| dark(x, y)).count()).sum()
}

/// The smallest rectangle that holds every mark and letter, as (left, top, right, bottom), px, and the size of the
/// view.
fn extent(svg: &str) -> ([f32; 4], [f32; 2]) {
    let tree = tree(svg);
    let bounds = tree.root().abs_bounding_box();
    let size = tree.size();
    ([bounds.left(), bounds.top(), bounds.right(), bounds.bottom()], [size.width(), size.height()])
}

/// Asserts that a phone's drawing is 360 px wide and that nothing sticks out of it, as a document and on a page.
#[track_caller]
pub(super) fn assert_narrow(chart: &Chart) {
    let inline = chart.inline(ChartWidth::Narrow, "narrow");
    let root = inline.split('>').next().expect("a root");
    assert!(root.contains("role=\"img\"") && root.contains("aria-label=") && !root.contains(" width="), "{root}");
    for svg in [chart.svg_at(ChartWidth::Narrow), inline] {
        let ([left, top, right, bottom], [width, height]) = extent(&svg);
        assert_eq!(width, 360.0);
        // 0.01 px: single precision.
        let inside = left >= -0.01 && top >= -0.01 && right <= width + 0.01 && bottom <= height + 0.01;
        assert!(inside, "{left} {top} {right} {bottom} in {width} x {height}: {svg}");
        assert!(only_finite(&Document::parse(&svg).expect("well-formed")));
    }
}

/// Whether no attribute holds a number that is not finite.
pub(super) fn only_finite(document: &Document) -> bool {
    let mut attributes = document.descendants().flat_map(|node| node.attributes());
    attributes.all(|attribute| !["NaN", "inf"].iter().any(|bad| attribute.value().contains(bad)))
}
