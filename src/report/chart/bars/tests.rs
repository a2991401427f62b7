use resvg::usvg::roxmltree::{Document, Node};

use super::super::Chart;
use super::super::reading::{assert_narrow, dark_pixels, groups, number, only_finite, path_numbers, texts, y_axis};
use super::*;
use proptest::prelude::*;

/// Coordinates are written with two decimals; a length is a difference of two.
const PX: f64 = 0.011;

fn bar(value: f64, low: f64, high: f64) -> Option<Bar> {
    Some(Bar { value, interval: Some((low, high)) })
}

fn series(name: &str, role: Role, values: Vec<Option<Bar>>) -> Series {
    Series { name: name.to_owned(), role, values, published: Vec::new() }
}

fn panel(categories: &[&str], series: Vec<Series>) -> Panel {
    Panel { title: "Total".to_owned(), categories: categories.iter().map(|&c| c.to_owned()).collect(), series }
}

fn figure(panels: Vec<Panel>) -> GroupedBars {
    GroupedBars {
        title: "Dimensional factors".to_owned(),
        caption: "Shares of the variance of the critical force.".to_owned(),
        y_label: "Share of variance (%)".to_owned(),
        interval_label: "95 % interval".to_owned(),
        published_label: "published".to_owned(),
        panels,
    }
}

fn sample() -> GroupedBars {
    let mut coulomb = series("Coulomb", Role::Coulomb, vec![bar(61.0, 59.0, 64.0), bar(24.5, 22.0, 26.0)]);
    coulomb.published = vec![Some(58.0), None];
    let lugre = series("LuGre", Role::LuGre, vec![bar(-1.5, -3.0, 0.5), None]);
    figure(vec![panel(&["thickness", "length"], vec![coulomb, lugre])])
}

fn one_panel_checks(chart: &GroupedBars, svg: &str) {
    let document = Document::parse(svg).expect("well-formed");
    for (panel, node) in chart.panels.iter().zip(groups(&document, "panel")) {
        let class = |name: &str| {
            node.descendants()
                .find(|n| n.attribute("class") == Some(name))
                .map_or(Vec::new(), |n| n.children().filter(Node::is_element).collect::<Vec<_>>())
        };
        let axis = node.descendants().find(|n| n.attribute("class") == Some("y-axis")).expect("an axis");
        let (zero, scale) = y_axis(&axis);
        let bars: Vec<(usize, &Series, Bar)> =
            panel.slots().filter_map(|(i, series)| Some((i, series, series.bar(i)?))).collect();
        let drawn = class("bars");
        assert_eq!(drawn.len(), bars.len());
        let tolerance = |value: f64| PX + 1e-3 * (value * scale).abs();
        for (rect, &(i, series, bar)) in drawn.iter().zip(&bars) {
            let (top, height) = (number(rect, "y"), number(rect, "height"));
            assert!((height - (bar.value * scale).abs()).abs() <= tolerance(bar.value));
            let end = if bar.value < 0.0 { top + height } else { top };
            assert!((zero - end - bar.value * scale).abs() <= tolerance(bar.value) + PX);
            assert_eq!(rect.attribute("fill"), Some(series.role.colour()));
            let tip = rect.first_element_child().and_then(|title| title.text()).expect("a tip");
            assert!(tip.contains(&panel.categories[i]) && tip.contains(&series.name));
        }
        let intervals: Vec<_> = bars.iter().filter_map(|(_, _, bar)| bar.interval).collect();
        let whiskers = class("whiskers");
        assert_eq!(whiskers.len(), intervals.len());
        for (whisker, (low, high)) in whiskers.iter().zip(intervals) {
            // M left low H right M x low V high M left high H right
            let numbers = path_numbers(whisker);
            for (y, bound) in [(numbers[1], low), (numbers[4], low), (numbers[5], high), (numbers[7], high)] {
                assert!((zero - y - bound * scale).abs() <= tolerance(bound) + PX, "{numbers:?}");
            }
        }
        let published: Vec<f64> = panel.slots().filter_map(|(i, series)| series.published(i)).collect();
        let diamonds = class("published");
        assert_eq!(diamonds.len(), published.len());
        for (diamond, value) in diamonds.iter().zip(published) {
            // M x top L right y ...
            assert!((zero - path_numbers(diamond)[3] - value * scale).abs() <= tolerance(value) + PX);
        }
    }
}

