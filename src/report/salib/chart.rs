//! The chart of indices at the points of SALib.

use super::record::{SalibFile, SalibIndexRecord, SalibOutputRecord};
use crate::report::chart::Chart;
use crate::report::factor_bars::{left_out, pair_panel};
use crate::report::leading::{Contender, decides_most};
use crate::report::result::EstimateRecord;

/// First-order and total index of every input, as parts of the output's variance, with their intervals; the largest total
/// index on top.
pub fn salib_chart(result: &SalibFile, output: &SalibOutputRecord) -> Chart {
    let indices = output.indices.as_deref().unwrap_or_default();
    let inputs = indices.iter().map(|index| index.input.clone()).collect();
    let read = |of: fn(&SalibIndexRecord) -> EstimateRecord| indices.iter().map(|index| Some(of(index))).collect();
    let keys: Vec<f64> = indices.iter().map(|index| index.total.estimate).collect();
    let title = format!("Sobol' indices of {}", output.name);
    let caption = caption(result, output) + &left_out(indices.len());
    Chart::new(title, caption).panels([pair_panel(
        inputs,
        read(|index| index.first_order),
        read(|index| index.total),
        &keys,
    )])
}

/// What is seen, in one sentence.
fn caption(result: &SalibFile, output: &SalibOutputRecord) -> String {
    let contender = |index: &SalibIndexRecord| Contender {
        label: index.input.clone(),
        first_order: Some(index.first_order),
        total: index.total,
        probability: None,
    };
    let contenders: Vec<Contender> = output.indices.iter().flatten().map(contender).collect();
    match (decides_most(&contenders, &output.name), &output.reason) {
        (Some(said), _) => format!("{said} (from {} base samples made by SALib).", result.table.base_samples),
        (None, Some(reason)) => format!("No indices of {}: {reason}.", output.name),
        (None, None) => format!("No indices of {}.", output.name),
    }
}
