//! Indices at the points of SALib for a terminal, for a spreadsheet, and as a chart.

use super::record::{SalibFile, SalibIndexRecord, SalibOutputRecord};
use crate::report::chart::{Bar, Chart, GroupedBars, Panel, Role, Series};
use crate::report::leading::{Contender, decides_most};
use crate::report::result::EstimateRecord;
use crate::report::tables::{csv_field, estimate, significant, table};

/// The result as text: the table that was read, for every output its indices, then the notes.
pub fn salib_summary(result: &SalibFile) -> String {
    let about = &result.table;
    let mut text = format!(
        "{}: {} rows, {} base samples of {} rows (SALib, {})\n",
        about.file,
        about.rows,
        about.base_samples,
        about.rows_per_point,
        if about.layout == "second-order" { "with second order" } else { "without second order" }
    );
    for output in &result.outputs {
        text.push_str(&format!("\n{}", output.name));
        if let Some(distribution) = &output.distribution {
            text.push_str(&format!(": mean {}", significant(distribution.mean)));
            if let Some(sd) = distribution.sd {
                text.push_str(&format!(", standard deviation {}", significant(sd)));
            }
        }
        text.push('\n');
        if let Some(indices) = &output.indices {
            let mut rows = table(&["input", "first order S1", "total ST"], &[0]);
            for index in indices {
                rows.add_row([index.input.clone(), estimate(index.first_order, 3), estimate(index.total, 3)]);
            }
            text.push_str(&format!("{rows}\n"));
        }
        if let Some(pairs) = &output.second_order {
            let mut rows = table(&["pair", "second order S2"], &[0]);
            for pair in pairs {
                rows.add_row([format!("{}, {}", pair.inputs.0, pair.inputs.1), estimate(pair.second_order, 3)]);
            }
            text.push_str(&format!("\n{rows}\n"));
        }
        if let Some(reason) = &output.reason {
            text.push_str(&format!("no indices: {reason}\n"));
        }
    }
    text.push('\n');
    if let Some(interval) = &result.provenance.interval {
        text.push_str(&format!("intervals: {interval}\n"));
    }
    for note in &result.notes {
        text.push_str(&format!("note: {note}\n"));
    }
    text
}

/// Indices as CSV: one line per output and index; the second input is empty but for second order.
pub fn salib_csv(result: &SalibFile) -> String {
    let mut text = String::from("output,index,input,second_input,estimate,low,high\n");
    let number = |number: Option<f64>| number.map_or_else(String::new, |x| x.to_string());
    let mut line = |output: &SalibOutputRecord, index: &str, inputs: [&str; 2], record: EstimateRecord| {
        let names = [&output.name, index, inputs[0], inputs[1]].map(csv_field).join(",");
        text.push_str(&format!("{names},{},{},{}\n", record.estimate, number(record.low), number(record.high)));
    };
    for output in &result.outputs {
        for index in output.indices.iter().flatten() {
            line(output, "S1", [&index.input, ""], index.first_order);
            line(output, "ST", [&index.input, ""], index.total);
        }
        for pair in output.second_order.iter().flatten() {
            line(output, "S2", [&pair.inputs.0, &pair.inputs.1], pair.second_order);
        }
    }
    text
}

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
