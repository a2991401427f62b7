//! The chart of first-order indices from given data.

use super::{GivenFile, GivenIndexRecord, GivenOutputRecord};
use crate::report::chart::{Chart, Colour, Series};
use crate::report::factor_bars::{INDEX, index_panel, left_out};
use crate::report::format::percent;
use crate::report::leading::{Contender, may_lead, names};
use crate::report::result::EstimateRecord;

/// The indices of one output as parts of its variance, one bar per input and method, with their intervals; the input of
/// the largest index on top, of the largest total index where there are any.
pub fn given_chart(result: &GivenFile, output: &GivenOutputRecord) -> Chart {
    let indices = output.indices.as_deref().unwrap_or_default();
    let ranks: Vec<_> = indices.iter().map(|index| index.rank).collect();
    let bins: Vec<_> = indices.iter().map(|index| index.binned.map(|binned| binned.estimate)).collect();
    let served = output.served().map(|of| &of.indices);
    let by_surrogate: Vec<_> = (0..indices.len()).map(|k| served.map(|list| list[k].first_order)).collect();
    let total: Vec<_> = (0..indices.len()).map(|k| served.map(|list| list[k].total)).collect();
    let leading = |k: usize| total[k].or(ranks[k]).or(bins[k]).map_or(f64::NAN, |index| index.estimate);
    let keys: Vec<f64> = (0..indices.len()).map(leading).collect();
    let series = [
        (Series::new("by ranks", Colour::Series(1)), ranks),
        (Series::new("by bins", Colour::Series(5)), bins),
        (Series::new("by surrogate", Colour::Series(2)), by_surrogate),
        (Series::new("total, by surrogate", Colour::Series(3)), total),
    ];
    let used = series.into_iter().filter(|(_, values)| values.iter().any(Option::is_some));
    let inputs: Vec<String> = indices.iter().map(|index| index.input.clone()).collect();
    let beyond = left_out(inputs.len());
    let (axis, title) = match served {
        Some(_) => (INDEX, "Indices"),
        None => ("first-order index: part of the variance", "First-order indices"),
    };
    let panel = index_panel(axis, inputs, used, &keys);
    Chart::new(format!("{title} of {}", output.name), caption(result, output) + &beyond).panels([panel])
}

/// What is more than this part of a variance is most of it.
const HALF: f64 = 0.5;

/// Whether an index cannot be told from 0.
fn is_nothing(index: EstimateRecord) -> bool {
    index.estimate <= 0.0 || index.low.is_some_and(|low| low <= 0.0)
}

/// What is seen, in one sentence.
fn caption(result: &GivenFile, output: &GivenOutputRecord) -> String {
    let leading = |(number, index): (usize, &GivenIndexRecord)| {
        let by_surrogate = output.served().map(|of| of.indices[number].first_order);
        let total = by_surrogate.or(index.rank).or(index.binned.map(|binned| binned.estimate))?;
        Some(Contender { label: index.input.clone(), first_order: None, total, probability: None })
    };
    let known: Vec<Contender> = output.indices.iter().flatten().enumerate().filter_map(leading).collect();
    let from = format!("From {} given rows", result.table.rows);
    let inputs = if result.table.columns_left_out.is_empty() { "all inputs" } else { "the inputs that were read" };
    match (&may_lead(&known)[..], &output.reason) {
        ([lead, ..], _) if known.iter().all(|input| is_nothing(input.total)) => {
            let (input, share) = (&known[*lead].label, percent(known[*lead].total));
            let largest = if known[*lead].total.estimate > 0.0 {
                format!("; the largest estimate is that of {input}, {share} of its variance")
            } else {
                String::new()
            };
            format!("{from}: no input alone explains a part of {} that can be told from 0{largest}.", output.name)
        }
        ([lead], _) => {
            let (input, share) = (&known[*lead].label, percent(known[*lead].total));
            let most = if known[*lead].total.estimate >= HALF { "most" } else { "the largest part" };
            format!("{from}: of {inputs}, {input} alone explains {most} of {}, {share} of its variance.", output.name)
        }
        (leaders @ [_, ..], _) => {
            let share = |contender: &Contender| percent(contender.total);
            let names = names(&known, leaders, &share);
            format!(
                "{from}: which input alone explains the largest part of {} cannot be told apart: {names} of its variance.",
                output.name
            )
        }
        ([], Some(reason)) => format!("No indices of {}: {reason}.", output.name),
        ([], None) => format!("No indices of {}.", output.name),
    }
}