#[test]
fn bars_whiskers_and_diamonds_stand_at_their_values() {
    let svg = sample().svg().expect("a figure");
    one_panel_checks(&sample(), &svg);
    let document = Document::parse(&svg).expect("well-formed");
    let rects = groups(&document, "bars")[0];
    let heights: Vec<f64> = rects.children().filter(Node::is_element).map(|rect| number(&rect, "height")).collect();
    assert!((heights[0] / heights[1] - 61.0 / 1.5).abs() < 0.3, "{heights:?}");
    assert!((heights[0] / heights[2] - 61.0 / 24.5).abs() < 1e-3, "{heights:?}");
    let legend = texts(groups(&document, "legend")[0]);
    assert_eq!(legend, ["Coulomb", "LuGre", "95 % interval", "published", "no value"]);
    assert_eq!(texts(groups(&document, "values")[0]), ["61.0", "\u{2212}1.5", "24.5"]);
}

#[test]
fn a_small_chart_looks_as_reviewed() {
    insta::assert_snapshot!(sample().svg().expect("a figure"));
}

#[test]
fn same_data_same_bytes() {
    assert_eq!(sample().svg(), sample().svg());
}

#[test]
fn title_and_caption_are_drawn_and_told() {
    let svg = sample().svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let root = document.root_element();
    assert_eq!(root.attribute("role"), Some("img"));
    let child = |name: &str| root.children().find(|n| n.has_tag_name(name)).and_then(|n| n.text());
    assert_eq!(child("title"), Some("Dimensional factors"));
    let told = child("desc").expect("a description");
    assert!(
        told.contains("length, LuGre: no value")
            && told.contains("thickness, Coulomb: 61.0 (59.0 to 64.0), published 58.0")
    );
    // The title's baseline is near 25 px, below it the legend; a bold title has thousands of dark pixels.
    assert!(dark_pixels(&svg, 10.0, 30.0) > 1500, "{}", dark_pixels(&svg, 10.0, 30.0));
    assert_eq!(dark_pixels(&svg, 0.0, 10.0), 0);
}

#[test]
fn text_of_users_is_escaped() {
    let nasty = "</text><script>alert('\"&\")</script>\u{0}";
    let mut chart = sample();
    chart.title = nasty.to_owned();
    chart.caption = nasty.to_owned();
    chart.y_label = nasty.to_owned();
    chart.panels[0].title = nasty.to_owned();
    chart.panels[0].categories[0] = nasty.to_owned();
    chart.panels[0].series[0].name = nasty.to_owned();
    let svg = chart.svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    assert!(!svg.contains("<script") && !document.descendants().any(|n| n.has_tag_name("script")));
    assert!(texts(groups(&document, "legend")[0])[0].starts_with("</text><script>alert('\"&\")</script>"));
}

#[test]
fn nothing_to_show_is_said() {
    let none = series("Coulomb", Role::Coulomb, vec![None, Some(Bar { value: f64::NAN, interval: None })]);
    let chart = figure(vec![panel(&["a", "b"], vec![none.clone()]), panel(&[], vec![]), panel(&["a"], vec![])]);
    let svg = chart.svg().expect("a figure");
    let document = Document::parse(&svg).expect("well-formed");
    let notes: Vec<_> = groups(&document, "panel").into_iter().map(|p| texts(p).contains(&"no value")).collect();
    assert_eq!(notes, [true, true, true]);
    assert!(groups(&document, "bars").iter().all(|bars| !bars.has_children() || bars.first_element_child().is_none()));
}

#[test]
fn panels_stand_side_by_side_only_with_room() {
    let full = |n: usize, name: &str| {
        let values = vec![bar(10.0, 9.0, 11.0); n];
        let names = vec![name; n];
        let all = [Role::Coulomb, Role::HurtadoKim, Role::LuGre];
        panel(&names, all.iter().map(|&role| series("s", role, values.clone())).collect())
    };
    let columns = |n: usize, name: &str| Layout::of(&figure(vec![full(n, name); 2]), ChartWidth::Wide).columns;
    assert_eq!((columns(4, "tip radius"), columns(8, "tip radius")), (2, 1));
    assert_eq!(columns(4, "interferometrically"), 1);
    let wide = Layout::of(&figure(vec![full(100, "a name")]), ChartWidth::Wide);
    assert!(wide.width > 1000.0 && matches!(wide.names, layout::Names::Turned(_)));
}

