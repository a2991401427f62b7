//! The map: outcomes, counts, and their reasons.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

/// The outcome of a number at an extreme, from good to bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
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
}

/// Counts by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
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
}

/// Where the model was evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
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

/// A reason why numbers are not right, and the first of them.
#[derive(Debug, Clone, PartialEq)]
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
#[derive(Debug, Clone, PartialEq)]
pub struct Extremes {
    /// The method of the second calculation; `None` if there is none.
    pub second_calculation: Option<String>,
    /// All numbers.
    pub counts: Tally,
    /// The same by kind of points.
    pub kinds: Vec<(Kind, Tally)>,
    /// Why numbers are not right: silently wrong ones first, then by kind, the most frequent reason first.
    pub reasons: Vec<Reason>,
}

/// The reasons collected so far.
pub type Reasons = BTreeMap<(Kind, Outcome, String), Reason>;

impl Extremes {
    /// Adds a number.
    pub fn add(&mut self, reason: Reason, reasons: &mut Reasons) {
        self.counts.add(reason.outcome);
        self.kinds[reason.kind as usize].1.add(reason.outcome);
        if reason.outcome != Outcome::Right {
            let key = (reason.kind, reason.outcome, reason.reason.clone());
            reasons.entry(key).or_insert(reason).count += 1;
        }
    }
}
