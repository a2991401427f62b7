//! Indices from given data as a document.

use std::path::Path;

use super::{GivenFile, GivenOutputRecord, given_chart};
use super::{measures, sentences};
use crate::given::InputIndices;
use crate::report::csv::Field;
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Mark, Part, Section, Table, Value};
use crate::report::format::{index, name as words, significant};
use crate::report::leading::first_answers;
use crate::report::{file_stems, listed};
use crate::result::OutputDistribution;
use crate::result::json;
use crate::uncertainty::Estimate;

/// The document of a result from given data, whose files begin with `name`.
pub fn given_document(result: &GivenFile, name: &str) -> Document {
    let outputs: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
    let stems = file_stems(name, &outputs, &[""]);
    let mut sections =
        vec![Section::new("warnings", "Warnings", Part::warnings(&result.warnings).into_iter().collect())];
    sections.retain(|section| !section.parts.is_empty());
    let (mut lead, mut of_outputs) = (Vec::new(), Vec::new());
    for (place, (output, stem)) in result.outputs.iter().zip(stems).enumerate() {
        let chart = given_chart(result, output);
        lead.push(chart.caption().to_owned());
        let figure = Figure::new(place + 1, chart, stem, data_name(name));
        let mut parts = output_parts(output, index_table(result, output, name));
        parts.push(figure.into());
        of_outputs.push((words(&output.name), parts));
    }
    sections.extend(Document::sections_of_outputs(of_outputs));
    lead = first_answers(lead);
    sections.extend(measures::section(result, name));
    let notes = result.notes.iter().map(|note| format!("{}.", crate::report::capitalised(note))).collect();
    let note = Part::Notice { mark: Mark::Plain, kind: "Note".to_owned(), texts: notes };
    sections.push(Section::new("limits", "What these indices cannot say", vec![note]));
    sections.push(Section::new("table", "The table", table_parts(result)));
    lead.extend(not_read(result));
    let mut files = vec![DataFile::new(format!("{name}.json"), json(result))];
    // Without any index the table has a header still.
    if let Some(output) = result.outputs.first().filter(|_| result.outputs.iter().all(|o| o.indices.is_none())) {
        files.push(DataFile::new(data_name(name), index_table(result, output, name).csv()));
    }
    Document {
        name: name.to_owned(),
        kicker: "Indices from given data".to_owned(),
        title: file_name(&result.table.file),
        lead,
        sections,
        footer: format!("Made by apportion {}.", result.provenance.apportion_version),
        files,
        ..Document::default()
    }
}

/// Which columns are not among the inputs although nobody left them out.
fn not_read(result: &GivenFile) -> Option<String> {
    let left_out = &result.table.columns_left_out;
    let names: Vec<String> = left_out.iter().map(|column| format!("`{}`", column.name)).collect();
    let (columns, hold, are) = if names.len() == 1 { ("column", "holds", "is") } else { ("columns", "hold", "are") };
    (!names.is_empty()).then(|| {
        format!(
            "The {columns} {} {hold} no plain numbers and {are} not among the inputs: mind the warning.",
            listed(&names)
        )
    })
}

fn data_name(name: &str) -> String {
    format!("{name}-indices.csv")
}

/// What is said of an output besides its chart.
fn output_parts(output: &GivenOutputRecord, table: Table) -> Vec<Part> {
    let mut parts: Vec<Part> = Part::warnings(&output.warnings).into_iter().collect();
    parts.extend(output.distribution.as_ref().map(|distribution| Part::Text(moments(distribution))));
    if let Some(reason) = &output.reason {
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", output.name)));
    }
    parts.extend((!table.rows.is_empty()).then(|| table.into()));
    parts.extend(
        output
            .served()
            .map(|of| Part::Text(sentences::of_surrogate(of.explained, of.unknown, of.terms, &of.polynomials_of))),
    );
    parts
}

