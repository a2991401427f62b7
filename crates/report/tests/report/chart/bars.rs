//! Level bars.

use resvg::usvg::roxmltree::{Document, Node};

use super::reading::{groups, number, path_numbers, texts, x_axis};
use super::*;

/// Coordinates are written with two decimals; a length is a difference of two.
const PX: f64 = 0.011;

fn names(count: usize, name: &str) -> Vec<String> {
    (0..count).map(|number| format!("{name} {number}")).collect()
}

fn panel(names: Vec<String>, marks: impl IntoIterator<Item = Mark>) -> Panel {
    Panel::new(Axis::new("Share of variance (%)", ""), Axis::from_names("", names)).titled("Total").with(marks)
}

fn bar(number: usize, row: usize, value: f64, low: f64, high: f64) -> Mark {
    series(number).mark(Shape::Bar(Bar::percent(row, Some(value), Some((low, high)))))
}

fn sample() -> Chart {
    let published = Bar { published: Some(58.0), ..Bar::percent(0, Some(61.0), Some((59.0, 64.0))) };
    let marks = [
        series(0).mark(Shape::Bar(published)),
        bar(0, 1, 24.5, 22.0, 26.0),
        bar(1, 0, -1.5, -3.0, 0.5),
        series(1).mark(Shape::Bar(Bar::percent(1, None, None))),
    ];
    Chart::new("Shares", "Shares of the variance of the output.")
        .panels([panel(vec!["first".to_owned(), "second".to_owned()], marks)])
}

fn bars(panel: &Panel) -> impl Iterator<Item = &Bar> {
    panel.marks.iter().filter_map(|mark| match &mark.shape {
        Shape::Bar(bar) => Some(bar),
        _ => None,
    })
}

fn elements<'a, 'i>(document: &'a Document<'i>, class: &str) -> Vec<Node<'a, 'i>> {
    groups(document, class).into_iter().flat_map(|group| group.children().filter(Node::is_element)).collect()
}

/// Compares every bar, interval and diamond of a panel of one chart with its numbers; rows are in the order of the
/// marks.
fn marks_stand_at_their_values(bars: &[Bar], svg: &str) {
    let document = Document::parse(svg).expect("well-formed");
    let (zero, scale) = x_axis(&groups(&document, "x-axis")[0]);
    let tolerance = |value: f64| 2.0 * PX + 1e-3 * (value * scale).abs();
    let drawn: Vec<&Bar> = bars.iter().filter(|bar| bar.to.is_finite()).collect();
    let rects = elements(&document, "bars");
    assert_eq!(rects.len(), drawn.len());
    for (rect, bar) in rects.iter().zip(&drawn) {
        let (left, width) = (number(rect, "x"), number(rect, "width"));
        assert!((width - ((bar.to - bar.from) * scale).abs()).abs() <= tolerance(bar.to), "{bar:?}");
        let end = if bar.to < bar.from { left } else { left + width };
        assert!((end - zero - bar.to * scale).abs() <= tolerance(bar.to), "{bar:?}");
    }
    let intervals: Vec<(f64, f64)> = drawn.iter().filter_map(|bar| bar.interval).collect();
    let whiskers = elements(&document, "whiskers");
    assert_eq!(whiskers.len(), intervals.len());
    for (whisker, (low, high)) in whiskers.iter().zip(intervals) {
        // M low top V bottom M low y H high M high top V bottom
        let numbers = path_numbers(whisker);
        for (x, bound) in [(numbers[0], low), (numbers[3], low), (numbers[5], high), (numbers[6], high)] {
            assert!((x - zero - bound * scale).abs() <= tolerance(bound), "{numbers:?}");
        }
    }
    let published: Vec<f64> = bars.iter().filter_map(|bar| bar.published).collect();
    let diamonds = elements(&document, "published");
    assert_eq!(diamonds.len(), published.len());
    for (diamond, value) in diamonds.iter().zip(published) {
        // M left y L x top ...
        assert!((path_numbers(diamond)[2] - zero - value * scale).abs() <= tolerance(value));
    }
}

