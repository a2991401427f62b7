//! Many outputs at a glance: a map of factors and outputs, and the bars of all outputs together.

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape, Tile};
use super::super::factor_bars::{left_out, not_drawn, pair_panel};
use super::super::format::{fixed, index, name};
use super::super::output_axis::OutputAxis;
use super::super::result::{AggregateIndexRecord, EstimateRecord, IndexRecord, ResultFile};
use super::headline;

/// Most outputs that have rows with their names; more stand side by side.
const ROWS: usize = 40;
/// Most factors of a map.
const MOST: usize = 30;
/// Most factors beside such rows.
const COLUMNS: usize = 12;
/// Most cells of a row of a map: neighbours of more outputs share one.
const CELLS: usize = 200;
/// Where the classes of shades begin; what is below the first is next to nothing.
const CLASSES: [f64; 8] = [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];

/// Which of a factor's indices.
#[derive(Clone, Copy)]
struct Order {
    title: &'static str,
    of: fn(&IndexRecord) -> EstimateRecord,
}

/// The total indices stand above: they say whether a factor matters at all.
const ORDERS: [Order; 2] = [
    Order { title: "Total indices S_T: with all interactions", of: |index| index.effect.total },
    Order { title: "First-order indices S_1: alone", of: |index| index.effect.first_order },
];

/// Total and first-order indices of every factor for every output of `axis`, as shades. Factors stand in the order of their
/// total indices over all outputs; of more than 30 (12 beside outputs that have names alone), the first ones.
pub(in crate::report) fn map_chart(result: &ResultFile, axis: &OutputAxis) -> Chart {
    let mut factors = overall_order(result);
    let is_table = axis.numbers.is_none() && axis.outputs.len() <= ROWS;
    factors.truncate(if is_table { COLUMNS } else { MOST });
    let map = Map { result, axis, factors };
    let (panels, words) = if is_table { map.as_table() } else { map.as_stretches() };
    let all = result.outputs.len();
    let of = match axis.outputs.len() {
        count if count == all => format!("all {all} outputs"),
        count => format!("{count} outputs {}", axis.label.replace('_', " ")).trim_end().to_owned(),
    };
    Chart::new(format!("{}: {of} at a glance", headline(result)), words).panels(panels)
}

/// The places of the factors by falling total index over all outputs together, or by their sum where there is none: the
/// order of everything that is told of many outputs.
pub(in crate::report) fn overall_order(result: &ResultFile) -> Vec<usize> {
    let together = result.aggregate.as_ref().and_then(|aggregate| aggregate.indices.as_deref()).unwrap_or_default();
    let known = result.outputs.iter().filter_map(|output| output.indices.as_ref());
    let sum = |factor: usize| known.clone().filter_map(|all| Some(all.get(factor)?.effect.total.estimate)).sum::<f64>();
    let key = |factor: usize| {
        let own = together.iter().find(|index| index.factor == result.factors[factor].name);
        own.map_or_else(|| sum(factor), |index| index.total.estimate)
    };
    let keys: Vec<f64> = (0..result.factors.len()).map(key).collect();
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|&a, &b| keys[b].total_cmp(&keys[a]));
    order
}

struct Map<'a> {
    result: &'a ResultFile,
    axis: &'a OutputAxis,
    /// The factors that are drawn, in order.
    factors: Vec<usize>,
}

