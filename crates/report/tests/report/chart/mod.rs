//! Whole charts, read back from their SVG.

mod axes;
mod bars;
mod lines;
mod pictures;
mod points;
mod reading;
mod rules;
mod words;

use apportion_report::chart::{
    Axis, Bar, Chart, ChartWidth, Colour, Mark, Panel, Point, Series, Shape, Spacing, Stroke, png,
};
use proptest::prelude::*;
use reading::{assert_narrow, dark_pixels, groups, only_finite, texts};
use resvg::usvg::roxmltree::Document;

fn series(number: usize) -> Series {
    Series::new(["model A", "model B", "model C", "model D"][number % 4], Colour::Series(number))
}

fn chart(panels: Vec<Panel>) -> Chart {
    Chart::new("A start", "Pressure until the valve opens.").panels(panels)
}

fn svg(panels: Vec<Panel>) -> String {
    chart(panels).svg()
}

fn spacing(is_logarithmic: bool) -> Spacing {
    if is_logarithmic { Spacing::Logarithmic } else { Spacing::Linear }
}

/// A number, sometimes one that cannot be drawn.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -20.0..120.0, 1 => prop::num::f64::ANY]
}

/// Any mark, with numbers and texts of all sorts.
fn any_mark() -> impl Strategy<Value = Mark> {
    let pairs = || prop::collection::vec((any_number(), any_number()), 0..12);
    let triples = prop::collection::vec((any_number(), any_number(), any_number()), 0..9);
    let interval = || prop::option::of((any_number(), any_number()));
    let text = || "\\PC{0,30}";
    let bar = (0_usize..8, any_number(), any_number(), interval(), prop::option::of(any_number()), text()).prop_map(
        |(row, from, to, interval, published, label)| Bar {
            row,
            from,
            to,
            interval,
            published,
            label,
            ..Bar::default()
        },
    );
    let point = (any_number(), any_number(), text()).prop_map(|(x, y, label)| Point { x, y, label });
    let shape = prop_oneof![
        1 => pairs().prop_map(Shape::Line),
        1 => triples.prop_map(Shape::Band),
        1 => pairs().prop_map(Shape::Dots),
        1 => point.prop_map(Shape::Point),
        4 => bar.prop_map(Shape::Bar),
        1 => (any_number(), text()).prop_map(|(x, label)| Shape::Rule(x, label)),
    ];
    let strokes = [Stroke::Solid, Stroke::Dashed, Stroke::Dotted, Stroke::SolidWithPoints, Stroke::Points];
    (shape, any::<String>(), 0_usize..20, prop::sample::select(strokes.to_vec()))
        .prop_map(|(shape, name, colour, stroke)| Series::new(name, Colour::Series(colour)).stroke(stroke).mark(shape))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_marks_on_any_axes_make_a_chart(
        marks in prop::collection::vec(any_mark(), 0..20), text in any::<String>(), count in 0_usize..7,
        logarithmic in any::<(bool, bool)>(), names in (0_usize..6, 0_usize..6), is_side_by_side in any::<bool>(),
        is_narrow in any::<bool>(),
    ) {
        let axis = |is_logarithmic, names: usize| Axis {
            names: (0..names).map(|place| format!("{text}{place}")).collect(),
            ..Axis::new(&text, &text).spaced(spacing(is_logarithmic))
        };
        let x = axis(logarithmic.0, if names.1 > 0 { 0 } else { names.0 });
        let panel = Panel::new(x, axis(logarithmic.1, names.1)).titled(&text).with(marks);
        let chart = Chart::new(&text, &text).panels(vec![panel; count]);
        let chart = if is_side_by_side { chart.side_by_side() } else { chart };
        let svg = chart.svg_at(if is_narrow { ChartWidth::Narrow } else { ChartWidth::Wide });
        prop_assert!(only_finite(&Document::parse(&svg).expect("well-formed")), "{svg}");
    }
}