#[test]
fn bars_whiskers_and_diamonds_are_at_their_values() {
    let svg = sample().svg();
    let all: Vec<Bar> = bars(&sample().panels[0]).cloned().collect();
    // Row by row.
    marks_stand_at_their_values(&[0, 2, 1, 3].map(|number: usize| all[number].clone()), &svg);
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(texts(groups(&document, "legend")[0]), ["model A", "model B", "95 % interval", "published"]);
    assert_eq!(texts(groups(&document, "values")[0]), ["61.0", "\u{2212}1.5", "24.5", "no value"]);
    assert!(svg.contains("<title>first, model A: 61.0 (59.0 to 64.0), published 58.0</title>"), "{svg}");
    assert!(svg.contains("horizontal axis Share of variance (%), rows first, second."), "{svg}");
}

#[test]
fn a_small_chart_looks_as_reviewed() {
    insta::assert_snapshot!(sample().svg());
}

#[test]
fn rows_are_ranked_and_the_least_left_out() {
    let marks = [bar(0, 0, 10.0, 9.0, 11.0), bar(0, 1, 30.0, 29.0, 31.0), bar(0, 2, 20.0, 19.0, 21.0)];
    let ranked = panel(names(4, "x"), marks).ranked(&[10.0, 30.0, 20.0, f64::NAN], 2);
    assert_eq!(ranked.y.names, ["x 1", "x 2"]);
    let rows: Vec<(usize, f64)> = bars(&ranked).map(|bar| (bar.row, bar.to)).collect();
    assert_eq!(rows, [(0, 30.0), (1, 20.0)]);
}

#[test]
fn two_bars_share_a_row_about_the_rule() {
    let bar = |number: usize, to| series(number).mark(Shape::Bar(Bar { from: 40.0, to, ..Bar::default() }));
    let marks = [Mark::rule(40.0, "nominal"), bar(0, 10.0), bar(1, 20.0)];
    let svg = chart(vec![panel(names(1, "x"), marks)]).svg();
    let document = Document::parse(&svg).expect("well-formed");
    let rects = elements(&document, "bars");
    let (y, height) = (number(&rects[0], "y"), number(&rects[0], "height"));
    assert!((number(&rects[1], "y") - y - height).abs() < PX, "one below the other");
    let end = |rect: &Node| number(rect, "x") + number(rect, "width");
    assert!((end(&rects[0]) - end(&rects[1])).abs() < 2.0 * PX);
    let line = groups(&document, "baseline")[0].first_element_child().expect("a line");
    assert!((number(&line, "x1") - end(&rects[0])).abs() < 2.0 * PX);
    assert!(texts(document.root()).contains(&"nominal"));
}

#[test]
fn panels_with_the_same_rows_name_them_once() {
    let chart = chart(vec![panel(names(3, "x"), [bar(0, 0, 1.0, 0.5, 1.5)]); 2]).side_by_side();
    let svg = chart.svg();
    assert_eq!(svg.matches(">x 1<").count(), 1);
    assert_eq!(chart.svg_at(ChartWidth::Narrow).matches(">x 1<").count(), 2);
}

proptest! {
    #[test]
    fn marks_are_at_their_values_for_any_values(values in prop::collection::vec((-20.0..120.0, 0.0..20.0), 1..12)) {
        let bar = |(row, &(value, half)): (usize, &(f64, f64))| Bar {
            published: Some(value + 0.3 * half),
            ..Bar::percent(row, Some(value), Some((value - half, value + half / 2.0)))
        };
        let bars: Vec<Bar> = values.iter().enumerate().map(bar).collect();
        let marks = bars.iter().map(|bar| series(0).mark(Shape::Bar(bar.clone())));
        marks_stand_at_their_values(&bars, &chart(vec![panel(names(values.len(), "name"), marks)]).svg());
    }
}