impl Map<'_> {
    fn index(&self, output: usize, factor: usize, order: Order) -> Option<EstimateRecord> {
        let index = self.result.outputs[output].indices.as_ref()?.get(factor)?;
        Some((order.of)(index)).filter(|index| index.estimate.is_finite())
    }

    fn names(&self) -> Vec<String> {
        self.factors.iter().map(|&factor| name(&self.result.factors[factor].name)).collect()
    }

    /// A row for each output, a column for each factor.
    fn as_table(&self) -> (Vec<Panel>, String) {
        let rows: Vec<String> =
            self.axis.outputs.iter().map(|&output| name(&self.result.outputs[output].name)).collect();
        let panel = |order: Order| {
            let mut tiles: Vec<(Option<usize>, Tile)> = Vec::new();
            for (row, &output) in self.axis.outputs.iter().enumerate() {
                for (column, &factor) in self.factors.iter().enumerate() {
                    let estimate = self.index(output, factor, order);
                    let letter = estimate.map_or_else(|| "–".to_owned(), |estimate| short(estimate.estimate));
                    let tile = Tile { row, column, letter, tip: estimate.map_or_else(String::new, index) };
                    tiles.push((estimate.map(|estimate| class(estimate.estimate)), tile));
                }
            }
            // The legend is in the order of the marks.
            tiles.sort_by_key(|(class, tile)| (class.unwrap_or(usize::MAX), tile.row, tile.column));
            let marks = tiles.into_iter().map(|(class, tile)| series(class).mark(Shape::Tile(tile)));
            let (x, y) = (Axis::from_names("", self.names()), Axis::from_names("", rows.clone()));
            Panel::new(x, y).titled(order.title).with(marks.collect::<Vec<_>>())
        };
        let all = self.result.factors.len();
        let hidden = match all > self.factors.len() {
            true => format!(" Of {all} factors, the {} with the largest total indices are drawn.", self.factors.len()),
            false => String::new(),
        };
        (ORDERS.map(panel).to_vec(), format!("{}{hidden}", self.words()))
    }

    /// A row for each factor, the outputs side by side.
    fn as_stretches(&self) -> (Vec<Panel>, String) {
        let outputs = &self.axis.outputs;
        let of_cell = outputs.len().div_ceil(CELLS).max(1);
        let edges = edges(&match &self.axis.numbers {
            Some(numbers) => numbers.clone(),
            None => (1..=outputs.len()).map(|place| place as f64).collect(),
        });
        let cell = |first: usize| (edges[first], edges[(first + of_cell).min(outputs.len())]);
        let panel = |order: Order| {
            // By class and row, the classes in rising order.
            let mut found: std::collections::BTreeMap<(usize, usize), Vec<(f64, f64)>> = Default::default();
            for (row, &factor) in self.factors.iter().enumerate() {
                let mut before = None;
                for (number, some) in outputs.chunks(of_cell).enumerate() {
                    let known: Vec<f64> =
                        some.iter().filter_map(|&output| Some(self.index(output, factor, order)?.estimate)).collect();
                    let mean = known.iter().sum::<f64>() / known.len() as f64;
                    let class = if known.is_empty() { MISSING } else { class(mean) };
                    let (from, to) = cell(number * of_cell);
                    let stretches = found.entry((class, row)).or_default();
                    match stretches.last_mut().filter(|_| before == Some(class)) {
                        Some(last) => last.1 = to,
                        None => stretches.push((from, to)),
                    }
                    before = Some(class);
                }
            }
            let mark = |((class, row), stretches): ((usize, usize), Vec<(f64, f64)>)| -> Mark {
                series(Some(class).filter(|class| *class != MISSING)).mark(Shape::Stretches(row, stretches))
            };
            let (x, y) = (Axis::new(self.axis_label(), ""), Axis::from_names("", self.names()));
            Panel::new(x, y).titled(order.title).with(found.into_iter().map(mark).collect::<Vec<_>>())
        };
        let shared = match of_cell {
            1 => String::new(),
            _ => format!(" A cell is the mean of {of_cell} outputs side by side."),
        };
        (ORDERS.map(panel).to_vec(), format!("{}{shared}{}", self.words(), not_drawn(self.result.factors.len(), MOST)))
    }

    fn axis_label(&self) -> String {
        match (&self.axis.numbers, self.axis.label.as_str()) {
            (Some(_), "") => "output".to_owned(),
            (Some(_), stem) => stem.replace('_', " "),
            (None, _) => "outputs in the order of the study".to_owned(),
        }
    }

    /// Where the largest index of all stands, and what is missing.
    fn words(&self) -> String {
        let each =
            self.axis.outputs.iter().flat_map(|&output| self.factors.iter().map(move |&factor| (output, factor)));
        let totals = each.filter_map(|(output, factor)| Some((self.index(output, factor, ORDERS[0])?, output, factor)));
        let largest = totals.max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate).then(b.1.cmp(&a.1)));
        let mut words = match largest {
            Some((total, output, factor)) => format!(
                "The largest total index of all is that of {} for {}: {}.",
                name(&self.result.factors[factor].name),
                name(&self.result.outputs[output].name),
                index(total)
            ),
            None => "No output has indices.".to_owned(),
        };
        let without = self.axis.outputs.iter().filter(|&&output| self.result.outputs[output].indices.is_none()).count();
        if without > 0 && largest.is_some() {
            words.push_str(&format!(
                " {without} of the outputs {} no indices.",
                if without == 1 { "has" } else { "have" }
            ));
        }
        words
    }
}

