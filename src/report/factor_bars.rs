//! Charts of factors: sorted level bars of indices, and the chart of percentages.

use super::chart::{Axis, Bar, Chart, Colour, Mark, Panel, Series, Shape};
use super::format::the;
use super::result::{EffectRecord, EstimateRecord, IntervalRecord, OutputRecord, ResultFile};

/// Most factors in a chart; the caption counts the rest.
pub(super) const MOST: usize = 30;
/// The axis of indices.
pub(super) const INDEX: &str = "Sobol' index (% of the variance)";

/// A series with its value for each factor; `None` is marked as missing.
pub(super) type IndexSeries = (Series, Vec<Option<EstimateRecord>>);

/// The series of first-order and of total indices.
pub(super) fn both_orders(
    first_order: Vec<Option<EstimateRecord>>,
    total: Vec<Option<EstimateRecord>>,
) -> [IndexSeries; 2] {
    [
        (Series::new("first order: alone", Colour::Series(5)), first_order),
        (Series::new("total: with all interactions", Colour::Series(1)), total),
    ]
}

/// A panel with a row for each factor, those with the largest keys on top, and bars of their indices in percent.
pub(super) fn index_panel(
    label: &str,
    factors: Vec<String>,
    series: impl IntoIterator<Item = IndexSeries>,
    keys: &[f64],
) -> Panel {
    let bars = |(series, values): IndexSeries| -> Vec<Mark> {
        let bar = |(row, value): (usize, Option<EstimateRecord>)| {
            let interval = value.and_then(|index| index.low.zip(index.high));
            let interval = interval.map(|(low, high)| (100.0 * low, 100.0 * high));
            series.mark(Shape::Bar(Bar::percent(row, value.map(|index| 100.0 * index.estimate), interval)))
        };
        values.into_iter().enumerate().map(bar).collect()
    };
    let rows = Axis::from_names("", factors);
    Panel::new(Axis::new(label, ""), rows).with(series.into_iter().flat_map(bars)).ranked(keys, MOST)
}

/// What a caption says of the factors that are not drawn.
pub(super) fn left_out(all: usize) -> String {
    if all <= MOST {
        return String::new();
    }
    format!(" Of {all} factors, the {MOST} with the largest total indices are drawn.")
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
/// total share on top. Of more than 30 factors, the first 30.
pub fn shares_chart(title: &str, caption: &str, factors: &[&str], series: &[SharesSeries<'_>]) -> Chart {
    let total: ShareOf = |e| (e.share_total, e.share_total_interval);
    let largest = |factor: &&str| {
        let shares = series.iter().filter_map(|series| share(series, factor, total).0);
        shares.fold(f64::NEG_INFINITY, f64::max)
    };
    let keys: Vec<f64> = factors.iter().map(largest).collect();
    let panel = |title: &str, of: ShareOf| {
        let rows = Axis::from_names("", factors.iter().map(|factor| label(factor)).collect());
        let bars = series.iter().flat_map(|series| {
            factors.iter().enumerate().map(move |(row, factor)| {
                let (value, interval) = share(series, factor, of);
                let published = series.published.iter().find(|(name, _)| name == factor).map(|(_, share)| *share);
                let bar = Bar::percent(row, value, interval.map(|i| (i.low, i.high)));
                series.series.mark(Shape::Bar(Bar { published, ..bar }))
            })
        });
        Panel::new(Axis::new("share of the sum of indices (%)", ""), rows).titled(title).with(bars).ranked(&keys, MOST)
    };
    let panels = [
        panel("First-order indices", |e| (e.share_first_order, e.share_first_order_interval)),
        panel("Total indices", total),
    ];
    Chart::new(title, format!("{caption}{}", left_out(factors.len()))).side_by_side().panels(panels)
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
    if indices().any(|index| index.effect.shapley.is_some()) {
        let names = indices().map(|index| label(&index.factor)).collect();
        let effects: Vec<Option<EstimateRecord>> = indices().map(|index| index.effect.shapley).collect();
        let keys: Vec<f64> = effects.iter().map(|effect| effect.map_or(f64::NAN, |effect| effect.estimate)).collect();
        let series = (Series::new("Shapley effect", Colour::Series(0)), effects);
        let panel = index_panel("Shapley effect (% of the variance)", names, [series], &keys);
        let caption = format!("Shapley effects on {}: they sum to 100 % of the variance.", the(&output.name));
        return Chart::new(title, caption).panels([panel]);
    }
    let caption = match indices().any(|index| index.effect.dependent.is_some()) {
        true => {
            "Indices of dependent factors share out nothing; Shapley effects would, and were not asked for.".to_owned()
        }
        false => caption(output),
    };
    let series = Series::new(label(&output.name), Colour::Series(0));
    shares_chart(title, &caption, &factors, &[SharesSeries { series, output, published: Vec::new() }])
}

/// What is seen, in one sentence.
fn caption(output: &OutputRecord) -> String {
    let name = the(&output.name);
    let largest =
        output.indices.iter().flatten().max_by(|a, b| a.effect.total.estimate.total_cmp(&b.effect.total.estimate));
    match (largest, &output.reason) {
        (Some(index), _) => format!(
            "Of all factors, {} has the largest total effect on {name}: its total index is {:.3}.",
            label(&index.factor),
            index.effect.total.estimate
        ),
        (None, Some(reason)) => format!("No shares of {name}: {reason}."),
        (None, None) => format!("No shares of {name}."),
    }
}

/// A factor's name as words.
pub(super) fn label(factor: &str) -> String {
    factor.replace('_', " ")
}
