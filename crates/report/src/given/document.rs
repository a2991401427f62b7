//! Indices from given data as a document, with the chart of first-order indices.

use std::path::Path;

use apportion::given::InputIndices;
use apportion::result::{OutputDistribution, json};
use apportion::uncertainty::Estimate;
use apportion_base::text::listed;

use super::{GivenFile, GivenOutputRecord, measures, sentences};
use crate::chart::{Chart, Colour, Series};
use crate::document::{Document, OutputReport, Part, Report, Section, Table};
use crate::factor_bars::{INDEX, INDICES, MAX_BARS, index_panel, not_drawn};
use crate::format::{index, significant};
use crate::leading::{Contender, leader};

/// Builds the document of a result from given data, whose files begin with `name`.
pub fn given_document(result: &GivenFile, name: &str) -> Document {
    let outputs = result.outputs.iter().map(|output| {
        let chart = given_chart(result, output);
        OutputReport {
            name: &output.name,
            unit: "",
            warnings: &output.warnings,
            answer: chart.caption.clone(),
            parts: output_parts(output, index_table(result, output)),
            charts: vec![("", chart)],
        }
    });
    let (table, provenance) = (&result.table, &result.provenance);
    let mut rows = vec![
        ("rows used", table.rows.to_string()),
        ("rows left out", table.rows_dropped.to_string()),
        ("points", table.points.clone()),
    ];
    rows.extend(provenance.estimators.iter().map(|estimator| ("estimator", estimator.clone())));
    rows.extend(provenance.interval.iter().map(|interval| ("intervals", interval.clone())));
    rows.extend([("seed", provenance.seed.to_string()), ("table, SHA-256", format!("`{}`", table.sha256))]);
    // Without any index the file still has a header.
    let has_none = result.outputs.iter().all(|output| output.indices.is_none());
    Report {
        name: name.to_owned(),
        kicker: "Indices from given data",
        title: file_name(&table.file),
        lead: not_read(result).into_iter().collect(),
        first: vec![Section::new("warnings", "Warnings", Part::warnings(&result.warnings).into_iter().collect())],
        outputs: outputs.collect(),
        then: [measures::section(result, name), Some(Section::new("table", "The table", table_parts(result)))]
            .into_iter()
            .flatten()
            .collect(),
        notes: &result.notes,
        version: &provenance.apportion_version,
        provenance: rows,
        json: json(result),
        csv: result.outputs.first().filter(|_| has_none).map(|output| index_table(result, output)),
        csv_ending: "-indices",
        ..Report::default()
    }
    .document()
}

/// Lists the columns that are not inputs although they were not excluded.
fn not_read(result: &GivenFile) -> Option<String> {
    let left_out = &result.table.columns_left_out;
    let names: Vec<String> = left_out.iter().map(|column| format!("`{}`", column.name)).collect();
    let (columns, hold, are) = if names.len() == 1 { ("column", "holds", "is") } else { ("columns", "hold", "are") };
    (!names.is_empty()).then(|| {
        format!(
            "The {columns} {} {hold} no plain numbers and {are} not among the inputs: see the warning.",
            listed(&names)
        )
    })
}

/// Describes an output in addition to its chart.
fn output_parts(output: &GivenOutputRecord, table: Table) -> Vec<Part> {
    let mut parts: Vec<Part> = output.distribution.iter().map(|of| Part::Text(moments(of))).collect();
    if let Some(reason) = &output.reason {
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", output.name)));
    }
    parts.extend((!table.rows.is_empty()).then(|| table.into()));
    parts.extend(
        output
            .served()
            .map(|of| Part::Text(sentences::of_surrogate(of.explained, of.unknown, of.terms, &of.polynomials_of))),
    );
    let by_ranks = output.indices.as_deref().filter(|indices| indices.iter().any(|index| index.rank.is_some()));
    parts.extend(by_ranks.map(|indices| Part::Details {
        summary: "First-order indices by estimator".to_owned(),
        parts: vec![by_estimator(indices).into()],
    }));
    parts
}

