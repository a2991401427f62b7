//! Level bars.

use resvg::usvg::roxmltree::{Document, Node};

use super::super::png::extent;
use super::super::reading::{groups, number, path_numbers, texts, x_axis};
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

fn elements<'a, 'i>(document: &'a Document<'i>, class: &str) -> Vec<Node<'a, 'i>> {
    groups(document, class).into_iter().flat_map(|group| group.children().filter(Node::is_element)).collect()
}

/// Compares every bar, interval and diamond of a panel of one chart with its numbers; rows are in the order of the marks.
fn marks_stand_at_their_values(bars: &[Bar], svg: &str) {
    let document = Document::parse(svg).expect("well-formed");
    let (zero, scale) = x_axis(&groups(&document, "x-axis")[0]);
    let tolerance = |value: f64| 2.0 * PX + 1e-3 * (value * scale).abs();
    let drawn: Vec<&Bar> = bars.iter().filter(|bar| bar.drawn().is_some()).collect();
    let rects = elements(&document, "bars");
    assert_eq!(rects.len(), drawn.len());
    for (rect, bar) in rects.iter().zip(&drawn) {
        let (left, width) = (number(rect, "x"), number(rect, "width"));
        assert!((width - ((bar.to - bar.from) * scale).abs()).abs() <= tolerance(bar.to), "{bar:?}");
        let end = if bar.to < bar.from { left } else { left + width };
        assert!((end - zero - bar.to * scale).abs() <= tolerance(bar.to), "{bar:?}");
    }
    let intervals: Vec<(f64, f64)> = drawn.iter().filter_map(|bar| bar.drawn()?.interval).collect();
    let whiskers = elements(&document, "whiskers");
    assert_eq!(whiskers.len(), intervals.len());
    for (whisker, (low, high)) in whiskers.iter().zip(intervals) {
        // M low top V bottom M low y H high M high top V bottom
        let numbers = path_numbers(whisker);
        for (x, bound) in [(numbers[0], low), (numbers[3], low), (numbers[5], high), (numbers[6], high)] {
            assert!((x - zero - bound * scale).abs() <= tolerance(bound), "{numbers:?}");
        }
    }
    let published: Vec<f64> = bars.iter().filter_map(Bar::diamond).collect();
    let diamonds = elements(&document, "published");
    assert_eq!(diamonds.len(), published.len());
    for (diamond, value) in diamonds.iter().zip(published) {
        // M left y L x top ...
        assert!((path_numbers(diamond)[2] - zero - value * scale).abs() <= tolerance(value));
    }
}

#[test]
fn bars_whiskers_and_diamonds_stand_at_their_values() {
    let svg = sample().svg().expect("a chart");
    let all: Vec<Bar> = sample().all_panels()[0].bars().map(|(_, bar)| bar.clone()).collect();
    // Row by row.
    marks_stand_at_their_values(&[0, 2, 1, 3].map(|number: usize| all[number].clone()), &svg);
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(texts(groups(&document, "legend")[0]), ["model A", "model B", "95 % interval", "published"]);
    assert_eq!(texts(groups(&document, "values")[0]), ["61.0", "\u{2212}1.5", "24.5", "no value"]);
    let told = sample().description();
    assert!(told.contains("first, model A: 61.0 (59.0 to 64.0), published 58.0"), "{told}");
    assert!(told.contains("second, model B: no value"), "{told}");
}

#[test]
fn a_small_chart_looks_as_reviewed() {
    insta::assert_snapshot!(sample().svg().expect("a chart"));
}

#[test]
fn rows_are_ranked_and_the_least_left_out() {
    let marks =
        [bar(0, 0, 10.0, 9.0, 11.0), bar(0, 1, 30.0, 29.0, 31.0), Mark::note(1, "most"), bar(0, 2, 20.0, 19.0, 21.0)];
    let ranked = panel(names(4, "x"), marks).ranked(&[10.0, 30.0, 20.0, f64::NAN], 2);
    assert_eq!(ranked.y.names, ["x 1", "x 2"]);
    let rows: Vec<(usize, f64)> = ranked.bars().map(|(_, bar)| (bar.row, bar.to)).collect();
    assert_eq!(rows, [(0, 30.0), (1, 20.0)]);
    assert!(ranked.marks.contains(&Mark::note(0, "most")));
}

