//! Charts of factors: sorted level bars of indices, and the chart of percentages.

use super::chart::{Axis, Bar, Chart, Colour, Mark, Panel, Series, Shape};
use super::format::{fixed, index as of_error, minus, name, two_digits};
use super::leading::leader_of;
use super::result::{EffectRecord, EstimateRecord, IntervalRecord, OutputRecord, ResultFile};

/// Most factors in a chart; the rest are summed in a last row.
pub(super) const MOST: usize = 20;
/// The axis of indices.
pub(super) const INDEX: &str = "Sobol' index: part of the variance";
/// Estimates beyond these bounds say nothing of an index, which is between 0 and 1, or of a difference of two; nor do intervals
/// longer than `LONGEST`.
const INDICES: (f64, f64) = (-0.1, 1.1);
const DIFFERENCES: (f64, f64) = (-1.1, 1.1);
const LONGEST: f64 = 1.0;
/// Intervals are drawn so far beyond.
const BEYOND: f64 = 0.1;
/// What stands in the place of such a bar.
const UNKNOWN: &str = "unknown: too few samples";
/// Most decimals of a label; what is smaller than `SMALL` has two digits.
const DECIMALS: usize = 4;
const SMALL: f64 = 0.01;

/// A series with its value for each factor; `None` is marked as missing.
pub(super) type IndexSeries = (Series, Vec<Option<EstimateRecord>>);

/// The series of first-order and of total indices.
pub(super) fn both_orders(
    first_order: Vec<Option<EstimateRecord>>,
    total: Vec<Option<EstimateRecord>>,
) -> [IndexSeries; 2] {
    [
        (Series::new("S_1, first order: alone", Colour::Series(0)), first_order),
        (Series::new("S_T, total: with all interactions", Colour::Series(4)), total),
    ]
}

/// A panel with a row for each factor, those with the largest keys on top, and a pair of bars in each: the first-order index,
/// and below it the total index, whose part beyond the first-order index is what the factor does together with others.
pub(super) fn pair_panel(
    factors: Vec<String>,
    first_order: Vec<Option<EstimateRecord>>,
    total: Vec<Option<EstimateRecord>>,
    keys: &[f64],
) -> Panel {
    let with_others = Series::new("S_T − S_1: only together with others", Colour::Series(5));
    let alone: Vec<Option<f64>> = first_order.iter().map(|index| index.map(|index| index.estimate)).collect();
    bars(INDEX, INDICES, factors, both_orders(first_order, total), keys, &|bar, (number, rows)| {
        // That of the last row is of the sums.
        let split: f64 = rows.iter().filter_map(|&factor| alone[factor]).sum();
        (number == 1).then(|| (split.max(0.0).min(bar.to.max(0.0)), with_others.clone()))
    })
}

/// A panel with a row for each factor, those with the largest keys on top, and bars of their indices. What the indices of the
/// least ones sum to is a row of its own.
pub(super) fn index_panel(
    label: &str,
    factors: Vec<String>,
    series: impl IntoIterator<Item = IndexSeries>,
    keys: &[f64],
) -> Panel {
    bars(label, INDICES, factors, series, keys, &|_, _| None)
}

/// The same of differences of indices.
pub(super) fn difference_panel(
    label: &str,
    factors: Vec<String>,
    series: impl IntoIterator<Item = IndexSeries>,
    keys: &[f64],
) -> Panel {
    bars(label, DIFFERENCES, factors, series, keys, &|_, _| None)
}

/// What a bar is of: the number of its series, and the factors that it sums.
type Of<'a> = (usize, &'a [usize]);

/// From where on a bar is of another series, and of which.
type Beyond<'a> = dyn Fn(&Bar, Of<'_>) -> Option<(f64, Series)> + 'a;