/// Returns the name of a file without its folder.
fn file_name(file: &str) -> String {
    Path::new(file).file_name().map_or_else(|| file.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// Describes mean and standard deviation of an output.
fn moments(distribution: &OutputDistribution) -> String {
    match distribution.sd {
        Some(sd) => format!("Mean {}, standard deviation {}.", significant(distribution.mean), significant(sd)),
        None => format!("Mean {}.", significant(distribution.mean)),
    }
}

/// Formats three digits of a number without an error.
fn three(estimate: f64) -> String {
    index(Estimate::alone(estimate))
}

/// Formats an estimate with its error; empty for `None`.
fn or_empty(estimate: Option<Estimate>) -> String {
    estimate.map_or_else(String::new, index)
}

fn index_table(result: &GivenFile, output: &GivenOutputRecord) -> Table {
    let served = output.served();
    let first_order =
        "First-order index of each input, the part of the variance that knowing it removes, with its 95 % interval.";
    let left = served.filter(|of| of.unknown >= sentences::VISIBLE).map(|of| sentences::percent(of.unknown));
    let left = left.map(|left| format!(" Upper ends by the surrogate include the unexplained {left} of the variance."));
    let caption = match served {
        Some(_) => {
            format!("{first_order} S_T, the total index, includes interactions.{}", left.unwrap_or_default())
        }
        None => first_order.to_owned(),
    };
    let indices = output.indices.iter().flatten().enumerate();
    let rows = indices.map(|(number, index)| (index, output.first_order(number), served.map(|of| &of.indices[number])));
    let sum = served.map_or(output.sum_first_order, |of| Some(of.sum_first_order));
    let serves = result.outputs.iter().any(|output| output.served().is_some());
    Table::from_rows(caption, rows)
        .file("output", |_| &output.name)
        .text("input", |(index, ..)| &index.input)
        .named("input")
        .sum("sum")
        .number("S_1", |(_, shown, _)| or_empty(shown))
        .estimate("first_order", |(_, shown, _)| shown)
        .sum(sum.map_or_else(String::new, three))
        .file_estimate("rank", |(index, ..)| index.rank)
        .file_estimate("binned", |(index, ..)| Some(index.binned.estimate))
        .file("bins", |(index, ..)| index.binned.bins as u64)
        .file_estimate("surrogate", |(.., of)| of.map(|index| index.first_order))
        .number("S_T", |(.., of)| or_empty(of.map(|index| index.total)))
        .estimate("surrogate_total", |(.., of)| of.map(|index| index.total))
        .shown(serves)
        .sum("")
        .file("surrogate_unknown", |_| served.map(|of| of.unknown))
        .into()
}

/// Tabulates the two estimates that need no surrogate.
fn by_estimator(indices: &[InputIndices]) -> Table {
    let caption =
        "The estimates by ranks and by bins; the one with the wider interval is shown above unless a surrogate serves.";
    Table::from_rows(caption, indices)
        .text("input", |index| &index.input)
        .number("S_1, by ranks", |index| or_empty(index.rank))
        .number("S_1, by bins", |index| self::index(index.binned.estimate))
        .into()
}

/// Describes the table that was read.
fn table_parts(result: &GivenFile) -> Vec<Part> {
    let table = &result.table;
    let mut text = format!("{}: {} rows, {} inputs.", table.file, table.rows, result.inputs.len());
    if let Some(dependence) = &result.dependence {
        let (a, b) = &dependence.strongest.inputs;
        text.push_str(&format!(
            " Largest rank correlation between inputs: {} (`{a}`, `{b}`); chance reaches {}.",
            three(dependence.strongest.spearman),
            three(dependence.noise)
        ));
    }
    let inputs = Table::from_rows("The inputs: the indices hold between these values.", &result.inputs)
        .text("input", |input| &input.name)
        .number("smallest", |input| significant(input.min))
        .number("largest", |input| significant(input.max));
    vec![Part::Text(text), Part::OnPage(vec![inputs.into()])]
}

/// Draws the indices of one output as parts of its variance, one bar per input and kind, with their intervals; the
/// input of the largest index on top, of the largest total index if there are any.
pub fn given_chart(result: &GivenFile, output: &GivenOutputRecord) -> Chart {
    let indices = output.indices.as_deref().unwrap_or_default();
    let served = output.served().map(|of| &of.indices);
    let first_order: Vec<_> = (0..indices.len()).map(|k| output.first_order(k)).collect();
    let total: Vec<_> = (0..indices.len()).map(|k| served.map(|list| list[k].total)).collect();
    let leading = (0..indices.len()).map(|k| total[k].or(first_order[k]));
    let keys: Vec<f64> = leading.map(|index| index.map_or(f64::NAN, |index| index.estimate)).collect();
    let series = [(Series::new("S_1", Colour::Series(1)), first_order), (Series::new("S_T", Colour::Series(3)), total)];
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
    let mut contenders = Vec::new();
    for (number, index) in output.indices.iter().flatten().enumerate() {
        contenders.extend(output.first_order(number).map(|shown| Contender::new(&index.input, shown)));
    }
    match (leader(&contenders, &format!("For {}", output.name), "first-order index S_1", ""), &output.reason) {
        (Some(sentence), _) => format!("{sentence} From {} given rows.", result.table.rows),
        (None, Some(reason)) => format!("No indices of {}: {reason}.", output.name),
        (None, None) => format!("No indices of {}.", output.name),
    }
}
