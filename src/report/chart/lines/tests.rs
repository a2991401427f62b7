use resvg::usvg::roxmltree::{Document, Node};

use super::super::Chart;
use super::super::reading::{assert_narrow, dark_pixels, groups, only_finite, path_numbers, texts, y_axis};
use super::*;
use proptest::prelude::*;

fn axis(label: &str, unit: &str, spacing: Spacing) -> Axis {
    Axis { label: label.to_owned(), unit: unit.to_owned(), spacing }
}

fn line(name: &str, role: Role, points: Vec<(f64, f64)>) -> LineSeries {
    LineSeries { name: name.to_owned(), role, stroke: Stroke::Solid, points, band: Vec::new() }
}

fn panel(series: Vec<LineSeries>) -> LinePanel {
    LinePanel { title: "Force".to_owned(), y: axis("Force", "nN", Spacing::Linear), series, markers: Vec::new() }
}

fn chart(panels: Vec<LinePanel>) -> LineChart {
    LineChart {
        names: Vec::new(),
        title: "A push in time".to_owned(),
        caption: "Force until the particle slides.".to_owned(),
        x: axis("Time", "ms", Spacing::Linear),
        panels,
    }
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
fn points_stand_at_their_values_and_gaps_stay_open() {
    let points =
        vec![(0.0, 10.0), (1.0, 30.0), (2.0, f64::NAN), (3.0, 20.0), (4.0, f64::INFINITY), (5.0, 5.0), (6.0, 40.0)];
    let svg = chart(vec![panel(vec![line("Coulomb", Role::Coulomb, points)])]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let drawn = paths(&document, "series");
    // Two lines and, between two gaps, a point of its own.
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
fn panels_share_the_horizontal_axis_and_the_legend() {
    let short = line("Coulomb", Role::Coulomb, vec![(0.0, 1.0), (10.0, 2.0)]);
    let long = line("Coulomb", Role::Coulomb, vec![(0.0, 1.0), (20.0, 2.0)]);
    let mut upper = panel(vec![short]);
    upper.markers =
        vec![Marker { x: 10.0, label: "critical time".to_owned() }, Marker { x: f64::NAN, label: "never".to_owned() }];
    let svg = chart(vec![upper, panel(vec![long])]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(texts(groups(&document, "legend")[0]), ["Coulomb"]);
    let axes = groups(&document, "x-axis");
    assert_eq!(axes.len(), 1);
    assert_eq!(texts(axes[0]).last(), Some(&"Time (ms)"));
    let drawn = paths(&document, "series");
    assert_eq!(drawn[0][0], drawn[1][0]);
    let half = (drawn[1][0] + drawn[1][2]) / 2.0;
    assert!((drawn[0][2] - half).abs() < 0.02);
    let markers = groups(&document, "markers");
    assert_eq!(texts(markers[0]), ["critical time"]);
    let pole = markers[0].descendants().find(|n| n.has_tag_name("line")).and_then(|n| n.attribute("x1")?.parse().ok());
    assert_eq!(pole, Some(drawn[0][2]));
}

#[test]
fn logarithmic_axes_leave_out_what_has_no_logarithm() {
    let mut figure = chart(vec![panel(vec![line(
        "error",
        Role::Other(0),
        vec![(1.0, 1.0), (10.0, 0.1), (100.0, 0.0), (1000.0, 1e-3)],
    )])]);
    figure.x.spacing = Spacing::Logarithmic;
    figure.panels[0].y.spacing = Spacing::Logarithmic;
    figure.panels[0].series[0].stroke = Stroke::SolidWithPoints;
    figure.panels[0].series[0].band = vec![(1.0, 0.5, 2.0), (10.0, 0.0, 0.2), (1000.0, 5e-4, 2e-3)];
    let svg = figure.svg().expect("a figure");
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
fn a_phone_shows_everything_inside() {
    let series = |name: &str, points: Vec<(f64, f64)>| LineSeries {
        stroke: Stroke::SolidWithPoints,
        ..line(name, Role::Other(1), points)
    };
    let name = "whole range, where the ends are not the extremes of what is shown in the picture";
    let mut one = panel(vec![series(name, vec![(64.0, -12_345.0), (1e6, 98_765.0)])]);
    one.title = "Half widths of the intervals of the total indices and of those of first order".to_owned();
    let mark = |x: f64| Marker { x, label: "97.5 % of all values lie below 1234.5".to_owned() };
    one.markers = vec![mark(64.0), mark(80.0), mark(5e5), mark(1e6)];
    for spacing in [Spacing::Linear, Spacing::Logarithmic] {
        for panels in [1, 3] {
            let mut figure = chart(vec![one.clone(); panels]);
            figure.x = axis("Angle of the tip force from the vertical, and of what else there may be", "°", spacing);
            figure.title = "A headline that takes more than a line on a phone, as most of them do".to_owned();
            assert_narrow(&Chart::Lines(figure));
        }
    }
}

#[test]
fn long_series_stay_small_files() {
    let points = (0..200_000).map(|i| f64::from(i) * 1e-3).map(|t| (t, (7.0 * t).sin())).collect();
    let svg = chart(vec![panel(vec![line("LuGre", Role::LuGre, points)])]).svg().expect("a figure");
    // 640 px of plot, at most eight points in each.
    assert!(svg.len() < 100_000, "{}", svg.len());
}

#[test]
fn nothing_to_show_is_said_and_no_panel_refused() {
    let svg = chart(vec![panel(vec![line("Coulomb", Role::Coulomb, vec![(f64::NAN, 1.0)])])]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    assert!(texts(document.root()).contains(&"no value"));
    assert!(matches!(chart(vec![]).svg(), Err(ChartError::NoPanels { .. })));
}

#[test]
fn the_picture_shows_its_title() {
    let svg =
        chart(vec![panel(vec![line("Coulomb", Role::Coulomb, vec![(0.0, 0.0), (1.0, 1.0)])])]).svg().expect("a figure");
    assert!(dark_pixels(&svg, 10.0, 30.0) > 1000, "{}", dark_pixels(&svg, 10.0, 30.0));
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![2 => -10.0..10.0, 1 => prop::num::f64::ANY]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_numbers_and_names_make_a_chart(
        points in prop::collection::vec((any_number(), any_number()), 0..30),
        band in prop::collection::vec((any_number(), any_number(), any_number()), 0..10),
        markers in prop::collection::vec((any_number(), "\\PC{0,80}"), 0..6),
        logs in any::<(bool, bool)>(), text in any::<String>(), panels in 1_usize..4,
    ) {
        let spacing = |log: bool| if log { Spacing::Logarithmic } else { Spacing::Linear };
        let markers = markers.into_iter().map(|(x, label)| Marker { x, label }).collect();
        let series = LineSeries { band, ..line(&text, Role::Reference, points) };
        let one = LinePanel {
            title: text.clone(),
            y: axis(&text, &text, spacing(logs.1)),
            series: vec![LineSeries { stroke: Stroke::Points, ..series.clone() }, series],
            markers,
        };
        let figure = LineChart { names: Vec::new(), title: text.clone(), caption: text.clone(), x: axis(&text, &text, spacing(logs.0)), panels: vec![one; panels] };
        let svg = figure.svg().expect("a figure");
        let document = Document::parse(&svg).expect("well-formed");
        prop_assert!(only_finite(&document));
    }
}
