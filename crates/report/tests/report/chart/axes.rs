//! Scales, ticks and their labels.

use resvg::usvg::roxmltree::Document;

use super::Spacing::{Linear, Logarithmic};
use super::reading::{groups, number, path_numbers, plot, texts_of_size, width};
use super::*;

/// Size of the labels of ticks, px.
const TICK: f64 = 10.5;

/// A horizontal axis as drawn, px.
#[derive(Debug)]
struct Drawn {
    /// The middles of the labels of the ticks, and the labels.
    ticks: Vec<(f64, String)>,
    /// The grid lines, those without a label first.
    grid: Vec<f64>,
    title: String,
    left: f64,
    right: f64,
    /// The places of the values.
    places: Vec<f64>,
}

impl Drawn {
    fn labels(&self) -> Vec<&str> {
        self.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }
}

/// Draws a line of these values, or a point for each, in so many plots side by side.
fn drawn(values: &[f64], spacing: Spacing, stroke: Stroke, (page, plots): (ChartWidth, usize)) -> Drawn {
    let line = series(0).stroke(stroke).line(values.iter().map(|x| (*x, 1.0)).collect());
    let panel = Panel::new(Axis::new("x", "").spaced(spacing), Axis::new("", "")).with([line]);
    let svg = chart(vec![panel; plots]).side_by_side().svg_at(page);
    let document = Document::parse(&svg).expect("well-formed");
    let axis = groups(&document, "x-axis")[0];
    let grid = groups(&document, "x-grid")[0].descendants().filter(|node| node.has_tag_name("line"));
    let [left, _, right, _] = plot(&document);
    let paths = groups(&document, "series")[0].children().filter(|node| node.has_tag_name("path"));
    let place = |path| match path_numbers(&path)[..] {
        // A symbol after the first two numbers.
        [x, _, ..] if path.attribute("class") == Some("point") => vec![x],
        ref numbers => numbers.iter().copied().step_by(2).collect(),
    };
    Drawn {
        ticks: texts_of_size(axis, "10.5")
            .into_iter()
            .map(|(node, text)| (number(&node, "x"), text.to_owned()))
            .collect(),
        grid: grid.map(|line| number(&line, "x1")).collect(),
        title: texts_of_size(axis, "11")[0].1.to_owned(),
        left,
        right,
        places: paths.flat_map(place).collect(),
    }
}

fn scale(values: &[f64], spacing: Spacing) -> Drawn {
    drawn(values, spacing, Stroke::Solid, (ChartWidth::Wide, 1))
}

/// A plot some 140 px wide.
const SHORT: (ChartWidth, usize) = (ChartWidth::Narrow, 2);

#[test]
fn linear_ticks_are_round() {
    let s = scale(&[0.0, 57.4], Linear);
    assert_eq!(s.labels(), ["0", "10", "20", "30", "40", "50"]);
    // The axis ends with the values.
    assert_eq!((&s.places[..], &*s.title), (&[s.left, s.right][..], "x"));
    let labels = ["\u{2212}0.05", "0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"];
    assert_eq!(scale(&[-0.07, 0.31], Linear).labels(), labels);
    let s = scale(&[3.0e-9, 21.0e-9], Linear);
    assert_eq!((s.labels(), &*s.title), (vec!["4", "6", "8", "10", "12", "14", "16", "18", "20"], "x (×10⁻⁹)"));
    let s = scale(&[-2.5e6, 1.0e6], Linear);
    let labels = ["\u{2212}2.5", "\u{2212}2.0", "\u{2212}1.5", "\u{2212}1.0", "\u{2212}0.5", "0.0", "0.5", "1.0"];
    assert_eq!((s.labels(), &*s.title), (labels.to_vec(), "x (×10⁶)"));
    assert_eq!(scale(&[1e-12, 2e-12], Linear).title, "x (×10⁻¹²)");
}

