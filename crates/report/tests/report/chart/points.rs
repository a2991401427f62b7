//! Clouds of dots and labelled points.

use resvg::usvg::roxmltree::Document;

use super::reading::{groups, number, path_numbers, plot, texts, width, y_axis};
use super::*;

fn panel(dots: Vec<(f64, f64)>) -> Panel {
    let mean = Series::new("mean", Colour::Reference);
    let marks = [
        Series::new("model run", Colour::Series(0)).mark(Shape::Dots(dots)),
        mean.band(vec![(0.0, 9.0, 11.0), (10.0, 18.0, 22.0)]),
        mean.line(vec![(0.0, 10.0), (10.0, 20.0)]),
    ];
    Panel::new(Axis::new("first", "um"), Axis::new("output", "m")).titled("S1 0.34, ST 0.69").with(marks)
}

#[test]
fn dots_are_seen_in_the_picture() {
    let dots = Series::new("", Colour::Reference).mark(Shape::Dots(vec![(0.0, 0.0), (5.0, 5.0), (10.0, 10.0)]));
    let panel = Panel::new(Axis::new("x", ""), Axis::new("y", "")).with([dots]);
    let with = Chart::new("", "Dots.").panels([panel]).svg();
    // Without dots the axes would be others: here they are there, but no path.
    let without = with.replace("h0", "");
    let height = number(&Document::parse(&with).expect("well-formed").root_element(), "height");
    // Dark pixels once the dots are as dark as ink.
    let visible = |svg: &str| dark_pixels(&svg.replace("stroke-opacity=\"0.6\"", ""), 0.0, height);
    assert!(visible(&with) > visible(&without), "round ends of lines of no length are drawn");
}

#[test]
fn thousands_of_dots_make_a_small_file() {
    let dots = (0..2000).map(|i| (libm::sin(f64::from(i)), libm::cos(f64::from(i)))).collect();
    let svg = svg(vec![panel(dots)]);
    // At most "M123.4 123.4h0" for each, and the rest of the figure.
    assert!(svg.len() < 2000 * 14 + 6000, "{}", svg.len());
}

fn labelled(points: Vec<Point>) -> Panel {
    let monotone = Series::new("monotone", Colour::Series(0));
    let points = points.into_iter().map(|point| monotone.mark(Shape::Point(point)));
    Panel::new(Axis::new("μ*", "nN"), Axis::new("σ", "nN")).with(points)
}

fn point(x: f64, y: f64, label: &str) -> Point {
    Point { x, y, label: label.to_owned() }
}

#[test]
fn points_are_at_their_values() {
    let points = vec![point(40.0, 20.0, "first"), point(10.0, 20.0, "second"), point(f64::NAN, 1.0, "none")];
    let svg = svg(vec![labelled(points)]);
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let series = groups(&document, "series")[0];
    let drawn: Vec<Vec<f64>> = series.children().filter(|n| n.has_tag_name("path")).map(|n| path_numbers(&n)).collect();
    assert_eq!(drawn.len(), 2);
    // Tick labels give the scale to 1e-3.
    assert!((zero - drawn[0][1] - 20.0 * scale).abs() < 0.02 + 1e-3 * 20.0 * scale);
    assert_eq!(texts(groups(&document, "labels")[0]), ["first", "second"]);
}

#[test]
fn labels_of_any_length_stay_inside_on_a_phone() {
    let long = "the name of a factor that leaves no room for anything else";
    let points = vec![point(40_000.0, 20.0, long), point(10.0, 20_000.0, "second"), point(40_000.0, 20_000.0, "width")];
    assert_narrow(&chart(vec![labelled(points)]));
}

/// The label of a point as drawn, px.
#[derive(Clone, Copy, Debug)]
struct Label {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// A plot of points with labels, px.
struct Drawn {
    labels: Vec<Label>,
    points: Vec<(f64, f64)>,
    /// Left, top, right, bottom.
    plot: [f64; 4],
    /// Number of thin lines from points to labels.
    lines: usize,
}

/// Draws points with this label, a number, on a phone.
fn drawn(points: &[(f64, f64)], name: &str) -> Drawn {
    // Points at two corners have no label and keep the axes.
    let corners = [point(0.0, 0.0, ""), point(300.0, 200.0, "")];
    let points = points.iter().map(|&(x, y)| point(x, y, name)).chain(corners).collect();
    let svg = chart(vec![labelled(points)]).svg_at(ChartWidth::Narrow);
    let document = Document::parse(&svg).expect("well-formed");
    let group = groups(&document, "labels")[0];
    let label = |text| {
        let (x, y) = (number(&text, "x"), number(&text, "y"));
        let half = width(text.text().unwrap(), 10.5) / 2.0;
        // Capital letters have 0.688 of the size.
        Label { left: x - half, right: x + half, top: y - 0.688 * 10.5, bottom: y }
    };
    let of_kind = |kind| group.descendants().filter(move |node| node.has_tag_name(kind));
    let paths = groups(&document, "series")[0].children().filter(|node| node.has_tag_name("path"));
    Drawn {
        labels: of_kind("text").map(label).collect(),
        points: paths.map(|path| path_numbers(&path)).map(|numbers| (numbers[0], numbers[1])).collect(),
        plot: plot(&document),
        lines: of_kind("line").count(),
    }
}

#[test]
fn a_single_label_is_right_of_its_point_or_left_at_the_edge() {
    let Drawn { labels, points, .. } = drawn(&[(100.0, 100.0)], "1234567");
    let (label, (x, y)) = (labels[0], points[0]);
    assert!((label.left - x - 6.0).abs() < 0.02 && ((label.top + label.bottom) / 2.0 - y).abs() < 0.02, "{label:?}");
    let Drawn { labels, points, lines, .. } = drawn(&[(295.0, 100.0)], "12345678901234");
    assert!(labels[0].right < points[0].0 && lines == 0, "{labels:?}");
}

proptest! {
    #[test]
    fn labels_do_not_overlap(points in prop::collection::vec((5.0..295.0, 5.0..195.0), 1..40)) {
        let Drawn { labels, points, plot: [left, top, right, bottom], .. } = drawn(&points, "1234567");
        // A margin of 1.5 px, and coordinates of two decimals.
        let air = 1.5 - 0.011;
        for (i, label) in labels.iter().enumerate() {
            let inside = label.left >= left && label.right <= right + 2.0 && label.top >= top && label.bottom <= bottom;
            prop_assert!(inside, "{:?}", label);
            let overlaps = |other: &Label| {
                label.left - air < other.right + air
                    && other.left - air < label.right + air
                    && label.top - air < other.bottom + air
                    && other.top - air < label.bottom + air
            };
            prop_assert!(!labels[..i].iter().any(overlaps), "{labels:?}");
            let covers = |&(x, y): &(f64, f64)| {
                label.left - air < x && x < label.right + air && label.top - air < y && y < label.bottom + air
            };
            prop_assert!(!points.iter().any(covers), "{label:?} covers a point");
        }
    }
}
