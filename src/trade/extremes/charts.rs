//! The parts of the map as charts.

use super::map::{Extremes, Grid, Outcome, Tally};
use crate::report::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};

/// Most rows of a chart; the worst ones are shown.
const MOST_ROWS: usize = 30;

/// The charts, in the order of the grids.
pub(super) fn charts(headline: &str, map: &Extremes) -> Vec<Chart> {
    map.grids.iter().map(|grid| chart(headline, grid)).collect()
}

fn series(outcome: Outcome) -> Series {
    let colour = match outcome {
        Outcome::Right => Colour::Series(2),
        Outcome::Flagged | Outcome::FlaggedConfirmed => Colour::Series(9),
        Outcome::Refused => Colour::Series(10),
        Outcome::Wrong => Colour::Reference,
    };
    Series::new(format!("{} {}", outcome.letter(), outcome.words()), colour)
}

fn chart(headline: &str, grid: &Grid) -> Chart {
    let places = (0..grid.rows.len()).flat_map(|row| (0..grid.columns.len()).map(move |column| (row, column)));
    let looked_at = places.filter(|&(row, column)| grid.cell(row, column).total() > 0);
    let mut tiles: Vec<(Outcome, Tile)> = looked_at
        .map(|(row, column)| {
            let tally = grid.cell(row, column);
            let outcome = tally.worst();
            (outcome, Tile { row, column, letter: outcome.letter().to_owned(), tip: counted(tally) })
        })
        .collect();
    // The legend is in the order of the marks.
    tiles
        .sort_by_key(|(outcome, tile)| (Outcome::ALL.iter().position(|other| other == outcome), tile.row, tile.column));
    let marks = tiles.into_iter().map(|(outcome, tile)| series(outcome).mark(Shape::Tile(tile)));
    let badness = |row: usize| (0..grid.columns.len()).map(|column| grid.cell(row, column).wrong as f64).sum::<f64>();
    let keys: Vec<f64> = (0..grid.rows.len()).map(badness).collect();
    let panel =
        Panel::new(Axis::from_names(grid.axis.clone(), grid.columns.clone()), Axis::from_names("", grid.rows.clone()));
    let hidden = match grid.rows.len().saturating_sub(MOST_ROWS) {
        0 => String::new(),
        more => format!(" {more} more rows, none of which is worse, are in the JSON file."),
    };
    let caption = format!("Each cell shows the worst of its numbers.{}{hidden}", summary(grid));
    let panel = panel.with(marks);
    let panel = if grid.rows.len() > MOST_ROWS { panel.ranked(&keys, MOST_ROWS) } else { panel };
    Chart::new(format!("{headline}: {}", grid.title), caption).panels([panel])
}

/// How many numbers came out how: `3 right, 1 refused`.
fn counted(tally: &Tally) -> String {
    let all = Outcome::ALL.into_iter().filter(|outcome| tally.of(*outcome) > 0);
    all.map(|outcome| format!("{} {}", tally.of(outcome), outcome.words())).collect::<Vec<_>>().join("; ")
}

fn summary(grid: &Grid) -> String {
    let all = grid.cells.iter().fold(Tally::default(), |sum, cell| sum.plus(cell));
    format!(" All numbers: {}.", counted(&all))
}
