//! Indices from given data for a terminal and for a spreadsheet.

use super::{GivenFile, GivenIndexRecord, GivenOutputRecord};
use crate::report::result::EstimateRecord;
use crate::report::tables::{TextTable, csv_field, estimate, fixed, significant, table};

/// The result as text: the table that was read, for every output its indices and warnings, then the notes.
pub fn given_summary(result: &GivenFile) -> String {
    let mut text = format!("{}: {} rows, {} inputs\n", result.table.file, result.table.rows, result.inputs.len());
    if let Some(dependence) = &result.dependence {
        let (a, b) = &dependence.inputs;
        text.push_str(&format!(
            "largest rank correlation between inputs: {} (`{a}`, `{b}`); chance reaches {}\n",
            fixed(dependence.spearman, 3),
            fixed(dependence.noise, 3)
        ));
    }
    for output in &result.outputs {
        text.push('\n');
        text.push_str(&output_summary(output));
    }
    if !result.warnings.is_empty() {
        text.push('\n');
    }
    for warning in &result.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text.push('\n');
    for note in &result.notes {
        text.push_str(&format!("note: {note}\n"));
    }
    text
}

fn output_summary(output: &GivenOutputRecord) -> String {
    let mut text = output.name.clone();
    if let Some(distribution) = &output.distribution {
        text.push_str(&format!(": mean {}", significant(distribution.mean)));
        if let Some(sd) = distribution.sd {
            text.push_str(&format!(", standard deviation {}", significant(sd)));
        }
    }
    text.push('\n');
    if let Some(indices) = &output.indices {
        text.push_str(&format!("{}\n", index_table(indices, output.sum_first_order)));
    }
    if let Some(reason) = &output.reason {
        text.push_str(&format!("no indices: {reason}\n"));
    }
    for warning in &output.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}

fn index_table(indices: &[GivenIndexRecord], sum: Option<f64>) -> TextTable {
    let ranks = indices.iter().any(|index| index.rank.is_some());
    let bins = indices.iter().any(|index| index.binned.is_some());
    let mut header = vec!["input"];
    header.extend(ranks.then_some("first order S, by ranks"));
    header.extend(bins.then_some("first order S, by bins"));
    let mut table = table(&header, &[0]);
    let cell = |record: Option<EstimateRecord>| record.map_or_else(String::new, |record| estimate(record, 3));
    for index in indices {
        let mut row = vec![index.input.clone()];
        row.extend(ranks.then(|| cell(index.rank)));
        row.extend(bins.then(|| cell(index.binned.map(|binned| binned.estimate))));
        table.add_row(row);
    }
    // The sum is that of the column of leading estimates, the first one.
    let mut row = vec!["sum".to_owned(), sum.map_or_else(String::new, |sum| fixed(sum, 3))];
    row.extend((ranks && bins).then(String::new));
    table.add_row(row);
    table
}

/// Indices as CSV: one line per output and input; an empty cell where there is no number.
pub fn given_csv(result: &GivenFile) -> String {
    let mut text = String::from("output,input,rank,rank_low,rank_high,binned,binned_low,binned_high,bins\n");
    let number = |number: Option<f64>| number.map_or_else(String::new, |x| x.to_string());
    for output in &result.outputs {
        for index in output.indices.iter().flatten() {
            let estimates = [index.rank, index.binned.map(|binned| binned.estimate)];
            let numbers = estimates.map(|record| {
                let parts = [record.map(|r| r.estimate), record.and_then(|r| r.low), record.and_then(|r| r.high)];
                parts.map(number).join(",")
            });
            let bins = index.binned.map_or_else(String::new, |binned| binned.bins.to_string());
            let names = [&output.name, &index.input].map(|name| csv_field(name)).join(",");
            text.push_str(&format!("{names},{},{bins}\n", numbers.join(",")));
        }
    }
    text
}
