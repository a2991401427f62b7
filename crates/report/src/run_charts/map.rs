//! Overview of many outputs: a map of factors and outputs, the bars of all outputs together, and a series along its axis.

use apportion::result::{IndexRecord, OutputResult, PlainIndexRecord, SeriesRecord, StudyResult};
use apportion::uncertainty::Estimate;

use crate::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape, Tile};
use crate::factor_bars::{INDEX, MAX_BARS, not_drawn, pair_panel};
use crate::format::{axis_unit, fixed, index, name};
use crate::leading::falling;
use crate::wording::weighting;

/// Maximum number of outputs of a map; of more, an even selection is drawn.
const ROWS: usize = 40;
/// Maximum number of factors of a map.
const COLUMNS: usize = 12;
/// Lower limits of the classes of shades; an index below the first is negligible.
const CLASSES: [f64; 8] = [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];

/// Draws total and first-order indices of factors for every output, as shades: a row for each output (of more than 40,
/// an even selection), a column for each factor in the order of the overall total indices (of more than 12, the first).
pub(crate) fn map_chart(result: &StudyResult) -> Chart {
    let (names, mut factors) = (result.indexed_names(), overall_order(result));
    factors.truncate(COLUMNS);
    let all = result.outputs.len();
    let step = all.div_ceil(ROWS).max(1);
    let outputs: Vec<_> = result.outputs.iter().step_by(step).collect();
    let panel = |title: &str, of: fn(&IndexRecord) -> Estimate| {
        let mut tiles: Vec<(Option<usize>, Tile)> = Vec::new();
        for (row, output) in outputs.iter().enumerate() {
            for (column, &factor) in factors.iter().enumerate() {
                let found = output.indices.as_ref().and_then(|all| all.get(factor)).map(of);
                let found = found.filter(|index| index.estimate.is_finite());
                let letter = found.map_or_else(|| "–".to_owned(), |found| short(found.estimate));
                let tile = Tile { row, column, letter, tip: found.map_or_else(String::new, index) };
                tiles.push((found.map(|found| class(found.estimate)), tile));
            }
        }
        // The legend is in the order of the marks.
        tiles.sort_by_key(|(class, tile)| (class.unwrap_or(usize::MAX), tile.row, tile.column));
        let x = Axis::from_names("", factors.iter().map(|&factor| name(names[factor])).collect());
        let y = Axis::from_names("", outputs.iter().map(|output| name(&output.name)).collect());
        let marks = tiles.into_iter().map(|(class, tile)| series(class).mark(Shape::Tile(tile)));
        Panel::new(x, y).titled(title).with(marks)
    };
    // The total indices are above: they show whether a factor matters at all.
    let panels = [
        panel("Total indices S_T: with all interactions", |index| index.effect.total),
        panel("First-order indices S_1: alone", |index| index.effect.first_order),
    ];
    let shown = if step > 1 { format!(" One of {step} outputs is drawn.") } else { String::new() };
    let caption = format!("Indices of {all} outputs.{shown}{}", not_drawn(names.len(), COLUMNS));
    Chart::new(format!("{}: all outputs at a glance", result.study.headline()), caption).panels(panels)
}

/// Returns the positions of the factors by falling total index over all outputs together, or by their sum if there is
/// none: the order of all tables and charts of many outputs.
pub(crate) fn overall_order(result: &StudyResult) -> Vec<usize> {
    let together = together(result);
    let known = result.outputs.iter().filter_map(|output| output.indices.as_ref());
    let sum = |factor: usize| known.clone().filter_map(|all| Some(all.get(factor)?.effect.total.estimate)).sum::<f64>();
    let key = |(factor, name): (usize, &str)| {
        let own = together.iter().find(|index| index.factor == name);
        own.map_or_else(|| sum(factor), |index| index.total.estimate)
    };
    falling(&result.indexed_names().into_iter().enumerate().map(key).collect::<Vec<f64>>())
}

