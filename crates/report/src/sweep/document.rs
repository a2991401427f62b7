//! Sweeps as a document.

use apportion::model::MIN_OUTPUTS_TOGETHER;
use apportion::result::json;
use apportion::sweep::{NominalOutput, Sweep, SweptOutput};

use super::charts::figures;
use super::record::{value_in_words, width};
use super::{SweepFile, gap_lines};
use crate::document::{Document, Mark, OutputReport, Part, Report, Section, Table, Value};
use crate::format::{grouped, heading, name, or_dash, short, short_with_unit, value};

/// Builds the document of sweeps.
pub fn sweep_document(file: &SweepFile) -> Document {
    let (ranges, curves) = figures(file);
    let outputs = file.nominal.iter().zip(ranges).enumerate().map(|(place, (nominal, ranges))| OutputReport {
        name: &nominal.output,
        unit: &nominal.unit,
        answer: widest(file, nominal, place),
        parts: vec![Part::Text(at_nominal(nominal)), effects(file, nominal, place), ranges.into()],
        ..OutputReport::default()
    });
    let mut parts: Vec<Part> = Part::warnings(&file.warnings).into_iter().collect();
    let texts: Vec<String> = file.sweeps.iter().flat_map(gap_lines).map(|line| format!("{line}.")).collect();
    let failed = Part::Notice { mark: Mark::Mixed, kind: "Failed".to_owned(), texts };
    parts.extend(file.sweeps.iter().any(|sweep| !gap_lines(sweep).is_empty()).then_some(failed));
    parts.extend(curves.into_iter().zip(&file.sweeps).map(|(figure, sweep)| match file.nominal.len() {
        ..MIN_OUTPUTS_TOGETHER => figure.into(),
        _ => Part::Details { summary: name(&sweep.factor), parts: vec![figure.into()] },
    }));
    Report {
        name: format!("{}-sweep", file.study.name),
        kicker: "One factor at a time",
        title: file.study.headline().to_owned(),
        outputs: outputs.collect(),
        then: vec![Section::new("curves", "Outputs against each factor", parts)],
        validity: &file.validity,
        study: Some(&file.study),
        version: &file.provenance.apportion_version,
        provenance: vec![("model runs", grouped(file.provenance.model_runs))],
        json: json(file),
        csv: Some(all_values(file)),
        ..Report::default()
    }
    .document()
}

/// Says which factor changes an output most.
fn widest(file: &SweepFile, nominal: &NominalOutput, number: usize) -> String {
    let output = name(&nominal.output);
    match by_width(file, number).first() {
        Some((sweep, SweptOutput { low: Some(low), high: Some(high), .. })) if high > low => format!(
            "With all other factors nominal, {} changes {output} most: between {} and {}.",
            name(&sweep.factor),
            value(*low, ""),
            value(*high, &nominal.unit)
        ),
        Some(_) => format!("No factor alone changes {output}, where it has values."),
        None => format!("No factor was swept for {output}."),
    }
}

/// Returns the sweeps with their effect on an output, the widest first.
fn by_width(file: &SweepFile, number: usize) -> Vec<(&Sweep, &SweptOutput)> {
    let mut sweeps: Vec<(&Sweep, &SweptOutput)> =
        file.sweeps.iter().filter_map(|sweep| Some((sweep, sweep.outputs.get(number)?))).collect();
    sweeps.sort_by(|a, b| width(b.1).total_cmp(&width(a.1)));
    sweeps
}

fn at_nominal(nominal: &NominalOutput) -> String {
    match (nominal.value, &nominal.reason) {
        (Some(value), _) => {
            format!(
                "{} = {} where every factor is nominal.",
                name(&nominal.output),
                short_with_unit(value, &nominal.unit)
            )
        }
        (None, reason) => format!(
            "{} has no value where every factor is nominal: {}.",
            name(&nominal.output),
            reason.as_deref().unwrap_or("the run failed")
        ),
    }
}

/// Tabulates how far each factor changes an output, the widest first.
fn effects(file: &SweepFile, nominal: &NominalOutput, number: usize) -> Part {
    let in_unit = |what: &str| heading(what, &nominal.unit);
    let caption = format!(
        "Effect of each factor alone on {}, with all others nominal, the widest range first.",
        name(&nominal.output)
    );
    let said = |value: Option<f64>| or_dash(value, short);
    Table::from_rows(caption, by_width(file, number))
        .text("factor", |(sweep, _)| name(&sweep.factor))
        .number("from", |(sweep, _)| value_in_words(sweep, 0))
        .number("to", |(sweep, _)| value_in_words(sweep, sweep.values.len().saturating_sub(1)))
        .number(in_unit("output from"), |(_, effect)| said(effect.values.first().copied().flatten()))
        .number(in_unit("to"), |(_, effect)| said(effect.values.last().copied().flatten()))
        .number(in_unit("least"), |(_, effect)| said(effect.low))
        .number(in_unit("largest"), |(_, effect)| said(effect.high))
        .number("moves by %", |(_, effect)| said(effect.percent))
        .into()
}

/// Returns a line per factor, curve, output and value; a missing number is empty, with the reason in the last column.
fn all_values(file: &SweepFile) -> Table {
    let outputs = file.sweeps.iter().flat_map(|sweep| sweep.outputs.iter().map(move |output| (sweep, output)));
    let rows = outputs.flat_map(|row| (0..row.0.values.len()).map(move |place| (row, place)));
    Table::from_rows("", rows)
        .file("factor", |((sweep, _), _)| &sweep.factor)
        .file("unit", |((sweep, _), _)| &sweep.unit)
        .file("value", |((sweep, _), place)| match &sweep.labels {
            Some(labels) => Value::from(&labels[place]),
            None => sweep.values[place].into(),
        })
        .file("output", |((_, output), _)| &output.name)
        .file("output_unit", |((_, output), _)| &output.unit)
        .file("output_value", |((_, output), place)| output.values[place])
        .file("failure", |((_, output), place)| {
            output.gaps.iter().find(|gap| gap.place == place).map(|gap| gap.reason.as_str())
        })
        .into()
}
