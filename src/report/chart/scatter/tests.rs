use resvg::usvg::roxmltree::Document;

use super::super::Chart;
use super::super::reading::{assert_narrow, groups, number, only_finite, path_numbers, texts, y_axis};
use super::*;
use proptest::prelude::*;

fn chart(points: Vec<ScatterPoint>, guides: &[f64]) -> ScatterChart {
    let axis = |label: &str| Axis { label: label.to_owned(), unit: "nN".to_owned(), ..Axis::default() };
    ScatterChart {
        title: "Screening".to_owned(),
        caption: "The thickness matters most.".to_owned(),
        x: axis("μ*"),
        y: axis("σ"),
        series: vec![ScatterSeries { name: "monotone".to_owned(), role: Role::Other(0), points }],
        guides: guides.iter().map(|&slope| Guide { slope, label: format!("σ = {slope} μ*") }).collect(),
    }
}

fn point(x: f64, y: f64, label: &str) -> ScatterPoint {
    ScatterPoint { x, y, label: label.to_owned(), ..ScatterPoint::default() }
}

#[test]
fn points_stand_at_their_values_and_guides_run_through_them() {
    let points = vec![point(40.0, 20.0, "thickness"), point(10.0, 20.0, "length"), point(f64::NAN, 1.0, "none")];
    let svg = chart(points, &[0.5, 2.0]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let series = groups(&document, "series")[0];
    let drawn: Vec<Vec<f64>> = series.children().filter(|n| n.has_tag_name("path")).map(|n| path_numbers(&n)).collect();
    assert_eq!(drawn.len(), 2);
    // Tick labels give the scale to 1e-3.
    assert!((zero - drawn[0][1] - 20.0 * scale).abs() < 0.02 + 1e-3 * 20.0 * scale);
    // Each guide passes through one of the points: on it, the same share of both sides.
    let lines = groups(&document, "guides")[0].descendants().filter(|n| n.has_tag_name("line")).collect::<Vec<_>>();
    for (line, point) in lines.iter().zip(&drawn) {
        let (x1, y1) = (number(line, "x1"), number(line, "y1"));
        let part = (point[0] - x1) / (number(line, "x2") - x1);
        assert!((y1 + part * (number(line, "y2") - y1) - point[1]).abs() < 0.1);
    }
    assert_eq!(texts(groups(&document, "labels")[0]), ["thickness", "length"]);
    assert_eq!(texts(groups(&document, "guides")[0]), ["σ = 0.5 μ*", "σ = 2 μ*"]);
}

#[test]
fn intervals_are_thin_lines_through_their_points() {
    let interval = ScatterPoint {
        x_interval: Some((30.0, 60.0)),
        y_interval: Some((5.0, 25.0)),
        ..point(40.0, 20.0, "thickness")
    };
    let none = ScatterPoint { x_interval: Some((f64::NAN, 1.0)), ..point(10.0, 10.0, "length") };
    let svg = chart(vec![interval, none], &[1.0]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let (whiskers, points) = (groups(&document, "whisker"), groups(&document, "point"));
    assert_eq!(whiskers.len(), 1);
    // M from y H to M x from V to; the first point is the legend's.
    let (drawn, point) = (path_numbers(&whiskers[0]), path_numbers(&points[1]));
    assert_eq!((drawn[1], drawn[3]), (point[1], point[0]));
    assert!((drawn[2] - drawn[0] - 3.0 * (point[0] - drawn[0])).abs() < 0.05, "30 to 60 about 40");
    for (end, value) in [(drawn[4], 5.0), (drawn[5], 25.0)] {
        assert!((zero - end - value * scale).abs() < 0.02 + 1e-3 * value * scale);
    }
}

#[test]
fn a_phone_shows_everything_inside() {
    let long = "the name of a factor that leaves no room for anything else";
    let points = vec![point(40_000.0, 20.0, long), point(10.0, 20_000.0, "length"), point(40_000.0, 20_000.0, "width")];
    for slopes in [&[][..], &[0.1, 0.5, 1.0, 1e3]] {
        assert_narrow(&Chart::Scatter(chart(points.clone(), slopes)));
    }
}

#[test]
fn nothing_to_show_is_said_and_no_series_refused() {
    let svg = chart(Vec::new(), &[1.0]).svg().expect("a figure");
    assert!(texts(Document::parse(&svg).expect("well-formed").root()).contains(&"no value"));
    let empty = ScatterChart { series: Vec::new(), ..chart(Vec::new(), &[]) };
    assert!(matches!(empty.svg(), Err(ChartError::NoPanels { .. })));
}

#[test]
fn a_guide_of_any_slope_and_label_stays_inside() {
    for slope in [-1.85e306, f64::MAX, f64::MIN_POSITIVE, 0.0, f64::NAN, f64::INFINITY] {
        let svg = chart(vec![point(1.0, 1.0, "a")], &[slope]).svg().expect("a figure");
        assert!(only_finite(&Document::parse(&svg).expect("well-formed")), "{slope}");
    }
}

proptest! {
    #[test]
    fn any_numbers_and_names_make_a_chart(
        points in prop::collection::vec((any::<f64>(), any::<f64>(), any::<String>()), 0..6), slope in any::<f64>(),
    ) {
        let points = points.into_iter().map(|(x, y, label)| ScatterPoint { x, y, label, x_interval: Some((y, x)), y_interval: Some((x, y)) }).collect();
        let svg = chart(points, &[slope]).svg().expect("a figure");
        prop_assert!(only_finite(&Document::parse(&svg).expect("well-formed")));
    }
}
