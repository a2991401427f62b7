//! A map of extremes as a file and as a document.
//!
//! Format `apportion-extremes`, version 2, described key by key in `docs/background/extremes.md`. Later versions only add keys.

use apportion::result::{StudySetup, json};
use apportion::study::Study;
use apportion_report::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use apportion_report::document::{Cell, Document, Figure, Mark, OnPhone, Part, Report, Section, Table};
use apportion_report::format::{grouped, short};
use apportion_report::inputs;
use serde::{Deserialize, Serialize};

use super::map::{Extremes, Grid, Kind, Outcome, Reason, Tally};

/// Maximum number of rows of a chart; the worst ones are shown.
const MAX_ROWS: usize = 30;

/// The file of a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExtremesFile {
    /// Always `apportion-extremes`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// The study.
    pub study: StudySetup,
    /// Version of the program.
    pub apportion_version: String,
    /// Seed of the random points.
    pub seed: u64,
    /// The map.
    #[serde(flatten)]
    pub map: Extremes,
}

/// Builds the document of the map of `study` with random points by `seed`.
pub fn extremes_document(study: &Study, seed: u64, map: Extremes) -> Document {
    let file = &ExtremesFile {
        format: "apportion-extremes".to_owned(),
        version: 2,
        study: study.setup(),
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed,
        map,
    };
    let (map, headline, name) = (&file.map, file.study.headline(), format!("{}-extremes", file.study.name));
    let by = match (&map.second_calculation, &map.unchecked) {
        (Some(second), _) => format!("Checked by {second}."),
        (None, why) => {
            format!("Not checked: {}. Finite numbers count as flagged.", why.as_deref().unwrap_or("-"))
        }
    };
    let meanings = Outcome::ALL.map(|outcome| {
        let (letter, name, meaning) = outcome.words();
        format!("{letter} – {name}: {meaning}.")
    });
    let mut parts: Vec<Part> = vec![counts(map).into(), Part::Text(by), Part::List(meanings.to_vec())];
    for grid in &map.grids {
        parts.push(Figure::unnumbered(chart(headline, grid), format!("{name}-{}", grid.side)).into());
    }
    let reasons = (!map.reasons.is_empty()).then(|| reasons(file).into());
    Report {
        kicker: "A study at its extremes",
        title: headline.to_owned(),
        lead: vec![format!("Of {} numbers at the extremes: {}.", grouped(map.counts.total()), counted(&map.counts))],
        then: vec![
            Section::new("map", "The map", parts),
            Section::new("reasons", "Reasons", reasons.into_iter().collect()),
        ],
        study: Some((&file.study).into()),
        version: &file.apportion_version,
        provenance: vec![("points", grouped(map.points)), ("seed", file.seed.to_string())],
        json: json(file),
        name,
        ..Report::default()
    }
    .document()
}

/// Formats numbers by outcome: `3 right, 0 silently wrong`.
fn counted(tally: &Tally) -> String {
    let shown = Outcome::ALL.into_iter().filter(|&outcome| outcome == Outcome::Wrong || tally.count(outcome) > 0);
    let parts: Vec<String> =
        shown.map(|outcome| format!("{} {}", grouped(tally.count(outcome)), outcome.words().1)).collect();
    parts.join(", ")
}

fn mark(outcome: Outcome, count: u64) -> Mark {
    if outcome == Outcome::Wrong && count > 0 { Mark::Bad } else { Mark::Plain }
}

fn cell(outcome: Outcome, tally: &Tally) -> Cell {
    let count = tally.count(outcome);
    Cell::marked(grouped(count), mark(outcome, count))
}

fn place(kind: Kind) -> &'static str {
    match kind {
        Kind::Corners => "every factor at a bound",
        Kind::Beyond => "one factor at or past its bounds, to 0 and to 10^300",
        Kind::Together => "several factors past their bounds",
    }
}

/// Tabulates the numbers by kind and outcome.
fn counts(map: &Extremes) -> Table {
    let mut rows = Table::from_rows("Numbers at the extremes by outcome.", &map.kinds)
        .text("where", |(kind, _)| place(*kind))
        .sum("all");
    for outcome in Outcome::ALL {
        rows = rows.number(outcome.words().1, |(_, tally)| cell(outcome, tally)).sum(cell(outcome, &map.counts));
    }
    rows.into()
}

/// Tabulates why numbers are not right, each reason with its first number.
fn reasons(file: &ExtremesFile) -> Table {
    let caption = "Reasons for silently wrong, flagged or refused numbers, with the first number of each.";
    let rows = Table::from_rows(caption, &file.map.reasons)
        .text("what", |reason| Cell::marked(reason.outcome.words().1, mark(reason.outcome, reason.count)))
        .named("outcome")
        .text("where", |reason| place(reason.kind))
        .named("where")
        .text("why", |reason| &reason.reason)
        .named("reason")
        .number("numbers", |reason| grouped(reason.count))
        .value("numbers", |reason| reason.count)
        .text("first", |reason| Cell { note: first_number(reason), ..Cell::from(&reason.place) })
        .named("place")
        .file("output", |reason| &reason.output)
        .file("value", |reason| reason.value)
        .file("reference", |reason| reason.reference);
    Table { on_phone: OnPhone::StackLabelled, ..rows.into() }
}

/// Describes the first number of a reason.
fn first_number(reason: &Reason) -> String {
    let numbers = [("", reason.value), (", second calculation ", reason.reference)];
    let numbers: String = numbers.iter().filter_map(|(what, x)| Some(format!("{what}{}", short((*x)?)))).collect();
    format!("{} {numbers}; {}", reason.output, inputs(&reason.inputs))
}

/// Draws the worst outcome of every cell.
fn chart(headline: &str, grid: &Grid) -> Chart {
    let cells = grid.cells.iter().enumerate();
    let cells =
        cells.flat_map(|(row, cells)| cells.iter().enumerate().map(move |(column, tally)| (row, column, tally)));
    let mut tiles: Vec<(Outcome, Tile)> = cells
        .filter_map(|(row, column, tally)| {
            let worst = tally.worst()?;
            Some((worst, Tile { row, column, letter: worst.words().0.to_owned(), tip: counted(tally) }))
        })
        .collect();
    // The legend is in the order of the marks.
    tiles.sort_by_key(|(outcome, tile)| (*outcome, tile.row, tile.column));
    let tiles = tiles.into_iter().map(|(outcome, tile)| {
        let colour = match outcome {
            Outcome::Right => Colour::Series(2),
            Outcome::Flagged | Outcome::FlaggedConfirmed => Colour::Series(9),
            Outcome::Refused => Colour::Series(10),
            Outcome::Wrong => Colour::Reference,
        };
        let (letter, name, _) = outcome.words();
        Series::new(format!("{letter} {name}"), colour).mark(Shape::Tile(tile))
    });
    let side = if grid.side == "below" { "below the lower bound" } else { "above the upper bound" };
    let axis = Axis::from_names(format!("powers of ten {side}"), grid.columns.clone());
    let panel = Panel::new(axis, Axis::from_names("", grid.rows.clone())).with(tiles);
    let wrong: Vec<f64> = grid.cells.iter().map(|cells| cells.iter().map(|tally| tally.wrong as f64).sum()).collect();
    let panel = if wrong.len() > MAX_ROWS { panel.ranked(&wrong, MAX_ROWS) } else { panel };
    let caption = "Each cell shows the worst of its numbers; the JSON file has all rows.";
    Chart::new(format!("{headline}: {side}"), caption).panels([panel])
}
