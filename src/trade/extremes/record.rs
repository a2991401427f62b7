//! The file of a map of extremes: JSON that other programs can rely on.
//!
//! Format `apportion-extremes`, version 1, described key by key in `docs/extremes.md`. Later versions of the program only add
//! keys. A number that does not exist is `null`.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::map::{Extremes, Grid, Outcome, Reason, Tally};
use super::{ExtremesSettings, Kind};
use crate::report::{StudySetup, study_setup};
use crate::study::Study;

/// A map of extremes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExtremesFile {
    /// Always `apportion-extremes`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// What was asked.
    pub study: StudySetup,
    /// How it was answered.
    pub provenance: ExtremesProvenance,
    /// All numbers by outcome.
    pub counts: TallyRecord,
    /// The same by where they were looked at.
    pub kinds: Vec<KindRecord>,
    /// The parts of the map that can be drawn.
    pub grids: Vec<GridRecord>,
    /// Why numbers are flagged, refused or wrong.
    pub reasons: Vec<ReasonRecord>,
}

/// How a map was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExtremesProvenance {
    /// Version of the program.
    pub apportion_version: String,
    /// Points that the model was evaluated at.
    pub points: u64,
    /// Most model runs for the indices of one design.
    pub max_runs: u64,
    /// Seed of the points chosen at random.
    pub seed: u64,
    /// What the model was checked by; `null` if by nothing.
    pub second_calculation: Option<String>,
    /// Why by nothing.
    pub unchecked: Option<String>,
}

/// Numbers by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TallyRecord {
    /// Finite and right.
    pub right: u64,
    /// Finite and flagged; the confirmed ones are not among them.
    pub flagged: u64,
    /// Finite and flagged, the number confirmed by a second calculation.
    pub flagged_confirmed: u64,
    /// Refused with a reason.
    pub refused: u64,
    /// Wrong without a word.
    pub wrong: u64,
}

/// Numbers of one kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KindRecord {
    /// Its name.
    pub kind: String,
    /// What it is.
    pub description: String,
    /// Its numbers by outcome.
    pub counts: TallyRecord,
}

/// A part of the map.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GridRecord {
    /// What it shows.
    pub title: String,
    /// What its columns are.
    pub axis: String,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Row by row the cells; `null` where nothing was looked at.
    pub cells: Vec<Vec<Option<CellRecord>>>,
}

/// A cell of the map.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellRecord {
    /// The worst outcome of its numbers.
    pub outcome: String,
    /// Its numbers by outcome.
    pub counts: TallyRecord,
}

/// A reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReasonRecord {
    /// The kind of the numbers.
    pub kind: String,
    /// `flagged`, `flagged-confirmed`, `refused` or `wrong`.
    pub outcome: String,
    /// Why.
    pub reason: String,
    /// Numbers with this reason.
    pub count: u64,
    /// Where the first of them is on the map.
    pub place: String,
    /// Its inputs in the units of the factors; empty where there are none.
    pub inputs: Map<String, Value>,
    /// Its output.
    pub output: String,
    /// The number, in the unit of the output; of indices, how far they are off.
    pub value: Option<f64>,
    /// The same by the second calculation.
    pub reference: Option<f64>,
}

/// The file of the map of `study`.
pub fn build_extremes(study: &Study, settings: ExtremesSettings, map: &Extremes) -> ExtremesFile {
    ExtremesFile {
        format: "apportion-extremes".to_owned(),
        version: 1,
        study: study_setup(study),
        provenance: ExtremesProvenance {
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            points: map.points,
            max_runs: settings.max_runs,
            seed: settings.seed,
            second_calculation: map.second.as_ref().ok().cloned(),
            unchecked: map.second.as_ref().err().cloned(),
        },
        counts: (&map.counts()).into(),
        kinds: map.kinds.iter().map(kind).collect(),
        grids: map.grids.iter().map(grid).collect(),
        reasons: map.reasons.iter().map(reason).collect(),
    }
}

impl From<&Tally> for TallyRecord {
    fn from(tally: &Tally) -> Self {
        let &Tally { right, confirmed, flagged, refused, wrong } = tally;
        Self { right, flagged, flagged_confirmed: confirmed, refused, wrong }
    }
}

impl TallyRecord {
    pub(super) fn of(&self, outcome: Outcome) -> u64 {
        match outcome {
            Outcome::Right => self.right,
            Outcome::FlaggedConfirmed => self.flagged_confirmed,
            Outcome::Flagged => self.flagged,
            Outcome::Refused => self.refused,
            Outcome::Wrong => self.wrong,
        }
    }
}

fn kind((kind, tally): &(Kind, Tally)) -> KindRecord {
    KindRecord { kind: kind.name().to_owned(), description: kind.words().to_owned(), counts: tally.into() }
}

fn grid(grid: &Grid) -> GridRecord {
    let cell = |tally: &Tally| {
        let outcome = tally.worst().name().to_owned();
        (tally.total() > 0).then(|| CellRecord { outcome, counts: tally.into() })
    };
    GridRecord {
        title: grid.title.clone(),
        axis: grid.axis.clone(),
        rows: grid.rows.clone(),
        columns: grid.columns.clone(),
        cells: grid.cells.chunks(grid.columns.len().max(1)).map(|row| row.iter().map(cell).collect()).collect(),
    }
}

fn reason(reason: &Reason) -> ReasonRecord {
    let Reason { kind, outcome, reason, count, example } = reason;
    let inputs = example.inputs.iter().map(|(name, value)| (name.clone(), Value::from(*value)));
    ReasonRecord {
        kind: kind.name().to_owned(),
        outcome: outcome.name().to_owned(),
        reason: reason.clone(),
        count: *count,
        place: example.place.clone(),
        inputs: inputs.collect(),
        output: example.output.clone(),
        value: example.value.filter(|value| value.is_finite()),
        reference: example.reference.filter(|value| value.is_finite()),
    }
}