#[test]
fn on_a_phone_bars_keep_their_width_and_panels_break_into_rows() {
    let roles = [Role::Coulomb, Role::HurtadoKim, Role::LuGre];
    let full = |n: usize, count: usize| {
        let names: Vec<String> = (0..n).map(|i| format!("equivalent modulus {i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let all = roles[..count].iter().map(|&role| series("Hurtado-Kim", role, vec![bar(10.0, 9.0, 11.0); n]));
        panel(&names, all.collect())
    };
    // Factors, series, rows of panels: 264 px hold 20 names of 13 px, or 14 groups of three bars of 5 px / 0.84.
    for (n, count, rows) in [(1, 1, 1), (8, 3, 1), (14, 3, 1), (15, 3, 2), (30, 2, 2), (100, 1, 5)] {
        let chart = figure(vec![full(n, count), full(n, count)]);
        assert_narrow(&Chart::Bars(chart.clone()));
        let svg = chart.svg_at(ChartWidth::Narrow).expect("a figure");
        let document = Document::parse(&svg).expect("well-formed");
        assert_eq!(groups(&document, "panel").len(), 2 * rows, "{n} x {count}");
        let bars = groups(&document, "bars").into_iter().flat_map(|g| g.children().filter(Node::is_element));
        let widths: Vec<f64> = bars.map(|rect| number(&rect, "width")).collect();
        assert_eq!(widths.len(), 2 * n * count);
        assert!(widths.iter().all(|width| *width >= 4.0), "{n} x {count}: {widths:?}");
        let titled = if rows == 1 { "Total".to_owned() } else { format!("Total (1 of {rows})") };
        assert_eq!(texts(groups(&document, "panel")[0])[0], titled);
    }
    let svg = sample().svg_at(ChartWidth::Narrow).expect("a figure");
    one_panel_checks(&sample(), &svg);
}

#[test]
fn lists_of_the_wrong_length_are_refused() {
    assert!(matches!(figure(vec![]).svg(), Err(ChartError::NoPanels { .. })));
    let mut chart = sample();
    chart.panels[0].series[1].values.pop();
    let error = chart.svg().expect_err("too short");
    assert_eq!(error.to_string(), "series \"LuGre\" of panel \"Total\" has 1 values, but the panel has 2 categories");
    let mut chart = sample();
    chart.panels[0].series[0].published.push(None);
    assert!(matches!(chart.svg(), Err(ChartError::Length { what: "published values", found: 3, expected: 2, .. })));
}

fn any_bar() -> impl Strategy<Value = Option<Bar>> {
    let number = || prop_oneof![4 => -20.0..120.0, 1 => prop::num::f64::ANY];
    let interval = prop::option::of((number(), number()));
    prop::option::of((number(), interval).prop_map(|(value, interval)| Bar { value, interval }))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_numbers_and_names_make_a_chart(
        groups in 0_usize..31, count in 0_usize..5, panels in 1_usize..4,
        pool in prop::collection::vec(any_bar(), 40), names in prop::collection::vec("\\PC{0,30}", 7),
    ) {
        let list = |offset: usize| (0..groups).map(|i| pool[(i * 7 + offset) % pool.len()]).collect::<Vec<_>>();
        let of = |p: usize| Panel {
            title: names[0].clone(),
            categories: (0..groups).map(|i| names[i % names.len()].clone()).collect(),
            series: (0..count)
                .map(|j| Series {
                    published: list(j + 3).into_iter().map(|bar| bar.map(|bar| bar.value)).collect(),
                    ..series(&names[j], Role::Other(j), list(j + 11 * p))
                })
                .collect(),
        };
        let svg = figure((0..panels).map(of).collect()).svg().expect("a figure");
        prop_assert!(only_finite(&Document::parse(&svg).expect("well-formed")));
    }

    #[test]
    fn marks_stand_at_any_usual_values(values in prop::collection::vec((-20.0..120.0, 0.0..20.0), 1..12)) {
        let bars = values.iter().map(|&(v, h): &(f64, f64)| bar(v, v - h, v + h / 2.0)).collect();
        let mut coulomb = series("Coulomb", Role::Coulomb, bars);
        coulomb.published = values.iter().map(|&(v, h)| Some(v + 0.3 * h)).collect();
        let chart = figure(vec![panel(&vec!["name"; values.len()], vec![coulomb])]);
        one_panel_checks(&chart, &chart.svg().expect("a figure"));
    }
}