/// Returns the indices of all outputs together, if there are any.
pub(crate) fn together(result: &StudyResult) -> &[PlainIndexRecord] {
    result.aggregate.as_ref().and_then(|aggregate| aggregate.indices.as_deref()).unwrap_or_default()
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
pub(crate) fn together_chart(result: &StudyResult) -> Chart {
    let (indices, names) = (together(result), result.indexed_names());
    let factors: Vec<String> = names.iter().map(|of| name(of)).collect();
    let of = |which: fn(&PlainIndexRecord) -> Estimate| -> Vec<Option<Estimate>> {
        let find = |name: &str| indices.iter().find(|index| index.factor == name).map(which);
        names.iter().map(|name| find(name)).collect()
    };
    let (first_order, total) = (of(|index| index.first_order), of(|index| index.total));
    let keys: Vec<f64> = total.iter().map(|total| total.map_or(f64::NEG_INFINITY, |total| total.estimate)).collect();
    let panel = pair_panel(factors, first_order, total, &keys);
    let caption = match &result.aggregate {
        Some(aggregate) if aggregate.indices.is_some() => {
            let count = aggregate.outputs.len();
            format!("Over {count} outputs: {}.{}", weighting(aggregate.weighting), not_drawn(names.len(), MAX_BARS))
        }
        aggregate => {
            let reason = aggregate.as_ref().and_then(|aggregate| aggregate.reason.as_deref());
            format!("No indices of all outputs together: {}.", reason.unwrap_or("the result has none"))
        }
    };
    Chart::new(format!("{}: all outputs together", result.study.headline()), caption).panels([panel])
}

/// Maximum number of factors with lines: those with the largest mean total index.
const LINES: usize = 8;
/// Range of an index that is drawn: intervals of values that hardly vary are long.
const DRAWN: (f64, f64) = (-0.1, 1.1);

/// Returns the values of a series, in order.
pub(crate) fn values<'a>(result: &'a StudyResult, series: &SeriesRecord) -> &'a [OutputResult] {
    &result.outputs[series.places()]
}

/// Returns the positions of the factors by falling total index over the series, or by the sum over its values.
fn order_of(result: &StudyResult, series: &SeriesRecord) -> Vec<usize> {
    let total = |value: &OutputResult, factor: usize| {
        value.indices.as_ref().and_then(|all| all.get(factor)).map_or(0.0, |index| index.effect.total.estimate)
    };
    let key = |factor: usize| match &series.indices {
        Some(indices) => indices.get(factor).map_or(0.0, |index| index.total.estimate),
        None => values(result, series).iter().map(|value| total(value, factor)).sum(),
    };
    falling(&(0..result.indexed_names().len()).map(key).collect::<Vec<f64>>())
}

/// Draws total and first-order index of every factor against the axis, with their intervals as bands.
pub(crate) fn along_chart(result: &StudyResult, series: &SeriesRecord) -> Chart {
    let (order, names) = (order_of(result, series), result.indexed_names());
    let positions = &series.positions;
    let panel = |title: &str, read: fn(&IndexRecord) -> Estimate| {
        let marks = order.iter().take(LINES).enumerate().flat_map(|(rank, &factor)| -> [Mark; 2] {
            let curves = Series::new(name(names[factor]), Colour::Series(rank));
            let index = |value: &OutputResult| value.indices.as_ref()?.get(factor).map(read);
            let drawn = |x: Option<f64>| x.map_or(f64::NAN, |x| x.clamp(DRAWN.0, DRAWN.1));
            let curve = || positions.iter().zip(values(result, series)).map(|(x, value)| (*x, index(value)));
            let band = curve().map(|(x, of)| {
                let interval = of.and_then(|of| of.interval);
                (x, drawn(interval.map(|i| i.low)), drawn(interval.map(|i| i.high)))
            });
            let line = curve().map(|(x, of)| (x, drawn(of.map(|of| of.estimate))));
            [curves.band(band.collect()), curves.line(line.collect())]
        });
        let x = Axis::new(name(&series.axis), axis_unit(&series.axis_unit));
        Panel::new(x, Axis::new(INDEX, "")).titled(title).with(marks)
    };
    let panels = [
        panel("Total indices S_T: with all interactions", |index| index.effect.total),
        panel("First-order indices S_1: alone", |index| index.effect.first_order),
    ];
    let caption =
        format!("Bands are the 95 % intervals of each value, drawn from −0.1 to 1.1.{}", not_drawn(order.len(), LINES));
    let title = format!("{}: indices along the axis of {}", result.study.headline(), name(&series.name));
    Chart::new(title, caption).panels(panels)
}
