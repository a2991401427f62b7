//! Charts of factors: sorted level bars of indices, and the chart of percentages.

use apportion::result::{OutputResult, StudyResult};
use apportion::uncertainty::{EffectEstimates, Estimate, Interval};

use super::chart::{Axis, Bar, Chart, Colour, Mark, Panel, Series, Shape};
use super::format::{PrintedEstimate, fixed, index as of_error, minus, name, two_digits};
use super::output_view::{IndexOf, effects};

/// Maximum number of factors in a chart.
pub(super) const MAX_BARS: usize = 20;
/// The axis of indices.
pub(super) const INDEX: &str = "Sobol' index: part of the variance";
/// Bounds of estimates that are drawn: an index is between 0 and 1, and so is the size of a difference of two.
/// Intervals longer than `LONGEST` are not drawn either.
pub(super) const INDICES: (f64, f64) = (-0.1, 1.1);
pub(super) const DIFFERENCES: (f64, f64) = (-1.1, 1.1);
const LONGEST: f64 = 1.0;
/// How far beyond the bounds intervals are drawn.
const BEYOND: f64 = 0.1;
/// Text in place of such a bar.
const UNKNOWN: &str = "unknown: too few samples";
/// Maximum number of decimals of a label; numbers below `SMALL` have two digits.
const DECIMALS: usize = 4;
const SMALL: f64 = 0.01;

/// A series with its value for each factor; `None` is marked as missing.
pub(super) type IndexSeries = (Series, Vec<Option<Estimate>>);

/// Returns the series of first-order and of total indices.
pub(super) fn both_orders(first_order: Vec<Option<Estimate>>, total: Vec<Option<Estimate>>) -> [IndexSeries; 2] {
    [
        (Series::new("S_1, first order: alone", Colour::Series(0)), first_order),
        (Series::new("S_T, total: with all interactions", Colour::Series(4)), total),
    ]
}

/// Builds a panel with a row for each factor, those with the largest keys on top, and a pair of bars in each: the
/// first-order index, and below it the total index, whose part beyond the first-order index is due to interactions.
pub(super) fn pair_panel(
    factors: Vec<String>,
    first_order: Vec<Option<Estimate>>,
    total: Vec<Option<Estimate>>,
    keys: &[f64],
) -> Panel {
    let with_others = Series::new("S_T − S_1: only together with others", Colour::Series(5));
    let alone: Vec<f64> = first_order.iter().map(|index| index.map_or(0.0, |index| index.estimate.max(0.0))).collect();
    let [(of_first, first_order), (of_total, total)] = both_orders(first_order, total);
    let split = total.into_iter().zip(&alone).enumerate().map(|(row, (total, alone))| {
        let bar = index_bar(row, total, INDICES);
        let beyond = Some((alone.min(bar.to.max(0.0)), with_others.clone()));
        of_total.mark(Shape::Bar(Bar { beyond, ..bar }))
    });
    panel(INDEX, factors, bars((of_first, first_order), INDICES).chain(split), keys)
}

/// Builds a panel with a row for each factor, those with the largest keys on top, and bars of their indices.
pub(super) fn index_panel(
    label: &str,
    factors: Vec<String>,
    series: impl IntoIterator<Item = IndexSeries>,
    possible: (f64, f64),
    keys: &[f64],
) -> Panel {
    panel(label, factors, series.into_iter().flat_map(|series| bars(series, possible)), keys)
}

fn panel(label: &str, factors: Vec<String>, marks: impl Iterator<Item = Mark>, keys: &[f64]) -> Panel {
    Panel::new(Axis::new(label, ""), Axis::from_names("", factors)).with(marks).ranked(keys, MAX_BARS)
}

fn bars((series, values): IndexSeries, possible: (f64, f64)) -> impl Iterator<Item = Mark> {
    let bars = values.into_iter().enumerate();
    bars.map(move |(row, value)| series.mark(Shape::Bar(index_bar(row, value, possible))))
}

