//! Sweeps as a document.

use super::charts::sweep_charts;
use super::{SweepFile, gap_lines};
use crate::model::MANY_OUTPUTS;
use crate::report::csv::{Csv, fields};
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Mark, Part, Section, Table, Value};
use crate::report::format::{axis_unit, grouped, heading, name, short, short_with_unit, value};
use crate::report::leading::first_answers;
use crate::report::study_sections::{study_section, validity_section};
use crate::report::validity;
use crate::result::json;
use crate::sweep::{Against, NominalOutput, Sweep, SweepEffect};

/// The document of sweeps.
pub fn sweep_document(file: &SweepFile) -> Document {
    let study = &file.study.name;
    let outputs = file.nominal.len();
    let mut figures =
        Figure::numbered(sweep_charts(file), (study, file.study.headline()), &format!("{study}-sweep.csv"));
    let curves = figures.split_off(outputs);
    let of_output = |(place, (nominal, ranges)): (usize, (&NominalOutput, Figure))| {
        let parts = vec![Part::Text(at_nominal(nominal)), effects(file, nominal, place).into(), ranges.into()];
        (heading(&nominal.output, &nominal.unit), parts)
    };
    let of_outputs = file.nominal.iter().zip(figures).enumerate().map(of_output).collect();
    let mut sections = Document::sections_of_outputs(of_outputs);
    let answers = (0..outputs).map(|place| widest(file, &file.nominal[place], place));
    let mut lead = first_answers(answers.collect());
    lead.extend(validity::sentence(&file.validity));
    let curve = |(figure, sweep): (Figure, &Sweep)| match outputs {
        ..MANY_OUTPUTS => figure.into(),
        _ => Part::Details { summary: name(&sweep.factor), parts: vec![figure.into()] },
    };
    let mut parts: Vec<Part> = curves.into_iter().zip(&file.sweeps).map(curve).collect();
    let failed: Vec<String> = file.sweeps.iter().flat_map(gap_lines).map(|line| format!("{line}.")).collect();
    let warned: Vec<String> = file.warnings.iter().map(|warning| format!("{warning}.")).collect();
    for (kind, texts) in [("Failed", failed), ("Warning", warned)].into_iter().filter(|(_, texts)| !texts.is_empty()) {
        parts.insert(0, Part::Notice { mark: Mark::Mixed, kind: kind.to_owned(), texts });
    }
    sections.push(Section::new("curves", "The outputs over each factor", parts));
    sections.extend(validity_section(&file.validity));
    sections.push(study_section(&file.study, &file.study.factors));
    let rows = [
        ("program", format!("apportion {}", file.provenance.apportion_version)),
        ("model runs", grouped(file.provenance.model_runs)),
        ("study file, SHA-256", format!("`{}`", file.study.sha256)),
    ];
    let table = Table::pairs("How the answer came about.", rows);
    sections.push(Section::new("provenance", "Provenance", vec![Part::OnPage(vec![table.into()])]));
    Document {
        name: format!("{study}-sweep"),
        kicker: "One factor at a time".to_owned(),
        title: file.study.headline().to_owned(),
        lead,
        sections,
        footer: format!("Made by apportion {}.", file.provenance.apportion_version),
        files: vec![
            DataFile::new(format!("{study}-sweep.json"), json(file)),
            DataFile::new(format!("{study}-sweep.csv"), sweep_csv(file)),
        ],
        ..Document::default()
    }
}

/// Which factor moves an output most.
fn widest(file: &SweepFile, nominal: &NominalOutput, number: usize) -> String {
    let output = name(&nominal.output);
    match by_width(file, number).first() {
        Some((sweep, SweepEffect { low: Some(low), high: Some(high), .. })) if high > low => format!(
            "Over {}, with all others nominal, {} moves {output} most: between {} and {}.",
            if sweep.given { "the given values" } else { "its range" },
            name(&sweep.factor),
            value(*low, ""),
            value(*high, &nominal.unit)
        ),
        Some(_) => format!("No factor alone moves {output}, as far as it has values."),
        None => format!("No factor was swept for {output}."),
    }
}

/// The sweeps with what they do to an output, the widest first.
fn by_width(file: &SweepFile, number: usize) -> Vec<(&Sweep, &SweepEffect)> {
    let mut sweeps: Vec<(&Sweep, &SweepEffect)> =
        file.sweeps.iter().filter_map(|sweep| Some((sweep, sweep.effects.get(number)?))).collect();
    sweeps.sort_by(|a, b| b.1.width().total_cmp(&a.1.width()));
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

/// How far each factor moves an output, the widest first.
fn effects(file: &SweepFile, nominal: &NominalOutput, number: usize) -> Table {
    let said = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
    let row = |(sweep, effect): (&Sweep, &SweepEffect)| {
        let last = sweep.values.len().saturating_sub(1);
        let texts = [name(&sweep.factor), sweep.value_in_words(0), sweep.value_in_words(last)];
        let numbers = [effect.first, effect.last, effect.low, effect.high, effect.percent, effect.elasticity].map(said);
        texts.into_iter().chain(numbers).map(Cell::from).collect()
    };
    let in_unit = |what: &str| match axis_unit(&nominal.unit).as_str() {
        "" => what.to_owned(),
        unit => format!("{what} ({unit})"),
    };
    let of_output = ["output from", "to", "least", "largest"].map(in_unit);
    let mut headings = vec!["factor", "from", "to"];
    headings.extend(of_output.iter().map(String::as_str));
    headings.extend(["moves by %", "elasticity"]);
    let caption = format!(
        "How far each factor alone moves {}, all others nominal, the widest range first; the elasticity is its slope there \
         in percent per percent.",
        name(&nominal.output)
    );
    Table::new(caption, Column::list(1, &headings)).with_rows(by_width(file, number).into_iter().map(row))
}

/// The sweeps as CSV: one line per factor, curve, output and value; an empty cell where there is no number, with the
/// reason in the last column.
fn sweep_csv(file: &SweepFile) -> String {
    let names = ["factor", "unit", "value", "against", "against_unit", "against_value"];
    let of_output = ["output", "output_unit", "output_value", "failure"];
    let mut csv = Csv::new(fields(&[&names[..], &of_output[..]].concat(), &[]));
    for sweep in &file.sweeps {
        for curve in &sweep.curves {
            let against = curve.against.as_ref();
            let text = |read: fn(&Against) -> &String| against.map_or(Value::Empty, |a| read(a).into());
            let against_value = against.map_or(Value::Empty, |a| match &a.label {
                Some(label) => label.into(),
                None => a.value.into(),
            });
            for output in &curve.outputs {
                for (place, (x, y)) in sweep.values.iter().zip(&output.values).enumerate() {
                    let gap = output.gaps.iter().find(|gap| gap.place == place);
                    csv.row::<Value>([
                        (&sweep.factor).into(),
                        (&sweep.unit).into(),
                        sweep.labels.as_ref().map_or((*x).into(), |labels| (&labels[place]).into()),
                        text(|a| &a.factor),
                        text(|a| &a.unit),
                        against_value.clone(),
                        (&output.name).into(),
                        (&output.unit).into(),
                        (*y).into(),
                        gap.map_or(Value::Empty, |gap| (&gap.reason).into()),
                    ]);
                }
            }
        }
    }
    csv.text()
}