/// The name of a file without its folder.
fn file_name(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// Mean and standard deviation of an output in words.
fn moments(distribution: &OutputDistribution) -> String {
    match distribution.sd {
        Some(sd) => format!("Mean {}, standard deviation {}.", significant(distribution.mean), significant(sd)),
        None => format!("Mean {}.", significant(distribution.mean)),
    }
}

/// Three digits of a number without an error.
fn three(estimate: f64) -> String {
    index(Estimate::alone(estimate))
}

fn index_table(result: &GivenFile, output: &GivenOutputRecord, name: &str) -> Table {
    let all = || result.outputs.iter().flat_map(|output| output.indices.iter().flatten());
    let (ranks, bins) = (all().any(|index| index.rank.is_some()), all().any(|index| index.binned.is_some()));
    let method = |heading: &str, name: &str, used: bool| match used {
        true => Column::number(heading).named(Field::estimate(name)),
        false => Column::in_file(Field::estimate(name)),
    };
    let mut columns = vec![
        Column::in_file(Field::new("output")),
        Column::text("input").named(Field::new("input")),
        method("S_1, by ranks", "rank", ranks),
        method("S_1, by bins", "binned", bins),
        Column::in_file(Field::new("bins")),
    ];
    let asked = result.surrogate.is_some();
    if asked {
        let serves = result.outputs.iter().any(GivenOutputRecord::is_served);
        columns.extend([
            method("S_1, by surrogate", "surrogate", serves),
            method("S_T, by surrogate", "surrogate_total", serves),
            Column::in_file(Field::new("surrogate_unknown")),
        ]);
    }
    let cell = |record: Option<Estimate>| Cell::valued(record.map_or_else(String::new, index), Value::Estimate(record));
    let row = |(number, index): (usize, &InputIndices)| {
        let bins = index.binned.map_or(Value::Empty, |binned| Value::Count(binned.bins as u64));
        let mut row = vec![
            Cell::from(&output.name),
            Cell::from(&index.input),
            cell(index.rank),
            cell(index.binned.map(|binned| binned.estimate)),
            Cell::valued("", bins),
        ];
        if asked {
            let served = output.served().map(|of| &of.indices[number]);
            let unknown = output.served().map_or(Value::Empty, |of| Value::Number(of.unknown));
            row.extend([
                cell(served.map(|index| index.first_order)),
                cell(served.map(|index| index.total)),
                Cell::valued("", unknown),
            ]);
        }
        row
    };
    // The sum is that of the leading estimates, by ranks where there are any.
    let sum: Cell = output.sum_first_order.map_or_else(String::new, three).into();
    let of_method = if ranks { [sum, Cell::default()] } else { [Cell::default(), sum] };
    let names: [Cell; 2] = [Cell::default(), "sum".into()];
    let mut sums: Vec<Cell> = names.into_iter().chain(of_method).chain([Cell::default()]).collect();
    if asked {
        let sum = output.served().map_or_else(String::new, |of| three(of.sum_first_order));
        sums.extend([sum.into(), Cell::default(), Cell::default()]);
    }
    let rows = output.indices.iter().flatten().enumerate().map(row);
    let first_order =
        "First-order index of each input, the part of the variance that knowing it removes, with its 95 % interval.";
    let caption = match output.served() {
        Some(of) => {
            let left = match of.unknown >= sentences::VISIBLE {
                true => format!(
                    " Upper ends by the surrogate contain what it leaves, {} of the variance.",
                    sentences::percent(of.unknown)
                ),
                false => String::new(),
            };
            format!("{first_order} S_T, the total index, has the interactions as well.{left}")
        }
        None => first_order.to_owned(),
    };
    Table { file: data_name(name), sums, ..Table::new(caption, columns).with_rows(rows) }
}

/// What was read, and how the numbers came about.
fn table_parts(result: &GivenFile) -> Vec<Part> {
    let (table, provenance) = (&result.table, &result.provenance);
    let mut text = format!("{}: {} rows, {} inputs.", table.file, table.rows, result.inputs.len());
    if let Some(dependence) = &result.dependence {
        let (a, b) = &dependence.strongest.inputs;
        text.push_str(&format!(
            " Largest rank correlation between inputs: {} (`{a}`, `{b}`); chance reaches {}.",
            three(dependence.strongest.spearman),
            three(dependence.noise)
        ));
    }
    let mut rows = vec![
        ("program", format!("apportion {}", provenance.apportion_version)),
        ("rows used", table.rows.to_string()),
        ("rows left out", table.rows_dropped.to_string()),
        ("points", table.points.clone()),
        ("method", provenance.method.clone()),
    ];
    rows.extend(provenance.estimators.iter().map(|estimator| ("estimator", estimator.clone())));
    rows.extend(provenance.interval.iter().map(|interval| ("intervals", interval.clone())));
    rows.push(("seed", provenance.seed.to_string()));
    rows.push(("table, SHA-256", format!("`{}`", table.sha256)));
    let inputs = result.inputs.iter().map(|input| -> Vec<Cell> {
        vec![Cell::from(&input.name), significant(input.min).into(), significant(input.max).into()]
    });
    let columns = Column::list(1, &["input", "smallest", "largest"]);
    let inputs = Table::new("The inputs: the indices hold between these values.", columns).with_rows(inputs);
    let settings = Table::pairs("How the numbers came about.", rows);
    vec![Part::Text(text), Part::OnPage(vec![Part::Table(inputs), Part::Table(settings)])]
}
