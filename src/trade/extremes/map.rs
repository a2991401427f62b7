//! The map: outcomes, counts, and the reasons behind them.

use std::collections::BTreeMap;

/// What has become of a number at an extreme.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// It is finite and right: a second calculation has confirmed it.
    Right,
    /// There is none, and a reason is given.
    Refused,
    /// It is finite, and flagged, but a second calculation has confirmed it.
    FlaggedConfirmed,
    /// It is finite, and flagged: it is not to be relied on without a look at the reason.
    Flagged,
    /// It is finite and wrong, by more than anything says. This must not occur.
    Wrong,
}

impl Outcome {
    /// All, the best first.
    pub const ALL: [Self; 5] = [Self::Right, Self::FlaggedConfirmed, Self::Flagged, Self::Refused, Self::Wrong];

    /// In a few words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "finite and right",
            Self::FlaggedConfirmed => "finite and flagged, the number confirmed",
            Self::Flagged => "finite and flagged",
            Self::Refused => "refused with a reason",
            Self::Wrong => "wrong without a word",
        }
    }

    /// The letter in charts.
    pub fn letter(self) -> &'static str {
        match self {
            Self::Right => "R",
            Self::FlaggedConfirmed => "f",
            Self::Flagged => "F",
            Self::Refused => "N",
            Self::Wrong => "W",
        }
    }

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::FlaggedConfirmed => "flagged-confirmed",
            Self::Flagged => "flagged",
            Self::Refused => "refused",
            Self::Wrong => "wrong",
        }
    }
}

/// Numbers by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Finite and right.
    pub right: u64,
    /// Finite and flagged, the number confirmed by a second calculation.
    pub confirmed: u64,
    /// Finite and flagged otherwise.
    pub flagged: u64,
    /// Refused with a reason.
    pub refused: u64,
    /// Wrong without a word.
    pub wrong: u64,
}

impl Tally {
    fn count(&mut self, outcome: Outcome) {
        *match outcome {
            Outcome::Right => &mut self.right,
            Outcome::FlaggedConfirmed => &mut self.confirmed,
            Outcome::Flagged => &mut self.flagged,
            Outcome::Refused => &mut self.refused,
            Outcome::Wrong => &mut self.wrong,
        } += 1;
    }

    /// The number of that outcome.
    pub fn of(&self, outcome: Outcome) -> u64 {
        match outcome {
            Outcome::Right => self.right,
            Outcome::FlaggedConfirmed => self.confirmed,
            Outcome::Flagged => self.flagged,
            Outcome::Refused => self.refused,
            Outcome::Wrong => self.wrong,
        }
    }

    /// All numbers.
    pub fn total(&self) -> u64 {
        Outcome::ALL.iter().map(|outcome| self.of(*outcome)).sum()
    }

    /// The outcome that must be known of: the worst.
    pub fn worst(&self) -> Outcome {
        let met = Outcome::ALL.into_iter().filter(|outcome| self.of(*outcome) > 0);
        met.max().unwrap_or(Outcome::Right)
    }

    /// This and another.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        self.right += other.right;
        self.confirmed += other.confirmed;
        self.flagged += other.flagged;
        self.refused += other.refused;
        self.wrong += other.wrong;
        self
    }
}

/// Where a number was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Every factor at one of its bounds.
    Corners,
    /// All but one factor at one of their bounds.
    Edges,
    /// One factor at its bound, the others nominal.
    Sides,
    /// One factor past its bounds.
    Beyond,
    /// Several factors past their bounds together.
    Together,
    /// Indices of scaled outputs.
    Scale,
    /// Indices of shifted outputs.
    Offset,
    /// Indices by number of base samples.
    Length,
    /// Points at the end of a long design.
    Points,
    /// The memory that a long design takes.
    Memory,
}

impl Kind {
    /// All of them, in order.
    pub const ALL: [Self; 10] = [
        Self::Corners,
        Self::Edges,
        Self::Sides,
        Self::Beyond,
        Self::Together,
        Self::Scale,
        Self::Offset,
        Self::Length,
        Self::Points,
        Self::Memory,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Corners => "corners",
            Self::Edges => "edges",
            Self::Sides => "sides",
            Self::Beyond => "beyond",
            Self::Together => "together",
            Self::Scale => "scale",
            Self::Offset => "offset",
            Self::Length => "length",
            Self::Points => "points",
            Self::Memory => "memory",
        }
    }

    /// What it is, for people.
    pub fn words(self) -> &'static str {
        match self {
            Self::Corners => "corners: every factor at a bound",
            Self::Edges => "edges: all factors but one at a bound",
            Self::Sides => "sides: one factor at a bound",
            Self::Beyond => "one factor past its bounds, to 0 and to 10^300",
            Self::Together => "several factors past their bounds together",
            Self::Scale => "indices of outputs times 1e-300 to 1e300",
            Self::Offset => "indices of outputs plus 1 to 1e15 standard deviations",
            Self::Length => "indices from 2 to 2^30 base samples",
            Self::Points => "points at the end of these designs",
            Self::Memory => "memory of these designs",
        }
    }
}

