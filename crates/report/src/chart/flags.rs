//! Labels of vertical rules above a plot, each attached to its rule like a flag to its pole.

use super::plot::Plot;
use super::scale::Scale;
use super::style::{ChartWidth, MUTED, TICK};
use super::svg::{Canvas, Text};
use super::text::shorten;

/// Distance of rows, px.
const ROW: f64 = 13.0;
/// Gap between a pole and its flag, and between flags of one row, px.
const GAP: f64 = 4.0;
/// Length of the longest label, px; longer ones are shortened.
const LONGEST: f64 = 240.0;

/// A label with its position.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Flag<'a> {
    label: &'a str,
    text: String,
    /// Of the marked line, px.
    pole: f64,
    /// Left and right end of the text, px.
    from: f64,
    to: f64,
    /// Zero next to the plot.
    row: usize,
}

impl Flag<'_> {
    /// Returns whether one covers the other or is crossed by its pole.
    fn collides(&self, other: &Flag) -> bool {
        let is_covered = self.row == other.row && self.from - GAP < other.to && other.from - GAP < self.to;
        is_covered || self.is_crossed_by(other) || other.is_crossed_by(self)
    }

    /// Returns whether the pole of the other one crosses it.
    fn is_crossed_by(&self, other: &Flag) -> bool {
        other.row >= self.row && self.from - GAP < other.pole && other.pole < self.to + GAP
    }
}

/// Places the flags of the rules (place, label) of a panel, each in the lowest row where it collides with none. Flags
/// point right unless they would leave the plot or cross the pole of a flag that points left. Rules without a position
/// on the axis have no flag.
pub(super) fn place<'a>(
    rules: impl Iterator<Item = (f64, &'a str)>,
    x: &Scale,
    plot: &Plot,
    page: ChartWidth,
) -> Vec<Flag<'a>> {
    let longest = LONGEST.min(plot.width / page.choose(3.0, 2.0));
    let mut shown: Vec<_> = rules.filter_map(|(at, label)| Some((plot.x(x, at)?, label))).collect();
    shown.sort_by(|a, b| b.0.total_cmp(&a.0));
    // From the right: the position where the next flag must end.
    let mut end = plot.right();
    let (mut right, mut left) = (Vec::new(), Vec::new());
    for (pole, label) in shown {
        let text = shorten(label, longest, TICK);
        let width = TICK.width(&text);
        if pole + GAP + width <= end {
            right.push(Flag { label, text, pole, from: pole + GAP, to: pole + GAP + width, row: 0 });
        } else {
            end = pole - GAP;
            let text = shorten(label, longest.min(end - plot.left), TICK);
            let width = TICK.width(&text);
            left.push(Flag { label, text, pole, from: end - width, to: end, row: 0 });
        }
    }
    // In this order the pole of each flag does not touch the flags before it.
    let mut flags: Vec<Flag> = Vec::new();
    for mut flag in right.into_iter().chain(left.into_iter().rev()) {
        // Only poles closer than a gap can leave no free row.
        while flag.row <= flags.len() && flags.iter().any(|other| other.collides(&flag)) {
            flag.row += 1;
        }
        flags.push(flag);
    }
    flags
}

/// Returns the height of the flags above the plot, px.
pub(super) fn room(flags: &[Flag]) -> f64 {
    flags.iter().map(|flag| (flag.row + 1) as f64 * ROW + 3.0).fold(0.0, f64::max)
}

/// Draws poles and flags.
pub(super) fn draw(canvas: &mut Canvas, plot: &Plot, flags: &[Flag]) {
    if flags.is_empty() {
        return;
    }
    canvas.open("g", &[("class", &"rules")]);
    canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"1"), ("stroke-dasharray", &"4 3")]);
    for flag in flags {
        canvas.line((flag.pole, plot.bottom()), (flag.pole, plot.top - room(std::slice::from_ref(flag)) + 3.0));
    }
    canvas.close("g");
    for flag in flags {
        let at = (flag.from, plot.top - 4.0 - flag.row as f64 * ROW);
        canvas.text(&Text::new(&flag.text, at, TICK).tooltip(flag.label));
    }
    canvas.close("g");
}
