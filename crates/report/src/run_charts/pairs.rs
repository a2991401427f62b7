//! The indices: first order with total, second order as a map of pairs, and their convergence during the run.

use apportion::IndexPair;
use apportion::result::{Named, OutputResult, StageRecord, StudyResult};
use apportion::uncertainty::{EffectEstimates, Estimate};

use super::map::{class, series, short};
use crate::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape, Spacing, Stroke, Tile};
use crate::factor_bars::{INDEX, INDICES, MAX_BARS, both_orders, index_panel, not_drawn, pair_panel};
use crate::format::{grouped, index, name, two_digits};
use crate::leading::{by_total, leader_of, surely_interact};
use crate::output_view::effects;
use crate::precision::widest_of;

/// Maximum number of factors: with more, the figures would not fit into the cells on a phone.
const MAX_PAIRS: usize = 15;
/// The lightest shade.
const NOTHING: &str = "below 0.01, or may be 0";

/// Draws second-order indices of all pairs of factors as shades and figures, with the first-order indices on the
/// diagonal; the factor with the largest total index is the first. Of more than 15 factors, the first 15.
pub fn pairs_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let title = format!("{}: interactions of pairs of factors, for {}", result.study.headline(), name(&output.name));
    let order = by_total(output).unwrap_or_default();
    let factors = &order[..order.len().min(MAX_PAIRS)];
    let sure = surely_interact(output.second_order.as_deref().unwrap_or_default());
    let mut tiles: Vec<(usize, Tile)> = Vec::new();
    for (row, (_, below)) in factors.iter().enumerate() {
        for (column, (_, left)) in factors.iter().enumerate().take(row + 1) {
            let (value, may_be_nothing) = match row == column {
                true => (below.effect.first_order, below.effect.first_order.interval.is_some_and(|i| i.low <= 0.0)),
                false => {
                    let Some((place, value)) = pair(output, [&below.name, &left.name]) else { continue };
                    (value, value.interval.is_some() && !sure[place])
                }
            };
            let class = if may_be_nothing { 0 } else { class(value.estimate) };
            tiles.push((class, Tile { row, column, letter: short(value.estimate), tip: index(value) }));
        }
    }
    // The legend is in the order of the marks.
    tiles.sort_by_key(|(class, tile)| (*class, tile.row, tile.column));
    let marks = tiles.into_iter().map(|(class, tile)| {
        let series = if class == 0 { Series::new(NOTHING, Colour::Shade(0)) } else { series(Some(class)) };
        series.mark(Shape::Tile(tile))
    });
    let names = factors.iter().zip(1..).map(|((_, index), number)| format!("{} ({number})", name(&index.name)));
    let rows = Axis::from_names("", names.collect());
    let columns =
        Axis::from_names("the factors by their numbers", (1..=factors.len()).map(|n| n.to_string()).collect());
    let caption = format!(
        "Below the diagonal, the interaction of two factors (second-order index S_ij); on it, the effect of each alone \
         (S_i).{}",
        not_drawn(order.len(), MAX_PAIRS)
    );
    Chart::new(title, caption).panels([Panel::new(columns, rows).with(marks)])
}

/// Returns the second-order index of two factors in any order, and its position.
fn pair(output: &OutputResult, [one, other]: [&str; 2]) -> Option<(usize, Estimate)> {
    let mut pairs = output.second_order.iter().flatten().enumerate();
    let (place, pair) = pairs.find(|(_, pair)| {
        let [a, b] = &pair.factors;
        (a == one && b == other) || (a == other && b == one)
    })?;
    Some((place, pair.index)).filter(|(_, index)| index.estimate.is_finite())
}

/// Draws the first-order and total index of every factor, as parts of the output's variance, with their intervals; the
/// largest total index on top. Of more than 20 factors, the first 20.
pub fn indices_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let factor_count = effects(output).count();
    let mut bars: Vec<(String, &EffectEstimates)> =
        effects(output).map(|(factor, effect)| (name(factor), effect)).collect();
    bars.extend(output.noise.iter().map(|noise| (format!("noise ({})", name(&noise.name)), &noise.effect)));
    let first_order = bars.iter().map(|(_, effect)| Some(effect.first_order)).collect();
    let total = bars.iter().map(|(_, effect)| Some(effect.total)).collect();
    let keys: Vec<f64> = bars.iter().map(|(_, effect)| effect.weight().estimate).collect();
    let factors = bars.into_iter().map(|(name, _)| name).collect();
    let panel = match effects(output).any(|(_, effect)| effect.dependent.is_some()) {
        true => {
            let mut series = both_orders(first_order, total);
            let names = ["S_1, first order: with dependence on others", "S_T, total: without dependence on others"];
            for ((series, _), name) in series.iter_mut().zip(names) {
                series.name = name.to_owned();
            }
            index_panel(INDEX, factors, series, INDICES, &keys)
        }
        false => pair_panel(factors, first_order, total, &keys),
    };
    let title = format!("{}: indices of {}", result.study.headline(), name(&output.name));
    Chart::new(title, leader_of(output) + &not_drawn(factor_count, MAX_BARS)).panels([panel])
}

