use resvg::usvg::roxmltree::Document;

use super::super::Chart;
use super::super::lines::Stroke;
use super::super::reading::{assert_narrow, dark_pixels, groups, only_finite, path_numbers, texts, y_axis};
use super::super::scale::Spacing;
use super::*;
use proptest::prelude::*;

fn axis(label: &str, unit: &str) -> Axis {
    Axis { label: label.to_owned(), unit: unit.to_owned(), ..Axis::default() }
}

fn panel(dots: Vec<(f64, f64)>) -> CloudPanel {
    let line = LineSeries {
        name: "mean".to_owned(),
        role: Role::Reference,
        stroke: Stroke::Solid,
        points: vec![(0.0, 10.0), (10.0, 20.0)],
        band: vec![(0.0, 9.0, 11.0), (10.0, 18.0, 22.0)],
    };
    CloudPanel {
        title: "S1 0.34, ST 0.69".to_owned(),
        x: axis("thickness", "um"),
        names: Vec::new(),
        dots,
        lines: vec![line],
    }
}

fn chart(panels: Vec<CloudPanel>) -> CloudChart {
    CloudChart {
        title: "Critical force".to_owned(),
        caption: "It rises with the thickness.".to_owned(),
        y: axis("critical force", "nN"),
        dots: "model run".to_owned(),
        role: Role::Coulomb,
        panels,
    }
}

#[test]
fn dots_are_one_path_at_their_values() {
    let dots = vec![(0.0, 10.0), (5.0, 40.0), (f64::NAN, 1.0), (10.0, 20.0)];
    let svg = chart(vec![panel(dots)]).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let (zero, scale) = y_axis(&groups(&document, "y-axis")[0]);
    let clouds = groups(&document, "dots");
    assert_eq!(clouds.len(), 1);
    // M x y h 0 for each dot.
    let drawn = path_numbers(&clouds[0]);
    assert_eq!(drawn.len(), 3 * 3);
    for (dot, value) in drawn.chunks(3).zip([10.0, 40.0, 20.0]) {
        // One decimal, and tick labels give the scale to 1e-3.
        assert!((zero - dot[1] - value * scale).abs() < 0.06 + 1e-3 * value * scale);
        assert_eq!(dot[2], 0.0);
    }
    assert!((drawn[3] - drawn[0] - (drawn[6] - drawn[3])).abs() < 0.21, "equal steps");
    assert_eq!(texts(groups(&document, "legend")[0]), ["model run", "mean"]);
}

#[test]
fn dots_are_seen_in_the_picture() {
    let mut one = chart(vec![CloudPanel { lines: Vec::new(), ..panel(vec![(0.0, 0.0), (5.0, 5.0), (10.0, 10.0)]) }]);
    (one.title, one.dots) = (String::new(), String::new());
    one.role = Role::Reference;
    let with = one.svg().expect("a figure");
    // Without dots the axes would be others: here they are there, but no path.
    let without = with.replace("h0", "");
    let height = number_of_rows(&with);
    assert!(visible(&with, height) > visible(&without, height), "round ends of lines of no length are drawn");
}

fn number_of_rows(svg: &str) -> f64 {
    let document = Document::parse(svg).expect("well-formed");
    document.root_element().attribute("height").and_then(|height| height.parse().ok()).expect("a height")
}

/// Dark pixels once the dots are as dark as ink.
fn visible(svg: &str, height: f64) -> usize {
    dark_pixels(&svg.replace("stroke-opacity=\"0.4\"", ""), 0.0, height)
}

#[test]
fn panels_stand_in_even_rows_and_share_their_vertical_axis() {
    for (count, wide, narrow) in [(1, 1, 1), (2, 2, 2), (3, 3, 2), (4, 2, 2), (5, 3, 2), (6, 3, 2)] {
        let figure = chart(vec![panel(vec![(1.0, 2.0)]); count]);
        for (width, columns) in [(ChartWidth::Wide, wide), (ChartWidth::Narrow, narrow)] {
            let svg = figure.svg_at(width).expect("a figure");
            let document = Document::parse(&svg).expect("well-formed");
            assert_eq!(groups(&document, "panel").len(), count);
            // One labelled axis in each row.
            assert_eq!(groups(&document, "y-axis").len(), usize::div_ceil(count, columns), "{count} at {width:?}");
        }
    }
}

#[test]
fn a_phone_shows_everything_inside() {
    let mut one = panel((0..50).map(|i| (f64::from(i) * 1e4, f64::from(i * i) * 1e4)).collect());
    one.x.label = "a factor of a name that takes more than one line below its plot".to_owned();
    one.title = "a title that is longer than its plot is wide".to_owned();
    let mut logarithmic = one.clone();
    logarithmic.x.spacing = Spacing::Logarithmic;
    for count in 1..7 {
        assert_narrow(&Chart::Cloud(chart(vec![one.clone(); count])));
        let mut figure = chart(vec![logarithmic.clone(); count]);
        figure.y.spacing = Spacing::Logarithmic;
        assert_narrow(&Chart::Cloud(figure));
    }
}

#[test]
fn thousands_of_dots_make_a_small_file() {
    let dots = (0..2000).map(|i| (f64::from(i).sin(), f64::from(i).cos())).collect();
    let svg = chart(vec![panel(dots)]).svg().expect("a figure");
    // At most "M123.4 123.4h0" for each, and the rest of the figure.
    assert!(svg.len() < 2000 * 14 + 6000, "{}", svg.len());
}

#[test]
fn nothing_to_show_is_said_and_no_panel_refused() {
    let empty = CloudPanel { lines: Vec::new(), ..panel(vec![(f64::NAN, 1.0)]) };
    let svg = chart(vec![empty]).svg().expect("a figure");
    assert!(texts(Document::parse(&svg).expect("well-formed").root()).contains(&"no value"));
    assert!(matches!(chart(vec![]).svg(), Err(ChartError::NoPanels { .. })));
}

proptest! {
    #[test]
    fn any_numbers_and_names_make_a_chart(
        dots in prop::collection::vec((any::<f64>(), any::<f64>()), 0..9), text in any::<String>(),
        count in 1_usize..7, logs in any::<(bool, bool)>(), narrow in any::<bool>(),
    ) {
        let spacing = |log: bool| if log { Spacing::Logarithmic } else { Spacing::Linear };
        let mut one = panel(dots);
        (one.x.spacing, one.x.label, one.title) = (spacing(logs.0), text.clone(), text);
        let mut figure = chart(vec![one; count]);
        figure.y.spacing = spacing(logs.1);
        let width = if narrow { ChartWidth::Narrow } else { ChartWidth::Wide };
        let svg = figure.svg_at(width).expect("a figure");
        prop_assert!(only_finite(&Document::parse(&svg).expect("well-formed")));
    }
}
