//! Lines, bands and rules.

use resvg::usvg::roxmltree::{Document, Node};

use super::reading::{groups, path_numbers, y_axis};
use super::*;

fn panel(marks: Vec<Mark>) -> Panel {
    Panel::new(Axis::new("Time", "ms"), Axis::new("Pressure", "bar")).titled("Force").with(marks)
}

/// The paths of a class of groups, as numbers.
fn paths(document: &Document, class: &str) -> Vec<Vec<f64>> {
    let inside = |group: Node| {
        let paths = group.children().filter(|n| n.has_tag_name("path"));
        paths.map(|path| path_numbers(&path)).collect::<Vec<_>>()
    };
    groups(document, class).into_iter().flat_map(inside).collect()
}

#[test]
fn points_are_at_their_values_and_gaps_stay_open() {
    let points =
        vec![(0.0, 10.0), (1.0, 30.0), (2.0, f64::NAN), (3.0, 20.0), (4.0, f64::INFINITY), (5.0, 5.0), (6.0, 40.0)];
    let svg = svg(vec![panel(vec![series(0).line(points)])]);
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let drawn = paths(&document, "series");
    // Two lines and, between two gaps, a separate point.
    assert_eq!(drawn.len(), 3);
    // 0.02 px: two coordinates of two decimals.
    let near = |y: f64, value: f64| (zero - y - value * scale).abs() < 0.02 + 1e-3 * value * scale;
    assert!(near(drawn[0][1], 10.0) && near(drawn[0][3], 30.0));
    assert!(near(drawn[1][1], 20.0));
    assert!(near(drawn[2][1], 5.0) && near(drawn[2][3], 40.0));
    // Equal steps in time are equal steps in px, up to rounding.
    let step = drawn[0][2] - drawn[0][0];
    assert!((drawn[1][0] - drawn[0][0] - 3.0 * step).abs() < 0.03);
    assert!((drawn[2][2] - drawn[0][0] - 6.0 * step).abs() < 0.06);
}

#[test]
fn logarithmic_axes_leave_out_what_has_no_logarithm() {
    let error = series(1).stroke(Stroke::SolidWithPoints);
    let line = error.line(vec![(1.0, 1.0), (10.0, 0.1), (100.0, 0.0), (1000.0, 1e-3)]);
    let band = error.band(vec![(1.0, 0.5, 2.0), (10.0, 0.0, 0.2), (1000.0, 5e-4, 2e-3)]);
    let axis = |label: &str| Axis::new(label, "").spaced(Spacing::Logarithmic);
    let svg = svg(vec![Panel::new(axis("rows"), axis("error")).with([band, line])]);
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(groups(&document, "point").len(), 3 + 1, "three points and the legend's");
    assert_eq!(groups(&document, "band").len(), 2);
    // One decade in x, one in y: both steps from the first point to the second and on to the last.
    let drawn = paths(&document, "series");
    let (first, second, last) = ((drawn[0][0], drawn[0][1]), (drawn[0][2], drawn[0][3]), (drawn[3][0], drawn[3][1]));
    assert!((last.0 - first.0 - 3.0 * (second.0 - first.0)).abs() < 0.05);
    assert!((last.1 - first.1 - 3.0 * (second.1 - first.1)).abs() < 0.05);
}

#[test]
fn long_lines_stay_small_files() {
    let points = (0..200_000).map(|i| f64::from(i) * 1e-3).map(|t| (t, libm::sin(7.0 * t))).collect();
    let svg = svg(vec![panel(vec![series(0).line(points)])]);
    // 640 px of plot, at most eight points in each.
    assert!(svg.len() < 100_000, "{}", svg.len());
}
