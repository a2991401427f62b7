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

/// The points of the paths of the first series.
fn drawn(marks: Vec<Mark>) -> Vec<Vec<(f64, f64)>> {
    let svg = svg(vec![panel(marks)]);
    let document = Document::parse(&svg).expect("well-formed");
    let paths = groups(&document, "series")[0].children().filter(|node| node.has_tag_name("path"));
    let points = |numbers: Vec<f64>| numbers.chunks_exact(2).map(|point| (point[0], point[1])).collect();
    paths.map(|path| points(path_numbers(&path))).collect()
}

#[test]
fn a_straight_run_keeps_its_ends_and_a_peak_stays() {
    let mut run: Vec<(f64, f64)> = (0..1000).map(|i| (f64::from(i), 3.0)).collect();
    assert_eq!(drawn(vec![series(0).line(run.clone())]).iter().map(Vec::len).collect::<Vec<_>>(), [2]);
    run[500].1 = 4.0;
    let line = &drawn(vec![series(0).line(run.clone())])[0];
    assert_eq!(line.len(), 5);
    let ends = (line[0].0, line[4].0);
    assert!((line[2].0 - ends.0 - 500.0 / 999.0 * (ends.1 - ends.0)).abs() < 0.02 && line[2].1 < line[0].1 - 200.0);
    assert_eq!(drawn(vec![series(0).line(run[..1].to_vec())]).len(), 1);
}

#[test]
fn a_band_is_closed_over_its_upper_edge() {
    let svg = svg(vec![panel(vec![series(0).band(vec![(0.0, 0.0, 1.0), (2.0, 0.0, 1.0)])])]);
    let document = Document::parse(&svg).expect("well-formed");
    let band = groups(&document, "band")[0];
    let data = band.attribute("d").expect("a path");
    let numbers = path_numbers(&band);
    let [x0, low0, x1, low1, x2, high1, x3, high0] = numbers[..] else { panic!("{data}") };
    assert!(x0 == x3 && x1 == x2 && x0 < x1 && low0 == low1 && high0 == high1 && high0 < low0, "{data}");
    let letters: String = data.chars().filter(char::is_ascii_alphabetic).collect();
    assert_eq!(letters, "MLLLZ");
}

#[test]
fn coordinates_are_short() {
    let points = (0..50).map(|i| (f64::from(i) / 7.0, libm::sin(f64::from(i)))).collect();
    let svg = svg(vec![panel(vec![series(0).stroke(Stroke::SolidWithPoints).line(points)])]);
    let document = Document::parse(&svg).expect("well-formed");
    for node in document.descendants() {
        for name in ["x", "y", "x1", "x2", "y1", "y2", "width", "height", "d", "transform"] {
            let value = node.attribute(name).unwrap_or_default();
            for number in value.split(|c: char| c.is_ascii_alphabetic() || " ()".contains(c)) {
                let decimals = number.split_once('.').map_or("1", |(_, decimals)| decimals);
                assert!(decimals.len() <= 2 && !decimals.ends_with('0') && number != "-0", "{name}=\"{value}\"");
            }
        }
    }
}

proptest! {
    /// Both axes have about 1 px per unit, so no half of a pixel holds more than four of the points.
    #[test]
    fn every_point_stays_by_the_straightened_line(run in prop::collection::vec(0.0..0.3, 2..60)) {
        let run: Vec<(f64, f64)> = (0..).zip(&run).map(|(i, y)| (0.3 * f64::from(i), *y)).collect();
        let frame = Series::new("", Colour::Reference).line(vec![(0.0, 0.0), (640.0, 300.0)]);
        let paths = drawn(vec![series(0).stroke(Stroke::SolidWithPoints).line(run.clone()), frame]);
        let (kept, points) = paths.split_first().expect("a line");
        prop_assert_eq!(points.len(), run.len());
        for point in points {
            let near = kept.windows(2).map(|ends| distance(point[0], ends[0], ends[1])).fold(f64::INFINITY, f64::min);
            // 0.05 px, and two coordinates of two decimals.
            prop_assert!(near <= 0.05 + 0.015, "{:?} is {} px off", point, near);
        }
    }
}

/// The distance of a point from a segment.
fn distance(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 { ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    libm::hypot(p.0 - a.0 - along * dx, p.1 - a.1 - along * dy)
}
