use resvg::usvg::roxmltree::{Document, Node};

use super::super::Chart;
use super::super::reading::{assert_narrow, groups, number, only_finite, path_numbers, texts};
use super::*;
use proptest::prelude::*;

fn row(name: &str, to: f64, interval: Option<(f64, f64)>) -> RangeRow {
    let bars = vec![Range { role: Role::Other(0), from: 0.0, to }];
    RangeRow { name: name.to_owned(), bars, interval, note: format!("{to}") }
}

fn chart(rows: Vec<RangeRow>) -> RangeBars {
    RangeBars {
        title: "Effects".to_owned(),
        caption: "Mean sizes of the effects.".to_owned(),
        x: Axis { label: "effect".to_owned(), unit: "nN".to_owned(), ..Axis::default() },
        reference: None,
        series: vec![("linear".to_owned(), Role::Other(0)), ("never".to_owned(), Role::Other(1))],
        interval_label: "95 % interval".to_owned(),
        rows,
    }
}

#[test]
fn bars_and_intervals_stand_at_their_values() {
    let rows = vec![row("a", 40.0, Some((30.0, 50.0))), row("b", 10.0, None), row("c", -5.0, None)];
    let svg = chart(rows).svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let rects: Vec<Node> =
        groups(&document, "bars").into_iter().flat_map(|g| g.children().filter(Node::is_element)).collect();
    let (zero, forty) = (number(&rects[0], "x"), number(&rects[0], "width"));
    // 0.02 px: a length is the difference of two coordinates of two decimals.
    assert!((number(&rects[1], "width") - forty / 4.0).abs() < 0.02);
    assert!((number(&rects[2], "x") + number(&rects[2], "width") - zero).abs() < 0.02);
    let whisker = path_numbers(&groups(&document, "whisker")[0]);
    assert!((whisker[0] - zero - 0.75 * forty).abs() < 0.02, "{whisker:?}");
    let drawn = texts(document.root());
    assert!(["a", "b", "c", "effect (nN)", "linear", "95 % interval"].iter().all(|text| drawn.contains(text)));
    assert!(!drawn.contains(&"never"));
}

#[test]
fn two_bars_share_a_row_about_the_reference() {
    let bar = |role, to| Range { role, from: 40.0, to };
    let bars = vec![bar(Role::Other(0), 10.0), bar(Role::Other(1), 20.0)];
    let rows = vec![RangeRow { name: "x".to_owned(), bars, interval: None, note: String::new() }];
    let reference = Some(Reference { value: 40.0, label: "nominal".to_owned() });
    let svg = RangeBars { reference, ..chart(rows) }.svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let rects: Vec<Node> = groups(&document, "bars")[0].children().filter(Node::is_element).collect();
    let (y, height) = (number(&rects[0], "y"), number(&rects[0], "height"));
    assert!((number(&rects[1], "y") - y - height).abs() < 0.011, "one below the other");
    let end = |rect: &Node| number(rect, "x") + number(rect, "width");
    assert!((end(&rects[0]) - end(&rects[1])).abs() < 0.02);
    let line = groups(&document, "reference")[0].first_element_child().expect("a line");
    assert!((number(&line, "x1") - end(&rects[0])).abs() < 0.02);
    assert!(texts(document.root()).contains(&"nominal"));
}

#[test]
fn on_a_phone_names_and_notes_stand_above_their_bars() {
    let long = "the name of a factor that leaves no room for anything else";
    let rows = vec![
        row("thickness", 40_000.0, Some((30.0, 50_000.0))),
        RangeRow { note: "12.3 %: 120 to 200 GPa".to_owned(), ..row(long, -10.0, None) },
        RangeRow { note: long.to_owned(), ..row(long, 1.0, None) },
        row("none", f64::NAN, None),
    ];
    for label in ["nominal", long] {
        let reference = Some(Reference { value: 40.0, label: label.repeat(2) });
        let chart = RangeBars { reference, ..chart(rows.clone()) };
        assert_narrow(&Chart::Ranges(chart.clone()));
        let svg = chart.svg_at(ChartWidth::Narrow).expect("a figure");
        let drawn = texts(Document::parse(&svg).expect("well-formed").root()).join("|");
        assert!(drawn.contains("12.3 %: 120 to 200 GPa") && drawn.contains("thickness"), "{drawn}");
    }
}

#[test]
fn nothing_to_show_is_said_and_no_row_refused() {
    let svg = chart(vec![row("a", f64::NAN, Some((f64::NAN, 1.0)))]).svg().expect("a figure");
    assert!(texts(Document::parse(&svg).expect("well-formed").root()).contains(&"no value"));
    assert!(matches!(chart(vec![]).svg(), Err(ChartError::NoPanels { .. })));
}

proptest! {
    #[test]
    fn any_numbers_and_names_make_a_chart(
        rows in prop::collection::vec((any::<String>(), any::<f64>(), any::<f64>(), any::<f64>()), 1..6),
        reference in any::<f64>(),
    ) {
        let rows = rows.into_iter().map(|(name, to, low, high)| row(&name, to, Some((low, high)))).collect();
        let reference = Some(Reference { value: reference, label: "nominal".to_owned() });
        let svg = RangeBars { reference, ..chart(rows) }.svg().expect("a figure");
        prop_assert!(only_finite(&Document::parse(&svg).expect("well-formed")));
    }
}