#[test]
fn two_bars_share_a_row_about_the_rule() {
    let bar = |number: usize, to| series(number).mark(Shape::Bar(Bar { from: 40.0, to, ..Bar::default() }));
    let marks =
        [Mark::rule(40.0, "nominal"), bar(0, 10.0), bar(1, 20.0), series(0).mark(Shape::Interval(0, 5.0, 60.0))];
    let svg = chart(vec![panel(names(1, "x"), marks)]).svg().expect("a chart");
    let document = Document::parse(&svg).expect("well-formed");
    let rects = elements(&document, "bars");
    let (y, height) = (number(&rects[0], "y"), number(&rects[0], "height"));
    assert!((number(&rects[1], "y") - y - height).abs() < PX, "one below the other");
    let end = |rect: &Node| number(rect, "x") + number(rect, "width");
    assert!((end(&rects[0]) - end(&rects[1])).abs() < 2.0 * PX);
    let line = groups(&document, "baseline")[0].first_element_child().expect("a line");
    assert!((number(&line, "x1") - end(&rects[0])).abs() < 2.0 * PX);
    assert!(texts(document.root()).contains(&"nominal"));
    assert_eq!(elements(&document, "whiskers").len(), 1);
}

/// Boxes of all texts of a panel, and of the marks; none lies over another.
#[track_caller]
fn texts_stand_apart(svg: &str) {
    let ([left, top, right, bottom], [width, height]) = extent(svg);
    // 0.01 px: single precision.
    let inside = left >= -0.01 && top >= -0.01 && right <= width + 0.01 && bottom <= height + 0.01;
    assert!(inside, "{left} {top} {right} {bottom} in {width} x {height}");
    let document = Document::parse(svg).expect("well-formed");
    for class in ["rows", "values"] {
        let mut baselines: Vec<f64> = groups(&document, class)
            .iter()
            .flat_map(|group| {
                group.children().filter(|n| n.has_tag_name("text")).map(|n| number(&n, "y")).collect::<Vec<_>>()
            })
            .collect();
        baselines.sort_by(f64::total_cmp);
        baselines.dedup();
        // Cap heights are 7.2 and 6.5 px.
        assert!(baselines.windows(2).all(|pair| pair[1] - pair[0] > 7.0), "{class}: {baselines:?}");
    }
}

#[test]
fn many_factors_of_any_size_and_name_stay_apart_and_inside() {
    let long = "a name of a factor that is 40 letters lo";
    for (count, of_series, scale) in
        [(1, 1, 1.0), (3, 3, 1.0), (8, 2, 1e-12), (40, 2, 1e12), (100, 1, 1.0), (100, 4, -1.0)]
    {
        let marks = || {
            let all = (0..of_series).flat_map(|number| (0..count).map(move |row| (number, row)));
            all.map(|(number, row): (usize, usize)| {
                let value = scale * (number + row) as f64;
                match row % 5 {
                    3 => series(number).mark(Shape::Bar(Bar::percent(row, Some(value), None))),
                    4 => series(number).mark(Shape::Bar(Bar::percent(row, None, None))),
                    _ => bar(number, row, value, 0.9 * value, 1.2 * value),
                }
            })
        };
        for columns in [1, 2] {
            let panels = vec![panel(names(count, long), marks()); columns];
            let chart = Chart::new("Many factors", "All of them.").side_by_side().panels(panels);
            texts_stand_apart(&chart.svg().expect("a chart"));
            assert_narrow(&chart);
            texts_stand_apart(&chart.svg_at(ChartWidth::Narrow).expect("a chart"));
        }
    }
}

