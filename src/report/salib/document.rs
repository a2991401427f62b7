//! Indices at the points of SALib as a document.

use super::chart::salib_chart;
use super::record::{SalibFile, SalibOutputRecord};
use crate::report::csv::{Csv, fields};
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Mark, Part, Section, Table, Value};
use crate::report::file_names::FileNames;
use crate::report::file_stems;
use crate::report::format::{index, name as words};
use crate::report::given::{file_name, moments};
use crate::report::records::json;
use crate::report::result::EstimateRecord;

/// The document of a result at the points of SALib, whose files begin with `name`.
pub fn salib_document(result: &SalibFile, name: &str) -> Document {
    let outputs: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
    let (mut sections, mut lead) = (Vec::new(), Vec::new());
    for (place, (output, stem)) in result.outputs.iter().zip(file_names(name, &outputs).charts).enumerate() {
        let chart = salib_chart(result, output);
        lead.push(chart.caption().to_owned());
        let figure = Figure::new(place + 1, chart, stem, format!("{name}-indices.csv"));
        let mut parts = output_parts(output);
        parts.push(figure.into());
        sections.push(Section::new(&format!("output-{}", place + 1), &words(&output.name), parts));
    }
    sections.push(Section::new("table", "The table", table_parts(result)));
    Document {
        name: name.to_owned(),
        kicker: "Indices at the points of SALib".to_owned(),
        title: file_name(&result.table.file),
        lead,
        sections,
        footer: format!("Made by apportion {}.", result.provenance.apportion_version),
        files: vec![
            DataFile::new(format!("{name}.json"), json(result)),
            DataFile::new(format!("{name}-indices.csv"), salib_csv(result)),
        ],
        ..Document::default()
    }
}

/// The names of the files of a result at the points of SALib.
pub fn file_names(name: &str, outputs: &[&str]) -> FileNames {
    let stems = file_stems(name, outputs, &["-indices"]);
    FileNames {
        name: name.to_owned(),
        data: vec![format!("{name}.json"), format!("{name}-indices.csv")],
        charts: stems.into_iter().map(|stem| format!("{stem}-indices")).collect(),
    }
}

fn output_parts(output: &SalibOutputRecord) -> Vec<Part> {
    let mut parts: Vec<Part> =
        output.distribution.iter().map(|distribution| Part::Text(moments(distribution))).collect();
    let cell = |record: EstimateRecord| Cell::from(index(record));
    if let Some(indices) = &output.indices {
        let rows = indices.iter().map(|i| vec![Cell::from(&i.input), cell(i.first_order), cell(i.total)]);
        let caption = "First-order index S_1 and total index S_T, each with its 95 % interval.";
        let columns = Column::list(1, &["input", "S_1", "S_T"]);
        parts.push(Part::Table(Table::new(caption, columns).with_rows(rows)));
    }
    if let Some(pairs) = &output.second_order {
        let rows = pairs.iter().map(|pair| {
            let (a, b) = &pair.inputs;
            vec![format!("{a}, {b}").into(), cell(pair.second_order)]
        });
        let caption = "Second-order indices: what two inputs do together beyond what each does alone.";
        parts.push(Part::Table(Table::new(caption, Column::list(1, &["pair", "S_2"])).with_rows(rows)));
    }
    if let Some(reason) = &output.reason {
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", output.name)));
    }
    parts
}

/// What was read, and how the numbers came about.
fn table_parts(result: &SalibFile) -> Vec<Part> {
    let (table, provenance) = (&result.table, &result.provenance);
    let layout = if table.layout == "second-order" { "with second order" } else { "without second order" };
    let read = format!(
        "{}: {} rows, {} base samples of {} rows (SALib, {layout}).",
        table.file, table.rows, table.base_samples, table.rows_per_point
    );
    let mut parts = vec![Part::Text(read)];
    parts.extend(provenance.interval.as_ref().map(|interval| Part::Text(format!("Intervals: {interval}."))));
    let notes = result.notes.iter().map(|note| format!("{}.", crate::report::capitalised(note))).collect();
    parts.push(Part::Notice { mark: Mark::Plain, kind: "Note".to_owned(), texts: notes });
    let mut rows = vec![("program", format!("apportion {}", provenance.apportion_version))];
    rows.extend(provenance.estimators.iter().map(|estimator| ("estimator", estimator.clone())));
    rows.push(("resamples", provenance.resamples.to_string()));
    rows.push(("seed", provenance.seed.to_string()));
    rows.push(("table, SHA-256", format!("`{}`", table.sha256)));
    parts.push(Part::OnPage(vec![Part::Table(Table::pairs("How the numbers came about.", rows))]));
    parts
}

/// Indices as CSV: one line per output and index; the second input is empty but for second order.
fn salib_csv(result: &SalibFile) -> String {
    let mut csv = Csv::new(fields(&["output", "index", "input", "second_input", "estimate", "low", "high"], &[]));
    let mut line = |output: &str, index: &str, inputs: [&str; 2], record: EstimateRecord| {
        let texts = [output, index, inputs[0], inputs[1]].map(Value::from);
        csv.row(texts.into_iter().chain([record.into()]));
    };
    for output in &result.outputs {
        for index in output.indices.iter().flatten() {
            line(&output.name, "S1", [&index.input, ""], index.first_order);
            line(&output.name, "ST", [&index.input, ""], index.total);
        }
        for pair in output.second_order.iter().flatten() {
            line(&output.name, "S2", [&pair.inputs.0, &pair.inputs.1], pair.second_order);
        }
    }
    csv.text()
}
