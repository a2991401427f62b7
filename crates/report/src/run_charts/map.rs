//! Overview of many outputs: a map of factors and outputs, the bars of all outputs together, and a series along its axis.

use apportion::IndexPair;
use apportion::result::{Named, OutputResult, SeriesRecord};
use apportion::uncertainty::Estimate;

use crate::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use crate::factor_bars::{INDEX, MAX_BARS, not_drawn, pair_panel};
use crate::format::{axis_unit, fixed, index, name};
use crate::leading::falling;
use crate::output_view::{IndexOf, OutputView, effect_at};

/// Maximum number of outputs of a map; of more, an even selection is drawn.
const ROWS: usize = 40;
/// Maximum number of factors of a map.
const COLUMNS: usize = 12;
/// Lower limits of the classes of shades; an index below the first is negligible.
const CLASSES: [f64; 8] = [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];

/// Draws total and first-order indices of factors for every output, as shades: a row for each output (of more than 40,
/// an even selection), a column for each factor in the order of the overall total indices (of more than 12, the first).
pub(crate) fn map_chart(view: &OutputView<'_>) -> Chart {
    let mut factors = overall_order(view);
    factors.truncate(COLUMNS);
    let count = view.outputs.len();
    let step = count.div_ceil(ROWS).max(1);
    let outputs: Vec<&OutputResult> = view.outputs.iter().copied().step_by(step).collect();
    let columns: Vec<String> = factors.iter().map(|&factor| name(view.factors[factor])).collect();
    let mut panels = Vec::new();
    for (title, of) in PANELS {
        let mut tiles: Vec<(Option<usize>, Tile)> = Vec::new();
        for (row, output) in outputs.iter().enumerate() {
            for (column, &factor) in factors.iter().enumerate() {
                let estimate = effect_at(output, factor).map(of).filter(|index| index.estimate.is_finite());
                let letter = estimate.map_or_else(|| "–".to_owned(), |index| short(index.estimate));
                let tile = Tile { row, column, letter, tip: estimate.map_or_else(String::new, index) };
                tiles.push((estimate.map(|index| class(index.estimate)), tile));
            }
        }
        // The legend is in the order of the marks.
        tiles.sort_by_key(|(class, tile)| (class.unwrap_or(usize::MAX), tile.row, tile.column));
        let x = Axis::from_names("", columns.clone());
        let y = Axis::from_names("", outputs.iter().map(|output| name(&output.name)).collect());
        let marks = tiles.into_iter().map(|(class, tile)| series(class).mark(Shape::Tile(tile)));
        panels.push(Panel::new(x, y).titled(title).with(marks));
    }
    let shown = if step > 1 { format!(" One of {step} outputs is drawn.") } else { String::new() };
    let caption = format!("Indices of {count} outputs.{shown}{}", not_drawn(view.factors.len(), COLUMNS));
    Chart::new(format!("{}: all outputs at a glance", view.result.study.headline()), caption).panels(panels)
}

/// The panels of both charts. The total indices are above: they show whether a factor matters at all.
const PANELS: [(&str, IndexOf); 2] = [
    ("Total indices S_T: with all interactions", |effect| effect.total),
    ("First-order indices S_1: alone", |effect| effect.first_order),
];

/// Returns the positions of the factors by falling total index over all outputs together, or by their sum if there is
/// none: the order of all tables and charts of many outputs.
pub(crate) fn overall_order(view: &OutputView<'_>) -> Vec<usize> {
    let together = view.together_indices();
    let mut keys = Vec::new();
    for (factor, name) in view.factors.iter().enumerate() {
        keys.push(match together.iter().find(|index| index.name == *name) {
            Some(index) => index.effect.total.estimate,
            None => view.outputs.iter().filter_map(|output| Some(effect_at(output, factor)?.total.estimate)).sum(),
        });
    }
    falling(&keys)
}

pub(super) fn class(index: f64) -> usize {
    CLASSES.iter().filter(|least| index >= **least).count()
}

