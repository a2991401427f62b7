//! The chart of first-order indices from given data.

use super::{GivenFile, GivenIndexRecord, GivenOutputRecord};
use crate::report::chart::{Bar, Chart, GroupedBars, Panel, Role, Series};
use crate::report::leading::{Contender, may_lead, names, percent};
use crate::report::result::EstimateRecord;

/// The indices of one output in percent of its variance, one bar per input and method, with their intervals.
pub fn given_chart(result: &GivenFile, output: &GivenOutputRecord) -> Chart {
    let rank = |index: &GivenIndexRecord| index.rank;
    let binned = |index: &GivenIndexRecord| index.binned.map(|binned| binned.estimate);
    let indices = output.indices.as_deref().unwrap_or_default();
    let series =
        [series("by ranks", Role::Other(0), indices, rank), series("by bins", Role::Other(2), indices, binned)];
    Chart::Bars(GroupedBars {
        title: format!("First-order indices of {}", output.name),
        caption: caption(result, output),
        y_label: "first-order index (% of the variance)".to_owned(),
        interval_label: "95 % interval".to_owned(),
        published_label: String::new(),
        panels: vec![Panel {
            title: String::new(),
            categories: indices.iter().map(|index| index.input.clone()).collect(),
            series: series.into_iter().flatten().collect(),
        }],
    })
}

/// The bars of one method; `None` if it was not used.
fn series(
    name: &str,
    role: Role,
    indices: &[GivenIndexRecord],
    of: impl Fn(&GivenIndexRecord) -> Option<EstimateRecord>,
) -> Option<Series> {
    let bar = |record: EstimateRecord| Bar {
        value: 100.0 * record.estimate,
        interval: record.low.zip(record.high).map(|(low, high)| (100.0 * low, 100.0 * high)),
    };
    let values: Vec<Option<Bar>> = indices.iter().map(|index| of(index).map(bar)).collect();
    let used = values.iter().any(Option::is_some);
    used.then(|| Series { name: name.to_owned(), role, values, published: Vec::new() })
}

/// What is seen, in one sentence.
fn caption(result: &GivenFile, output: &GivenOutputRecord) -> String {
    let leading = |index: &GivenIndexRecord| {
        let total = index.rank.or(index.binned.map(|binned| binned.estimate))?;
        Some(Contender { label: index.input.clone(), first_order: None, total, probability: None })
    };
    let known: Vec<Contender> = output.indices.iter().flatten().filter_map(leading).collect();
    let from = format!("From {} given rows", result.table.rows);
    match (&may_lead(&known)[..], &output.reason) {
        ([lead], _) if known[*lead].total.estimate > 0.0 => {
            let (input, share) = (&known[*lead].label, percent(known[*lead].total.estimate));
            format!("{from}: of all inputs, {input} alone explains most of {}, {share} of its variance.", output.name)
        }
        ([lead, ..], _) if known[*lead].total.estimate <= 0.0 => {
            format!("{from}: no input alone explains a part of {} that can be told from 0.", output.name)
        }
        (leaders @ [_, ..], _) => {
            let share = |contender: &Contender| percent(contender.total.estimate);
            let names = names(&known, leaders, &share);
            format!(
                "{from}: which input alone explains most of {} cannot be told apart: {names} of its variance.",
                output.name
            )
        }
        ([], Some(reason)) => format!("No indices of {}: {reason}.", output.name),
        ([], None) => format!("No indices of {}.", output.name),
    }
}
