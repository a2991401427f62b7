//! Vertical rules and the labels above them.

use resvg::usvg::roxmltree::{Document, Node};

use super::reading::{groups, number, plot, width};
use super::*;

/// A label of a rule as drawn, px.
#[derive(Debug)]
struct Flag {
    pole: f64,
    from: f64,
    to: f64,
    /// Zero next to the plot.
    row: usize,
}

/// Draws rules on an axis from 0 to 100; returns their flags, and the ends of the plot.
fn flags(rules: &[(f64, &str)]) -> (Vec<Flag>, [f64; 2]) {
    let line = series(0).line(vec![(0.0, 0.0), (100.0, 1.0)]);
    let marks = rules.iter().map(|(x, label)| Mark::rule(*x, *label)).chain([line]);
    let svg = svg(vec![Panel::new(Axis::new("Time", "ms"), Axis::new("", "")).with(marks)]);
    let document = Document::parse(&svg).expect("well-formed");
    let [left, top, right, _] = plot(&document);
    let all: Vec<Node> = groups(&document, "rules").into_iter().flat_map(|group| group.descendants()).collect();
    let poles = all.iter().filter(|node| node.has_tag_name("line")).map(|line| number(line, "x1"));
    let flag = |(pole, text): (f64, &Node)| {
        let from = number(text, "x");
        let row = ((top - 4.0 - number(text, "y")) / 13.0).round() as usize;
        Flag { pole, from, to: from + width(text.text().unwrap(), 10.5), row }
    };
    (poles.zip(all.iter().filter(|node| node.has_tag_name("text"))).map(flag).collect(), [left, right])
}

#[test]
fn neighbours_take_rows_and_the_last_turns_left() {
    let (placed, [left, right]) = flags(&[(10.0, "0123 45678"), (12.0, "0123 45678"), (99.0, "9876 54321 0")]);
    let expected = [(12.0, 0), (10.0, 1), (99.0, 0)];
    assert_eq!(placed.len(), expected.len());
    for (flag, (x, row)) in placed.iter().zip(expected) {
        assert!((flag.pole - left - x / 100.0 * (right - left)).abs() < 0.011 && flag.row == row, "{placed:?}");
    }
    assert!(placed[0].from > placed[0].pole && placed[2].to < placed[2].pole);
    assert!(flags(&[(f64::NAN, "0")]).0.is_empty());
}

proptest! {
    #[test]
    fn distant_flags_never_collide(steps in prop::collection::vec(1.0..30.0, 1..8)) {
        let mut at = -1.0;
        let markers: Vec<_> = steps
            .iter()
            .map(|step| { at += step; (at, "0123 45678") })
            .filter(|(x, _)| (0.0..=100.0).contains(x))
            .collect();
        let (placed, [left, right]) = flags(&markers);
        prop_assert_eq!(placed.len(), markers.len());
        // A gap of 4 px, and coordinates of two decimals.
        let gap = 4.0 - 0.011;
        let crossed = |flag: &Flag, by: &Flag| {
            by.row >= flag.row && flag.from - gap < by.pole && by.pole < flag.to + gap
        };
        for (i, flag) in placed.iter().enumerate() {
            for other in &placed[..i] {
                let covered = flag.row == other.row && flag.from - gap < other.to && other.from - gap < flag.to;
                prop_assert!(!covered && !crossed(flag, other) && !crossed(other, flag), "{placed:?}");
            }
            prop_assert!(flag.from >= left - 0.011 && flag.to <= right + 0.011);
        }
    }
}
