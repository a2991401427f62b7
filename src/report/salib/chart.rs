//! The chart of indices at the points of SALib.

use super::record::{SalibFile, SalibIndexRecord, SalibOutputRecord};
use crate::report::chart::{Bar, Chart, GroupedBars, Panel, Role, Series};
use crate::report::leading::{Contender, decides_most};
use crate::report::result::EstimateRecord;

/// First-order and total index of every input side by side, in percent of the output's variance, with their intervals.
pub fn salib_chart(result: &SalibFile, output: &SalibOutputRecord) -> Chart {
    let indices = output.indices.as_deref().unwrap_or_default();
    let bar = |record: EstimateRecord| Bar {
        value: 100.0 * record.estimate,
        interval: record.low.zip(record.high).map(|(low, high)| (100.0 * low, 100.0 * high)),
    };
    let series = |name: &str, role: Role, read: fn(&SalibIndexRecord) -> EstimateRecord| Series {
        name: name.to_owned(),
        role,
        values: indices.iter().map(|index| Some(bar(read(index)))).collect(),
        published: Vec::new(),
    };
    Chart::Bars(GroupedBars {
        title: format!("Sobol' indices of {}", output.name),
        caption: caption(result, output),
        y_label: "Sobol' index (% of the variance)".to_owned(),
        interval_label: "95 % interval, by bootstrap".to_owned(),
        published_label: String::new(),
        panels: vec![Panel {
            title: String::new(),
            categories: indices.iter().map(|index| index.input.clone()).collect(),
            series: vec![
                series("first order: alone", Role::Other(2), |index| index.first_order),
                series("total: with all interactions", Role::Other(0), |index| index.total),
            ],
        }],
    })
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