#[test]
fn on_a_phone_names_and_notes_stand_above_their_bars() {
    let long = "the name of a factor that leaves no room for anything else";
    let row = |row: usize, to: f64, note: &str| {
        [series(0).mark(Shape::Bar(Bar { row, to, ..Bar::default() })), Mark::note(row, note)]
    };
    let rows =
        [row(0, 40_000.0, "1"), row(1, -10.0, "12.3 %: 120 to 200 GPa"), row(2, 1.0, long), row(3, f64::NAN, "")];
    let names: Vec<String> = ["first", long, long, "none"].map(str::to_owned).to_vec();
    for label in ["nominal", long] {
        let rule = Mark::rule(40.0, label.repeat(2));
        let chart = chart(vec![panel(names.clone(), rows.iter().flatten().cloned()).with([rule])]);
        assert_narrow(&chart);
        let svg = chart.svg_at(ChartWidth::Narrow).expect("a chart");
        let drawn = texts(Document::parse(&svg).expect("well-formed").root()).join("|");
        assert!(drawn.contains("12.3 %: 120 to 200 GPa") && drawn.contains("first"), "{drawn}");
    }
}

#[test]
fn panels_with_the_same_rows_name_them_once() {
    let chart = chart(vec![panel(names(3, "x"), [bar(0, 0, 1.0, 0.5, 1.5)]); 2]).side_by_side();
    let svg = chart.svg().expect("a chart");
    assert_eq!(svg.matches(">x 1<").count(), 1);
    assert_eq!(chart.svg_at(ChartWidth::Narrow).expect("a chart").matches(">x 1<").count(), 2);
}

proptest! {
    #[test]
    fn marks_stand_at_any_usual_values(values in prop::collection::vec((-20.0..120.0, 0.0..20.0), 1..12)) {
        let bar = |(row, &(value, half)): (usize, &(f64, f64))| Bar {
            published: Some(value + 0.3 * half),
            ..Bar::percent(row, Some(value), Some((value - half, value + half / 2.0)))
        };
        let bars: Vec<Bar> = values.iter().enumerate().map(bar).collect();
        let marks = bars.iter().map(|bar| series(0).mark(Shape::Bar(bar.clone())));
        marks_stand_at_their_values(&bars, &chart(vec![panel(names(values.len(), "name"), marks)]).svg().expect("a chart"));
    }
}

#[test]
fn bars_far_apart_are_dots_on_a_logarithmic_axis() {
    let bar = |row, to: f64, half: f64| {
        let said = format!("{to} of it");
        Bar { row, to, interval: Some((to - half, to + half)), label: to.to_string(), said, ..Bar::default() }
    };
    let names: Vec<String> = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
    let chart = |bars: &[Bar]| {
        let marks = bars.iter().map(|bar| Series::new("index", Colour::Series(0)).mark(Shape::Bar(bar.clone())));
        let panel = Panel::new(Axis::new("x", ""), Axis::from_names("", names.clone())).with(marks);
        Chart::new("T", "C").panels([panel])
    };
    let drawn = chart(&[bar(0, 0.9, 0.01), bar(1, 0.001, 0.1), bar(2, 0.0, 0.0), bar(3, f64::NAN, 0.0)]);
    let other = drawn.logarithmic().unwrap();
    let svg = other.svg().unwrap();
    assert!(
        svg.matches("<circle").count() >= 2
            && svg.contains("a, index: 0.9 of it")
            && !svg.contains("class=\"baseline\"")
    );
    let [Mark { shape: Shape::Bar(small), .. }, ..] = &other.all_panels()[0].marks[1..] else { panic!("no bar") };
    assert_eq!((small.from, small.to, small.interval), (0.001, 0.001, Some((0.0005, 0.101))));
    // What is not positive keeps its words.
    let [.., Mark { shape: Shape::Bar(zero), .. }, _] = &other.all_panels()[0].marks[..] else { panic!("no bar") };
    assert!(zero.to.is_nan() && zero.label == "0");
    // Within a factor of 100, with values from elsewhere, or once more: a linear axis does.
    assert!(chart(&[bar(0, 0.9, 0.0), bar(1, 0.01, 0.0)]).logarithmic().is_none());
    assert!(chart(&[bar(0, 0.9, 0.0), Bar { published: Some(1.0), ..bar(1, 0.001, 0.0) }]).logarithmic().is_none());
    assert!(other.logarithmic().is_none() && chart(&[]).logarithmic().is_none());
}