/// A part of the map that can be drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grid {
    /// What its files end in: `-below`.
    pub suffix: &'static str,
    /// Headline.
    pub title: String,
    /// What the columns are.
    pub axis: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Row by row; nothing was looked at where there is no number.
    pub cells: Vec<Tally>,
}

impl Grid {
    pub(super) fn new(suffix: &'static str, title: &str, axis: &str, rows: Vec<String>, columns: Vec<String>) -> Self {
        let cells = vec![Tally::default(); rows.len() * columns.len()];
        Self { suffix, title: title.to_owned(), axis: axis.to_owned(), rows, columns, cells }
    }

    /// The cell in that row and column.
    pub fn cell(&self, row: usize, column: usize) -> &Tally {
        &self.cells[row * self.columns.len() + column]
    }
}

/// Why numbers came out as they did.
#[derive(Debug, Clone, PartialEq)]
pub struct Reason {
    /// Where.
    pub kind: Kind,
    /// What became of them.
    pub outcome: Outcome,
    /// Why, a sentence without a full stop.
    pub reason: String,
    /// How many.
    pub count: u64,
    /// The first of them.
    pub example: Example,
}

/// A number with what it was made of.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Example {
    /// Where it is on the map, in words.
    pub place: String,
    /// The inputs in the units of the factors, where there are such.
    pub inputs: Vec<(String, f64)>,
    /// The output.
    pub output: String,
    /// The number in the unit of the output.
    pub value: Option<f64>,
    /// The same by the second calculation.
    pub reference: Option<f64>,
}

/// The map of the extremes of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Extremes {
    /// What the model was checked by; or why there was nothing to check it by.
    pub second: Result<String, String>,
    /// Points that the model was evaluated at.
    pub points: u64,
    /// Numbers by where they were looked at.
    pub kinds: Vec<(Kind, Tally)>,
    /// The parts that can be drawn.
    pub grids: Vec<Grid>,
    /// Why numbers are flagged, refused or wrong, in the order of the kinds, the most frequent reason first.
    pub reasons: Vec<Reason>,
}

impl Extremes {
    /// All numbers.
    pub fn counts(&self) -> Tally {
        self.kinds.iter().fold(Tally::default(), |sum, (_, tally)| sum.plus(tally))
    }
}

/// One number of the map.
pub(super) struct Finding {
    pub outcome: Outcome,
    /// Empty for a number that is right.
    pub reason: String,
    /// The number, and by the second calculation.
    pub value: Option<f64>,
    pub reference: Option<f64>,
}

impl Finding {
    pub fn new(outcome: Outcome, reason: impl Into<String>) -> Self {
        Self { outcome, reason: reason.into(), value: None, reference: None }
    }
}

/// A map in the making.
#[derive(Default)]
pub(super) struct Collector {
    kinds: BTreeMap<Kind, Tally>,
    reasons: BTreeMap<(Kind, Outcome, String), (u64, Example)>,
    grids: Vec<Grid>,
}

impl Collector {
    /// Adds a grid; its number is for [`note`](Self::note).
    pub fn grid(&mut self, grid: Grid) -> usize {
        self.grids.push(grid);
        self.grids.len() - 1
    }

    /// Takes note of a number, in the cell (grid, row, column) if it is of one.
    pub fn note(
        &mut self,
        kind: Kind,
        cell: Option<(usize, usize, usize)>,
        finding: Finding,
        example: impl FnOnce() -> Example,
    ) {
        self.kinds.entry(kind).or_default().count(finding.outcome);
        if let Some((grid, row, column)) = cell {
            let grid = &mut self.grids[grid];
            let place = row * grid.columns.len() + column;
            grid.cells[place].count(finding.outcome);
        }
        if finding.outcome != Outcome::Right {
            let Finding { outcome, reason, value, reference } = finding;
            let first = || (0, Example { value, reference, ..example() });
            self.reasons.entry((kind, outcome, reason)).or_insert_with(first).0 += 1;
        }
    }

    pub fn into_map(self, second: Result<String, String>, points: u64) -> Extremes {
        let reason = |((kind, outcome, reason), (count, example))| Reason { kind, outcome, reason, count, example };
        let mut reasons: Vec<Reason> = self.reasons.into_iter().map(reason).collect();
        reasons.sort_by_key(|reason| (reason.outcome != Outcome::Wrong, reason.kind, std::cmp::Reverse(reason.count)));
        Extremes { second, points, kinds: self.kinds.into_iter().collect(), grids: self.grids, reasons }
    }
}