/// Builds the bar of an index. An unknown index gets a text instead, since a bar would be read as a value.
fn index_bar(row: usize, value: Option<Estimate>, possible: (f64, f64)) -> Bar {
    let Some(index) = value else { return Bar { row, to: f64::NAN, ..Bar::default() } };
    let length = index.interval.map(Interval::width);
    let is_possible = (possible.0..=possible.1).contains(&index.estimate);
    if !is_possible || length.is_some_and(|length| length > LONGEST) {
        return Bar { row, to: f64::NAN, label: UNKNOWN.to_owned(), ..Bar::default() };
    }
    let label = match PrintedEstimate::new(index).short_number(DECIMALS) {
        Some(label) => label,
        None if index.estimate.abs() < SMALL => minus(&two_digits(index.estimate)),
        None => minus(&fixed(index.estimate, DECIMALS)),
    };
    let interval = index.interval.map(|i| (i.low.max(possible.0 - BEYOND), i.high.min(possible.1 + BEYOND)));
    Bar { row, to: index.estimate, interval, label, value_text: of_error(index), ..Bar::default() }
}

/// Returns the sentence of a caption that says that only the `max_bars` largest factors are drawn.
pub(super) fn not_drawn(count: usize, max_bars: usize) -> String {
    if count > max_bars { format!(" The {max_bars} largest of {count} factors are drawn.") } else { String::new() }
}

/// One study in a chart of percentages.
#[derive(Debug, Clone)]
pub struct SharesSeries<'a> {
    /// Its name in the legend, and its appearance.
    pub series: Series,
    /// The output whose indices are drawn.
    pub output: &'a OutputResult,
    /// Published percentages by factor; they are drawn in both panels, since their definition is not published.
    pub published: Vec<(&'a str, f64)>,
}

/// Draws the indices of `factors` in each of `series`, in percent of the variance: first order on the left, total on the
/// right, the factor with the largest total index on top. Of more than 20 factors, the first 20.
pub fn shares_chart(title: &str, caption: &str, factors: &[&str], series: &[SharesSeries<'_>]) -> Chart {
    let mut keys = Vec::new();
    for factor in factors {
        let totals = series.iter().filter_map(|series| series.effect(factor)).map(|effect| effect.total.estimate);
        keys.push(totals.fold(f64::NEG_INFINITY, f64::max));
    }
    let kinds: [(&str, IndexOf); 2] =
        [("S_1: the factor alone", |effect| effect.first_order), ("S_T: with its interactions", |effect| effect.total)];
    let panels = kinds.map(|(title, of)| {
        let names = Axis::from_names("", factors.iter().map(|factor| name(factor)).collect());
        let mut panel = Panel::new(Axis::new("% of the variance", ""), names).titled(title);
        for series in series {
            for (row, factor) in factors.iter().enumerate() {
                let published = series.published.iter().find(|(name, _)| name == factor).map(|(_, share)| *share);
                let bar = Bar { published, ..percent_bar(row, series.effect(factor).map(of)) };
                panel.marks.push(series.series.mark(Shape::Bar(bar)));
            }
        }
        panel.ranked(&keys, MAX_BARS)
    });
    Chart::new(title, format!("{caption}{}", not_drawn(factors.len(), MAX_BARS))).side_by_side().panels(panels)
}

/// Builds the bar of an index in percent; a meaningless one gets only a text.
fn percent_bar(row: usize, index: Option<Estimate>) -> Bar {
    let bar = index_bar(row, index, INDICES);
    match index.filter(|_| bar.to.is_finite()) {
        Some(Estimate { estimate, interval }) => {
            Bar::percent(row, Some(100.0 * estimate), interval.map(|i| (100.0 * i.low, 100.0 * i.high)))
        }
        None => bar,
    }
}

impl SharesSeries<'_> {
    /// Returns the indices of a factor.
    fn effect(&self, factor: &str) -> Option<&EffectEstimates> {
        effects(self.output).find(|(name, _)| *name == factor).map(|(_, effect)| effect)
    }
}

/// Draws the Shapley effects on one output.
pub fn shapley_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let shapley = effects(output).filter_map(|(factor, effect)| Some((name(factor), Some(effect.shapley?))));
    let (names, effects): (_, Vec<Option<Estimate>>) = shapley.unzip();
    let keys: Vec<f64> = effects.iter().map(|effect| effect.map_or(f64::NAN, |effect| effect.estimate)).collect();
    let series = (Series::new("Shapley effect", Colour::Series(0)), effects);
    let panel = index_panel("Shapley effect: part of the variance", names, [series], INDICES, &keys);
    let caption = format!("Shapley effects on {}: they sum to 100 % of the variance.", name(&output.name));
    let title = format!("{}: Shapley effects on {}", result.study.headline(), name(&output.name));
    Chart::new(title, caption).panels([panel])
}