/// Factors with a line of their own.
const LINES: usize = 8;

/// Draws the total indices and the half widths of their intervals against the number of model runs, for the factors
/// with the largest total indices (at most eight). A target is drawn as a line among the half widths.
pub fn convergence_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let factors: Vec<usize> =
        by_total(output).unwrap_or_default().into_iter().map(|(factor, _)| factor).take(LINES).collect();
    let stages = &output.convergence;
    let totals = factors.iter().enumerate().flat_map(|(place, &factor)| total_lines(stages, place, factor));
    let widths = factors.iter().enumerate().map(|(place, &factor)| width_line(stages, place, factor));
    let target = result.stopping.as_ref().and_then(|stopping| stopping.target_half_width);
    let references = [Some(largest_width(stages)), target.map(|target| target_line(stages, target))];
    let runs = Axis::new("model runs", "").spaced(Spacing::Logarithmic);
    let totals = Panel::new(runs.clone(), Axis::new("total index", ""))
        .titled("Total indices with their 95 % intervals")
        .with(totals);
    let widths = Panel::new(runs, Axis::new("half width", "").spaced(Spacing::Logarithmic))
        .titled("Half widths of the intervals of the total indices")
        .with(widths);
    let title = format!("{}: convergence of the indices of {}", result.study.headline(), name(&output.name));
    Chart::new(title, caption(result, output)).panels([totals, widths.with(references.into_iter().flatten())])
}

/// Returns the series of the factor at `place` among the drawn ones.
fn line_series(stages: &[StageRecord], place: usize, factor: usize) -> Series {
    let index = stages.first().and_then(|stage| stage.indices.get(factor));
    let name = index.map_or_else(String::new, |index| self::name(&index.name));
    Series::new(name, Colour::Series(place)).stroke(Stroke::SolidWithPoints)
}

/// Iterates over the number of runs and the index of `factor` at every stage.
fn steps(stages: &[StageRecord], factor: usize) -> impl Iterator<Item = (f64, &Named<IndexPair<Estimate>>)> + Clone {
    stages.iter().filter_map(move |stage| Some((stage.model_runs as f64, stage.indices.get(factor)?)))
}

fn total_lines(stages: &[StageRecord], place: usize, factor: usize) -> [Mark; 2] {
    let series = line_series(stages, place, factor);
    let steps = steps(stages, factor).map(|(runs, index)| (runs, index.effect.total));
    let band = steps.clone().filter_map(|(runs, total)| total.interval.map(|i| (runs, i.low, i.high))).collect();
    [series.band(band), series.line(steps.map(|(runs, total)| (runs, total.estimate)).collect())]
}

fn width_line(stages: &[StageRecord], place: usize, factor: usize) -> Mark {
    let widths =
        steps(stages, factor).filter_map(|(runs, index)| Some((runs, index.effect.total.interval?.width() / 2.0)));
    line_series(stages, place, factor).line(widths.collect())
}

fn largest_width(stages: &[StageRecord]) -> Mark {
    let points = stages.iter().filter_map(|stage| Some((stage.model_runs as f64, stage.largest_half_width?)));
    let series = Series::new("largest half width of all indices", Colour::Reference).stroke(Stroke::Dashed);
    series.line(points.collect())
}

fn target_line(stages: &[StageRecord], target: f64) -> Mark {
    let points = stages.iter().map(|stage| (stage.model_runs as f64, target));
    Series::new("target", Colour::Reference).line(points.collect())
}

/// States the precision of the indices at the end.
fn caption(result: &StudyResult, output: &OutputResult) -> String {
    let precision = match (output.convergence.last(), widest_of(output)) {
        (Some(last), Some(width)) => format!("After {} model runs: ± {}.", grouped(last.model_runs), two_digits(width)),
        (Some(last), None) => {
            format!("After {} model runs there are indices without an interval.", grouped(last.model_runs))
        }
        (None, _) => "There are too few base samples to estimate the indices from parts of them.".to_owned(),
    };
    precision + &not_drawn(result.indexed_names().len(), LINES)
}