#[test]
fn an_empty_output_is_explained() {
    let gap = vec![(f64::NAN, 1.0)];
    let empty = Panel::new(Axis::new("x", ""), Axis::new("y", ""));
    let rows = Axis::from_names("", vec!["a".to_owned()]);
    let missing = series(0).mark(Shape::Bar(Bar::percent(0, None, None)));
    let cases = [
        empty.clone(),
        empty.clone().with([series(0).line(gap.clone())]),
        empty.with([series(0).mark(Shape::Dots(gap))]),
        Panel::new(Axis::new("x", ""), rows.clone()),
        Panel::new(Axis::new("x", ""), rows).with([missing]),
    ];
    for panel in cases {
        let svg = svg(vec![panel.clone()]);
        assert!(texts(Document::parse(&svg).expect("well-formed").root()).contains(&"no value"), "{panel:?}");
    }
}

#[test]
fn title_and_caption_are_drawn_and_described() {
    let panel = Panel::new(Axis::new("Time", "ms"), Axis::new("Pressure", "bar"));
    let svg = svg(vec![panel.with([series(0).line(vec![(0.0, 0.0), (1.0, 1.0)])])]);
    let document = Document::parse(&svg).expect("well-formed");
    let root = document.root_element();
    assert_eq!(root.attribute("role"), Some("img"));
    let child = |name: &str| root.children().find(|n| n.has_tag_name(name)).and_then(|n| n.text());
    assert_eq!(child("title"), Some("A start"));
    let description = child("desc").expect("a description");
    assert!(
        description
            .starts_with("Pressure until the valve opens. horizontal axis Time (ms), vertical axis Pressure (bar)")
    );
    // The title's baseline is near 25 px, below it the legend; a bold title has some hundred dark pixels.
    assert!(dark_pixels(&svg, 10.0, 30.0) > 400, "{}", dark_pixels(&svg, 10.0, 30.0));
    assert_eq!(dark_pixels(&svg, 0.0, 10.0), 0);
}

#[test]
fn text_of_users_is_escaped() {
    let nasty = "</text><script>alert('\"&\")</script>\u{0}";
    let panel = Panel::new(Axis::new(nasty, nasty), Axis::from_names(nasty, vec![nasty.to_owned()]));
    let marks = [
        Series::new(nasty, Colour::Reference).mark(Shape::Bar(Bar {
            label: nasty.to_owned(),
            to: 1.0,
            ..Bar::default()
        })),
        Mark::rule(0.0, nasty),
    ];
    let chart = Chart::new(nasty, nasty).panels([panel.titled(nasty).with(marks)]);
    let svg = chart.svg();
    let document = Document::parse(&svg).expect("well-formed");
    assert!(!svg.contains("<script") && !document.descendants().any(|n| n.has_tag_name("script")));
    assert!(texts(groups(&document, "legend")[0])[0].starts_with("</text><script>alert('\"&\")</script>"));
}

#[test]
fn a_phone_shows_everything_inside() {
    let long = "a name that takes more than one line on a phone, as most of them do not but some";
    let points = vec![(64.0, -12_345.0), (1e6, 98_765.0)];
    let with_points = Series::new(long, Colour::Series(1)).stroke(Stroke::SolidWithPoints);
    let mark = |x: f64| Mark::rule(x, "97.5 % of all values lie below 1234.5");
    for is_logarithmic in [false, true] {
        let x = Axis::new(long, "°").spaced(spacing(is_logarithmic));
        let panel = Panel::new(x, Axis::new(long, "nN")).titled(long);
        let lines =
            panel.clone().with([with_points.line(points.clone()), mark(64.0), mark(80.0), mark(5e5), mark(1e6)]);
        let dots = panel.clone().with([with_points.mark(Shape::Dots(points.clone()))]);
        for count in 1..7 {
            assert_narrow(&Chart::new(long, long).panels(vec![lines.clone(); count]));
            assert_narrow(&Chart::new(long, long).side_by_side().panels(vec![dots.clone(); count]));
        }
    }
}