fn bars(
    label: &str,
    possible: (f64, f64),
    factors: Vec<String>,
    series: impl IntoIterator<Item = IndexSeries>,
    keys: &[f64],
    beyond: &Beyond<'_>,
) -> Panel {
    let rows = rows(keys, factors.len());
    let names = rows.iter().map(|row| match row[..] {
        [one] => factors[one].clone(),
        ref rest => others(rest.len()),
    });
    let names = names.collect();
    let mut marks: Vec<Mark> = Vec::new();
    for (number, (series, values)) in series.into_iter().enumerate() {
        for (place, row) in rows.iter().enumerate() {
            let value = sum(row.iter().map(|&factor| values.get(factor).copied().flatten()));
            // Sums may be anything.
            let mut bar = index_bar(place, value, (row.len() == 1).then_some(possible));
            bar.beyond = beyond(&bar, (number, row));
            marks.push(series.mark(Shape::Bar(bar)));
        }
    }
    Panel::new(Axis::new(label, ""), Axis::from_names("", names)).with(marks)
}

/// The name of a row that is the sum of so many factors.
fn others(count: usize) -> String {
    format!("{count} others, summed")
}

/// The factors of each row: one, those with the largest keys first; then all that have no row of their own.
fn rows(keys: &[f64], all: usize) -> Vec<Vec<usize>> {
    let key = |factor: usize| keys.get(factor).copied().filter(|key| !key.is_nan()).unwrap_or(f64::NEG_INFINITY);
    let mut order: Vec<usize> = (0..all).collect();
    order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
    let rest = order.split_off(order.len().min(if all == MOST + 1 { all } else { MOST }));
    order.into_iter().map(|factor| vec![factor]).chain((!rest.is_empty()).then_some(rest)).collect()
}

/// One value as it is; of several the sum, whose error is not known.
fn sum(values: impl ExactSizeIterator<Item = Option<EstimateRecord>>) -> Option<EstimateRecord> {
    let (count, mut known) = (values.len(), values.flatten());
    let first = known.next()?;
    match count {
        1 => Some(first),
        _ => {
            let estimate = first.estimate + known.map(|value| value.estimate).sum::<f64>();
            Some(EstimateRecord { estimate, low: None, high: None })
        }
    }
}

/// The bar of an index, or of a sum of several, which has no bounds. One of which nothing is known says so: its bar would be
/// read all the same.
fn index_bar(row: usize, value: Option<EstimateRecord>, possible: Option<(f64, f64)>) -> Bar {
    let Some(index) = value else { return Bar { row, to: f64::NAN, ..Bar::default() } };
    let length = index.low.zip(index.high).map(|(low, high)| high - low);
    let is_possible = possible.is_none_or(|(low, high)| (low..=high).contains(&index.estimate));
    if !is_possible || length.is_some_and(|length| length > LONGEST) {
        return Bar { row, to: f64::NAN, label: UNKNOWN.to_owned(), ..Bar::default() };
    }
    let said = of_error(index);
    let printed = said.split(' ').next().unwrap_or_default();
    let decimals = printed.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let label = match decimals > DECIMALS {
        true if index.estimate.abs() < SMALL => minus(&two_digits(index.estimate)),
        true => minus(&fixed(index.estimate, DECIMALS)),
        false => printed.to_owned(),
    };
    let ends = possible.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let interval = index.low.zip(index.high);
    let interval = interval.map(|(low, high)| (low.max(ends.0 - BEYOND), high.min(ends.1 + BEYOND)));
    Bar { row, to: index.estimate, interval, label, said, ..Bar::default() }
}

/// What a caption says of the factors that are not drawn.
pub(super) fn left_out(all: usize) -> String {
    if all <= MOST + 1 {
        return String::new();
    }
    format!(
        " Of {all} factors, the {MOST} with the largest total indices have bars, and the {} others one of their sums.",
        all - MOST
    )
}

/// What a caption says where only the `most` largest factors are drawn.
pub(super) fn not_drawn(all: usize, most: usize) -> String {
    match all > most {
        true => format!(" Of {all} factors, the {most} with the largest total indices are drawn."),
        false => String::new(),
    }
}

/// One study in a chart of shares.
#[derive(Debug, Clone)]
pub struct SharesSeries<'a> {
    /// Its name in the legend, and its colour.
    pub series: Series,
    /// The output whose shares are drawn.
    pub output: &'a OutputRecord,
    /// Published percentages by factor; they stand in both panels, since their definition is not published.
    pub published: Vec<(&'a str, f64)>,
}

