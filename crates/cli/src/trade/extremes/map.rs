//! The map: outcomes, counts, and their reasons. Serialised unchanged, see `docs/background/extremes.md`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The outcome of a number at an extreme, from good to bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Finite, and a second calculation agrees.
    Right,
    /// Finite and flagged, but a second calculation agrees.
    FlaggedConfirmed,
    /// Finite and flagged: check the reason before using it.
    Flagged,
    /// There is no number, and a reason is given.
    Refused,
    /// Finite and silently wrong: a second calculation disagrees by more than the model states.
    Wrong,
}

impl Outcome {
    /// All outcomes, in the order of their declaration.
    pub const ALL: [Self; 5] = [Self::Right, Self::FlaggedConfirmed, Self::Flagged, Self::Refused, Self::Wrong];

    /// Returns the letter in charts, a column heading, and the meaning.
    pub(super) fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Right => ("R", "right", "a second calculation agrees"),
            Self::FlaggedConfirmed => {
                ("f", "flagged, confirmed", "the model raises a flag, but a second calculation agrees")
            }
            Self::Flagged => (
                "F",
                "flagged",
                "the model raises a flag, or its stated error is large, or nothing can check the number",
            ),
            Self::Refused => ("N", "refused", "there is no number, and the model states the reason"),
            Self::Wrong => ("W", "silently wrong", "a second calculation disagrees by more than the model states"),
        }
    }
}

/// Counts by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// [`Outcome::Right`].
    pub right: u64,
    /// [`Outcome::FlaggedConfirmed`].
    pub flagged_confirmed: u64,
    /// [`Outcome::Flagged`].
    pub flagged: u64,
    /// [`Outcome::Refused`].
    pub refused: u64,
    /// [`Outcome::Wrong`].
    pub wrong: u64,
}

impl Tally {
    /// Counts a number.
    fn add(&mut self, outcome: Outcome) {
        *self.numbers()[outcome as usize] += 1;
    }

    /// Returns the number of `outcome`.
    pub fn count(mut self, outcome: Outcome) -> u64 {
        *self.numbers()[outcome as usize]
    }

    /// Returns the counts in the order of [`Outcome::ALL`].
    fn numbers(&mut self) -> [&mut u64; Outcome::ALL.len()] {
        let Self { right, flagged_confirmed, flagged, refused, wrong } = self;
        [right, flagged_confirmed, flagged, refused, wrong]
    }

    /// Returns the total.
    pub fn total(&self) -> u64 {
        Outcome::ALL.iter().map(|outcome| self.count(*outcome)).sum()
    }

    /// Returns the worst outcome that occurred; `None` without numbers.
    pub fn worst(&self) -> Option<Outcome> {
        Outcome::ALL.into_iter().rev().find(|outcome| self.count(*outcome) > 0)
    }
}

/// Where the model was evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Every factor at one of its bounds.
    Corners,
    /// One factor at its bound or past it.
    Beyond,
    /// Several factors past their bounds together.
    Together,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Corners, Self::Beyond, Self::Together];
}

/// Numbers with one factor at or past its bound: the content of a chart.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Grid {
    /// Which bounds: `below` or `above`.
    pub side: String,
    /// The factors.
    pub rows: Vec<String>,
    /// Distances past the bound: powers of ten, or a special number.
    pub columns: Vec<String>,
    /// `rows` by `columns` cells; all zero if the model was not evaluated.
    pub cells: Vec<Vec<Tally>>,
}

/// A reason why numbers are not right, and the first of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reason {
    /// The kind of points.
    pub kind: Kind,
    /// Their outcome.
    pub outcome: Outcome,
    /// The reason, a sentence without a full stop.
    pub reason: String,
    /// Number of values with this reason.
    pub count: u64,
    /// The place of the first of them, in words.
    pub place: String,
    /// Its inputs, in the units of the factors.
    pub inputs: Map<String, Value>,
    /// Its output.
    pub output: String,
    /// The number in the unit of the output; `None` if refused.
    pub value: Option<f64>,
    /// The same by the second calculation, if there is one.
    pub reference: Option<f64>,
}

/// The map of the extremes of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// The method of the second calculation; `None` if there is none.
    pub second_calculation: Option<String>,
    /// Why there is none.
    pub unchecked: Option<String>,
    /// Number of points at which the model was evaluated.
    pub points: u64,
    /// All numbers.
    pub counts: Tally,
    /// The same by kind of points.
    pub kinds: Vec<(Kind, Tally)>,
    /// The parts of the map that are drawn.
    pub grids: Vec<Grid>,
    /// Why numbers are not right: silently wrong ones first, then by kind, the most frequent reason first.
    pub reasons: Vec<Reason>,
}

/// The reasons collected so far.
pub(super) type Reasons = BTreeMap<(Kind, Outcome, String), Reason>;

impl Extremes {
    /// Adds a number, in the cell (grid, row, column) if it belongs to one.
    pub(super) fn add(&mut self, cell: Option<(usize, usize, usize)>, reason: Reason, reasons: &mut Reasons) {
        self.counts.add(reason.outcome);
        self.kinds[reason.kind as usize].1.add(reason.outcome);
        if let Some((grid, row, column)) = cell {
            self.grids[grid].cells[row][column].add(reason.outcome);
        }
        if reason.outcome != Outcome::Right {
            let key = (reason.kind, reason.outcome, reason.reason.clone());
            reasons.entry(key).or_insert(reason).count += 1;
        }
    }
}