/// The class of outputs without indices, after all others.
const MISSING: usize = usize::MAX;

pub(super) fn class(index: f64) -> usize {
    CLASSES.iter().filter(|least| index >= **least).count()
}

/// The series of a class; `None` where there is no index.
pub(super) fn series(class: Option<usize>) -> Series {
    let Some(class) = class else { return Series::new("no indices", Colour::Series(10)) };
    let name = match class {
        0 => format!("below {}", CLASSES[0]),
        _ if class == CLASSES.len() => format!("{} or more", CLASSES[class - 1]),
        _ => format!("{} to {}", CLASSES[class - 1], CLASSES[class]),
    };
    Series::new(name, Colour::Shade(class))
}

/// An index in a cell: `.34`.
pub(super) fn short(index: f64) -> String {
    let text = fixed(index, 2);
    match text.strip_prefix("0.") {
        Some("00") => "0".to_owned(),
        Some(digits) => format!(".{digits}"),
        None => text.replace('-', "\u{2212}"),
    }
}

/// The edges of cells about `places`, which rise: halfway between neighbours.
fn edges(places: &[f64]) -> Vec<f64> {
    let halfway: Vec<f64> = places.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0).collect();
    let ends = |place: Option<&f64>, edge: Option<&f64>| match place.zip(edge) {
        Some((place, edge)) => place + (place - edge),
        None => 0.0,
    };
    let first = ends(places.first(), halfway.first());
    let last = ends(places.last(), halfway.last());
    [vec![first], halfway, vec![last]].concat()
}

/// First-order and total indices of all outputs together, the largest total index on top; of more than 21 factors, the
/// first 20 and the sums of the others.
pub(in crate::report) fn together_chart(result: &ResultFile) -> Chart {
    let indices = result.aggregate.as_ref().and_then(|aggregate| aggregate.indices.as_deref()).unwrap_or_default();
    let factors: Vec<String> = result.factors.iter().map(|factor| name(&factor.name)).collect();
    let of = |which: fn(&AggregateIndexRecord) -> EstimateRecord| -> Vec<Option<EstimateRecord>> {
        let find = |name: &str| indices.iter().find(|index| index.factor == name).map(which);
        result.factors.iter().map(|factor| find(&factor.name)).collect()
    };
    let (first_order, total) = (of(|index| index.first_order), of(|index| index.total));
    let keys: Vec<f64> = total.iter().map(|total| total.map_or(f64::NEG_INFINITY, |total| total.estimate)).collect();
    let panel = pair_panel(factors, first_order, total, &keys);
    let caption = match &result.aggregate {
        Some(aggregate) if aggregate.indices.is_some() => {
            format!(
                "Over {} outputs: {}.{}",
                aggregate.outputs.len(),
                aggregate.weighting,
                left_out(result.factors.len())
            )
        }
        Some(aggregate) => {
            let reason = aggregate.reason.as_deref().unwrap_or("the result holds none");
            format!("No indices of all outputs together: {reason}.")
        }
        None => "No indices of all outputs together: the result holds none.".to_owned(),
    };
    Chart::new(format!("{}: all outputs together", headline(result)), caption).panels([panel])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_cover_every_index() {
        assert_eq!([-0.2, 0.0, 0.01, 0.15, 0.9, 1.3].map(class), [0, 0, 1, 3, 8, 8]);
        assert_eq!(series(Some(8)).name, "0.9 or more");
        assert_eq!(series(Some(2)).name, "0.05 to 0.1");
        assert_eq!([0.001, 0.344, 0.999, -0.02, 1.2].map(short), ["0", ".34", "1.00", "\u{2212}0.02", "1.20"]);
    }

    #[test]
    fn cells_end_halfway_between_their_places() {
        assert_eq!(edges(&[0.0, 1.0, 3.0]), [-0.5, 0.5, 2.0, 4.0]);
    }
}