/// Returns the series of a class; `None` means that there is no index.
pub(super) fn series(class: Option<usize>) -> Series {
    let Some(class) = class else { return Series::new("no indices", Colour::Series(10)) };
    let name = match class {
        0 => format!("below {}", CLASSES[0]),
        _ if class == CLASSES.len() => format!("{} or more", CLASSES[class - 1]),
        _ => format!("{} to {}", CLASSES[class - 1], CLASSES[class]),
    };
    Series::new(name, Colour::Shade(class))
}

/// Formats an index in a cell: `.34`.
pub(super) fn short(index: f64) -> String {
    let text = fixed(index, 2);
    match text.strip_prefix("0.") {
        Some("00") => "0".to_owned(),
        Some(digits) => format!(".{digits}"),
        None => text.replace('-', "\u{2212}"),
    }
}

/// Draws first-order and total indices of all outputs together, the largest total index on top; of more than 20
/// factors, the first 20.
pub(crate) fn together_chart(view: &OutputView<'_>) -> Chart {
    let names = &view.factors;
    let indices: Vec<Option<&Named<IndexPair<Estimate>>>> =
        names.iter().map(|name| view.together_indices().iter().find(|index| index.name == *name)).collect();
    let first_order = indices.iter().map(|index| index.map(|index| index.effect.first_order)).collect();
    let total: Vec<Option<Estimate>> = indices.iter().map(|index| index.map(|index| index.effect.total)).collect();
    let keys: Vec<f64> = total.iter().map(|total| total.map_or(f64::NEG_INFINITY, |total| total.estimate)).collect();
    let panel = pair_panel(names.iter().map(|of| name(of)).collect(), first_order, total, &keys);
    let caption = match view.together.as_ref().filter(|together| together.indices.is_some()) {
        Some(together) => {
            let count = together.outputs.len();
            format!("Over {count} outputs: {}.{}", together.weighting, not_drawn(names.len(), MAX_BARS))
        }
        None => format!("No indices of {}: {}.", view.label, view.reason()),
    };
    Chart::new(format!("{}: {}", view.result.study.headline(), view.label), caption).panels([panel])
}

/// Maximum number of factors with lines: those with the largest mean total index.
const LINES: usize = 8;
/// Range of an index that is drawn: intervals of values that hardly vary are long.
const DRAWN: (f64, f64) = (-0.1, 1.1);

/// Draws total and first-order index of every factor against the axis of a series, with their intervals as bands.
pub(crate) fn along_chart(values: &OutputView<'_>, series: &SeriesRecord) -> Chart {
    let order = overall_order(values);
    let mut panels = Vec::new();
    for (title, of) in PANELS {
        let x = Axis::new(name(&series.axis), axis_unit(&series.axis_unit));
        let mut panel = Panel::new(x, Axis::new(INDEX, "")).titled(title);
        for (rank, &factor) in order.iter().take(LINES).enumerate() {
            let (mut band, mut line) = (Vec::new(), Vec::new());
            for (&x, value) in series.positions.iter().zip(&values.outputs) {
                let index = effect_at(value, factor).map(of);
                let interval = index.and_then(|index| index.interval);
                band.push((x, drawn(interval.map(|i| i.low)), drawn(interval.map(|i| i.high))));
                line.push((x, drawn(index.map(|index| index.estimate))));
            }
            let curves = Series::new(name(values.factors[factor]), Colour::Series(rank));
            panel = panel.with([curves.band(band), curves.line(line)]);
        }
        panels.push(panel);
    }
    let caption =
        format!("Bands are the 95 % intervals of each value, drawn from −0.1 to 1.1.{}", not_drawn(order.len(), LINES));
    let title = format!("{}: indices along the axis of {}", values.result.study.headline(), name(&series.name));
    Chart::new(title, caption).panels(panels)
}

/// Clamps an index to the range that is drawn; NaN for none.
fn drawn(index: Option<f64>) -> f64 {
    index.map_or(f64::NAN, |index| index.clamp(DRAWN.0, DRAWN.1))
}
