//! The chart of first-order indices from given data.

use apportion::given::InputIndices;

use super::{GivenFile, GivenOutputRecord};
use crate::chart::{Chart, Colour, Series};
use crate::factor_bars::{INDEX, INDICES, MAX_BARS, index_panel, not_drawn};
use crate::leading::{Contender, leader};

/// Draws the indices of one output as parts of its variance, one bar per input and method, with their intervals; the
/// input of the largest index on top, of the largest total index if there are any.
pub fn given_chart(result: &GivenFile, output: &GivenOutputRecord) -> Chart {
    let indices = output.indices.as_deref().unwrap_or_default();
    let ranks: Vec<_> = indices.iter().map(|index| index.rank).collect();
    let bins: Vec<_> = indices.iter().map(|index| Some(index.binned.estimate)).collect();
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
    let beyond = not_drawn(inputs.len(), MAX_BARS);
    let (axis, title) = match served {
        Some(_) => (INDEX, "Indices"),
        None => ("first-order index: part of the variance", "First-order indices"),
    };
    let panel = index_panel(axis, inputs, used, INDICES, &keys);
    Chart::new(format!("{title} of {}", output.name), caption(result, output) + &beyond).panels([panel])
}

/// Says which input explains most by itself.
fn caption(result: &GivenFile, output: &GivenOutputRecord) -> String {
    let contender = |(number, index): (usize, &InputIndices)| {
        let by_surrogate = output.served().map(|of| of.indices[number].first_order);
        Contender::new(&index.input, by_surrogate.unwrap_or(index.leading()))
    };
    let known: Vec<Contender> = output.indices.iter().flatten().enumerate().map(contender).collect();
    match (leader(&known, &format!("For {}", output.name), "first-order index S_1", ""), &output.reason) {
        (Some(sentence), _) => format!("{sentence} From {} given rows.", result.table.rows),
        (None, Some(reason)) => format!("No indices of {}: {reason}.", output.name),
        (None, None) => format!("No indices of {}.", output.name),
    }
}