/// The shares of `factors` in each of `series`: first order on the left, total on the right, the factor with the largest
/// total share on top. Of more than 21 factors, the first 20, and the sums of the others.
pub fn shares_chart(title: &str, caption: &str, factors: &[&str], series: &[SharesSeries<'_>]) -> Chart {
    let total: ShareOf = |e| (e.share_total, e.share_total_interval);
    let largest = |factor: &&str| {
        let shares = series.iter().filter_map(|series| share(series, factor, total).0);
        shares.fold(f64::NEG_INFINITY, f64::max)
    };
    let keys: Vec<f64> = factors.iter().map(largest).collect();
    let rows = rows(&keys, factors.len());
    let panel = |title: &str, of: ShareOf| {
        let names = rows.iter().map(|row| match row[..] {
            [one] => name(factors[one]),
            ref rest => others(rest.len()),
        });
        let names = Axis::from_names("", names.collect());
        let bars = series.iter().flat_map(|series| {
            rows.iter().enumerate().map(move |(place, row)| {
                let shares: Vec<_> = row.iter().map(|&factor| share(series, factors[factor], of)).collect();
                let published = |factor: usize| series.published.iter().find(|(name, _)| *name == factors[factor]);
                let bar = match (&row[..], &shares[..]) {
                    ([factor], [(value, interval)]) => {
                        let published = published(*factor).map(|(_, share)| *share);
                        Bar { published, ..share_bar(place, *value, *interval) }
                    }
                    _ => share_bar(place, shares.iter().map(|(value, _)| *value).sum(), None),
                };
                series.series.mark(Shape::Bar(bar))
            })
        });
        Panel::new(Axis::new("share of the sum of indices (%)", ""), names).titled(title).with(bars)
    };
    let panels = [
        panel("First-order indices", |e| (e.share_first_order, e.share_first_order_interval)),
        panel("Total indices", total),
    ];
    Chart::new(title, format!("{caption}{}", left_out(factors.len()))).side_by_side().panels(panels)
}

/// Shares beyond these bounds, in percent, and intervals longer than this mean nothing.
const POSSIBLE_SHARE: std::ops::RangeInclusive<f64> = -10.0..=110.0;
const LONGEST_SHARE: f64 = 100.0;

/// The bar of a share in percent; of one that means nothing, only that.
fn share_bar(row: usize, share: Option<f64>, interval: Option<IntervalRecord>) -> Bar {
    let means =
        |share: f64| POSSIBLE_SHARE.contains(&share) && interval.is_none_or(|i| i.high - i.low <= LONGEST_SHARE);
    match share {
        Some(share) if !means(share) => Bar { row, to: f64::NAN, label: UNKNOWN.to_owned(), ..Bar::default() },
        _ => Bar::percent(row, share, interval.map(|i| (i.low, i.high))),
    }
}

type ShareOf = fn(&EffectRecord) -> (Option<f64>, Option<IntervalRecord>);

fn share(series: &SharesSeries<'_>, factor: &str, of: ShareOf) -> (Option<f64>, Option<IntervalRecord>) {
    let index = series.output.indices.iter().flatten().find(|index| index.factor == *factor);
    index.map_or((None, None), |index| of(&index.effect))
}

/// The chart of one output of a single study.
pub fn study_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let factors: Vec<&str> = result.factors.iter().map(|factor| factor.name.as_str()).collect();
    let title = result.study.title.as_ref().unwrap_or(&result.study.name);
    let indices = || output.indices.iter().flatten();
    let of_factors = indices().filter_map(|index| Some((name(&index.factor), index.effect.shapley?)));
    let of_players = output.shapley_groups.iter().flatten().map(|player| (name(&player.player), player.shapley));
    let shapley: Vec<(String, EstimateRecord)> = of_factors.chain(of_players).collect();
    if !shapley.is_empty() {
        let (names, effects): (_, Vec<EstimateRecord>) = shapley.into_iter().unzip();
        let effects: Vec<Option<EstimateRecord>> = effects.into_iter().map(Some).collect();
        let keys: Vec<f64> = effects.iter().map(|effect| effect.map_or(f64::NAN, |effect| effect.estimate)).collect();
        let series = (Series::new("Shapley effect", Colour::Series(0)), effects);
        let panel = index_panel("Shapley effect: part of the variance", names, [series], &keys);
        let caption = format!("Shapley effects on {}: they sum to 100 % of the variance.", name(&output.name));
        return Chart::new(title, caption).panels([panel]);
    }
    let caption = match indices().any(|index| index.effect.dependent.is_some()) {
        true => {
            "Indices of dependent factors share out nothing; Shapley effects would, and were not asked for.".to_owned()
        }
        false => leader_of(output),
    };
    let series = Series::new(name(&output.name), Colour::Series(0));
    shares_chart(title, &caption, &factors, &[SharesSeries { series, output, published: Vec::new() }])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(estimate: f64, half: f64) -> Option<EstimateRecord> {
        Some(EstimateRecord { estimate, low: Some(estimate - half), high: Some(estimate + half) })
    }

    fn drawn(panel: &Panel) -> Vec<Bar> {
        let bar = |mark: &'_ Mark| match &mark.shape {
            Shape::Bar(bar) => Some(bar.clone()),
            _ => None,
        };
        panel.marks.iter().filter_map(bar).collect()
    }

    #[test]
    fn the_rest_of_many_factors_is_summed() {
        let names: Vec<String> = (0..30).map(|k| format!("x{k}")).collect();
        let keys: Vec<f64> = (0..30).map(f64::from).collect();
        let values = |scale: f64| (0..30).map(|k| about(scale * f64::from(k), 1e-4)).collect::<Vec<_>>();
        let panel = pair_panel(names.clone(), values(0.01), values(0.02), &keys);
        assert_eq!(panel.y.names.len(), 21);
        assert_eq!((panel.y.names[0].as_str(), panel.y.names[20].as_str()), ("x29", "10 others, summed"));
        let bars = drawn(&panel);
        assert_eq!((bars.len(), bars[0].label.as_str()), (42, "0.2900"));
        // 0 + 1 + ... + 9 = 45, of which nothing is known of the error.
        assert!((bars[41].to - 0.9).abs() < 1e-12 && bars[41].interval.is_none());
        let split = bars[41].beyond.as_ref().map(|(split, _)| *split).unwrap_or_default();
        assert!((split - 0.45).abs() < 1e-12 && bars[20].beyond.is_none());
        // One more than fit has a row of its own.
        let panel = pair_panel(names[..21].to_vec(), values(0.01), values(0.02), &keys[..21]);
        assert_eq!(panel.y.names.last().map(String::as_str), Some("x0"));
    }

    #[test]
    fn an_index_of_which_nothing_is_known_has_no_bar() {
        let keys = [1.0, 0.5, 0.4, 0.3];
        let names: Vec<String> = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        let alone = Some(EstimateRecord { estimate: 2.73, low: None, high: None });
        let values = vec![about(-1.73, 0.2), alone, about(0.4, 0.6), about(0.02, 0.04)];
        let panel = index_panel(INDEX, names.clone(), [(Series::default(), values)], &keys);
        let labels: Vec<String> = drawn(&panel).into_iter().map(|bar| bar.label).collect();
        assert_eq!(labels, [UNKNOWN, UNKNOWN, UNKNOWN, "0.02"]);
        assert!(drawn(&panel)[0].to.is_nan() && drawn(&panel)[3].said == "0.02 ± 0.04");
        let differences = vec![about(-0.73, 0.2), alone, about(0.4, 0.3), about(0.000_013, 0.000_002)];
        let panel = difference_panel(INDEX, names, [(Series::default(), differences)], &keys);
        let labels: Vec<String> = drawn(&panel).into_iter().map(|bar| bar.label).collect();
        assert_eq!(labels, ["\u{2212}0.7", UNKNOWN, "0.4", "0.000013"]);
    }
}