#[test]
fn logarithmic_ticks_are_decades() {
    assert_eq!(scale(&[1e-8, 1e-3], Logarithmic).labels(), ["10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
    assert_eq!(scale(&[1e-2, 1e5], Logarithmic).labels()[2], "10⁰");
    assert_eq!(scale(&[0.05, 3.0], Logarithmic).labels(), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
    assert!((5..=9).contains(&scale(&[1e-100, 1e100], Logarithmic).ticks.len()));
    assert_eq!(scale(&[40.0, 60.0], Logarithmic).labels(), ["40", "45", "50", "55", "60"]);
    // Both ends of f64's usable range: the ratio overflows, the positions do not.
    let s = scale(&[1e-289, 1e300], Logarithmic);
    assert!(s.places[0] - s.left < 1.0 && s.right - s.places[1] < 1.0, "{s:?}");
}

#[test]
fn labels_without_room_leave_their_grid_lines() {
    let short = |values: &[f64], spacing| drawn(values, spacing, Stroke::Solid, SHORT);
    let s = short(&[1234.0, 1234.0005], Linear);
    assert_eq!((s.labels(), s.grid.len()), (vec!["1234.0000", "1234.0004"], 3));
    let s = short(&[0.05, 3.0], Logarithmic);
    assert_eq!(s.labels(), ["0.1", "1"]);
    let s = short(&[1e-18, 1e-3], Logarithmic);
    assert_eq!(s.labels(), ["10⁻¹⁸", "10⁻¹⁴", "10⁻¹⁰", "10⁻⁶"]);
    // A narrower plot: no two labels have room.
    let column = (ChartWidth::Paper("60mm".parse().unwrap()), 2);
    let s = drawn(&[1_234_567.000_5, 1_234_567.003_5], Linear, Stroke::Solid, column);
    assert_eq!((s.labels().len(), s.grid.len()), (1, 3), "{s:?}");
}

#[test]
fn a_single_value_is_in_the_middle_of_a_logarithmic_axis() {
    let s = scale(&[-1.0, 0.0, 5.0], Logarithmic);
    // Coordinates have two decimals.
    assert!(s.places.len() == 1 && (s.places[0] - (s.left + s.right) / 2.0).abs() < 0.011, "{s:?}");
}

proptest! {
    #[test]
    fn any_values_give_a_usable_scale(
        values in prop::collection::vec(prop::num::f64::ANY, 0..6), near in any::<bool>(), log in any::<bool>(),
        points in any::<bool>(), short in any::<bool>(),
    ) {
        let values: Vec<f64> = match near {
            // Also nearly equal values, which random f64 hardly ever are.
            true => values.iter().map(|v| 1.0 + v.fract() * 1e-8).collect(),
            false => values,
        };
        let stroke = if points { Stroke::Points } else { Stroke::Solid };
        let place = if short { SHORT } else { (ChartWidth::Wide, 1) };
        let s = drawn(&values, if log { Logarithmic } else { Linear }, stroke, place);
        prop_assert!((1..=12).contains(&s.ticks.len()), "{:?}", s);
        prop_assert!(s.grid.len() < 62, "{:?}", s);
        // Every value and tick is on the axis, to the two decimals of coordinates.
        for place in s.places.iter().chain(s.ticks.iter().map(|(at, _)| at)) {
            prop_assert!((s.left - 0.011..=s.right + 0.011).contains(place), "{place} in {:?}", s);
        }
        for pair in s.ticks.windows(2) {
            let [(from, one), (to, other)] = [&pair[0], &pair[1]];
            prop_assert!(from < to && one != other, "{:?}", s);
            let is_plain = |label: &str| label.chars().all(|c| c.is_ascii_digit() || ".\u{2212}".contains(c));
            if is_plain(one) && is_plain(other) {
                let widths = (width(one, TICK) + width(other, TICK)) / 2.0;
                prop_assert!(to - from >= widths + 6.0 - 0.011, "{:?}", s);
            }
        }
    }
}
