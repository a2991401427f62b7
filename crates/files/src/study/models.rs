//! The registry of the models that a study file can name: for each table of a kind of model, how it is read, its text
//! in a new study, and its description for users.

use std::ops::Range;
use std::sync::Arc;

use apportion::model::{Expression, Input, KnownFunction, known_inputs};
use apportion::space::Space;
use apportion::study::Subject;
use apportion_afm::{AfmHistory, AfmOutput, AfmSubject};

use super::at::At;
use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::output_table::Outputs;
use super::sections::StudyFile;
use super::subjects::KnownSubject;
use super::units::factor_inputs;
use super::{command, constants, expression, outputs as external};
use crate::ModelKind;

/// A study file and the kind of its model.
pub(super) struct Reading<'a> {
    pub context: &'a Context,
    pub file: &'a StudyFile,
    pub kind: ModelKind,
}

/// A subject, and notes on what has no effect.
type Subjects = Result<(Arc<dyn Subject>, Vec<String>), Fault>;

/// A table of study files for a kind of model.
pub(super) struct ModelTable {
    /// The key.
    pub name: &'static str,
    /// Its position, if it is present.
    pub span: fn(&StudyFile) -> Option<Range<usize>>,
    /// The possible factors.
    pub inputs: fn(&Reading<'_>) -> Result<Vec<Input>, Fault>,
    /// The configured model.
    pub subject: fn(&Reading<'_>, &Space) -> Subjects,
    guide: Option<&'static str>,
}

/// Every table.
pub(super) const TABLES: [ModelTable; 5] = [
    ModelTable {
        name: "afm",
        span: |file| file.afm.as_ref().map(At::span),
        inputs: |reading| Ok(reading.kind.inputs()),
        subject: afm,
        guide: None,
    },
    ModelTable {
        name: "function",
        span: |file| file.function.as_ref().map(At::span),
        inputs: |reading| Ok(known_function(reading)?.as_ref().map_or_else(Vec::new, known_inputs)),
        subject: |reading, _| {
            outputs(reading)?;
            // A test covers all kinds of this table.
            let function =
                known_function(reading)?.ok_or_else(|| reading.context.fault(0..0, Problem::no_factors()))?;
            Ok((Arc::new(KnownSubject { function }), Vec::new()))
        },
        guide: None,
    },
    ModelTable {
        name: "expression",
        span: |file| file.expression.as_ref().map(At::span),
        inputs: |reading| expression::inputs(reading.context, &reading.file.factor),
        subject: |Reading { context, file, .. }, space| {
            let (subject, notes) =
                expression::subject(context, file.outputs.as_ref(), file.expression.as_ref(), space)?;
            Ok((Arc::new(subject), notes))
        },
        guide: Some(include_str!("../../templates/guides/expression.txt")),
    },
    ModelTable {
        name: "external",
        span: |_| None,
        inputs: |reading| external::inputs(reading.context, &reading.file.factor),
        subject: outside,
        guide: Some(include_str!("../../templates/guides/external.txt")),
    },
    ModelTable {
        name: "command",
        span: |file| file.command.as_ref().map(At::span),
        inputs: |reading| factor_inputs(reading.context, &reading.file.factor),
        subject: program,
        guide: Some(include_str!("../../templates/guides/command.txt")),
    },
];

#[cfg(not(target_family = "wasm"))]
fn program(Reading { context, file, .. }: &Reading<'_>, space: &Space) -> Subjects {
    let (subject, notes) = command::subject(context, file.command.as_ref(), file.outputs.as_ref(), space)?;
    Ok((Arc::new(subject), notes))
}

#[cfg(not(target_family = "wasm"))]
fn outside(Reading { context, file, .. }: &Reading<'_>, _: &Space) -> Subjects {
    Ok((Arc::new(external::subject(context, file.outputs.as_ref())?), Vec::new()))
}

/// A page starts no programs, and does not contain the code for them.
#[cfg(target_family = "wasm")]
use program as outside;

#[cfg(target_family = "wasm")]
fn program(Reading { context, .. }: &Reading<'_>, _: &Space) -> Subjects {
    Err(context.fault(0..0, command::no_program()))
}

/// Returns the table of a kind of model.
pub(super) fn table_of(kind: ModelKind) -> &'static ModelTable {
    // A test covers all kinds.
    TABLES.iter().find(|table| table.name == kind.table).unwrap_or(&TABLES[0])
}

/// Describes the keys of a study of this kind of model; `None` if its inputs and outputs are enough.
pub fn model_guide(kind: ModelKind) -> Option<String> {
    let text = table_of(kind).guide?.replace("FUNCTIONS", &Expression::vocabulary().join(", "));
    Some(format!("{}: {}\n\n{text}", kind.name, kind.description))
}

/// Returns the function with the parameters of its table.
fn known_function(reading: &Reading<'_>) -> Result<Option<KnownFunction>, Fault> {
    let Some(answer) = reading.kind.known else { return Ok(None) };
    constants::known_function(reading.context, answer, reading.file.function.as_ref()).map(Some)
}

fn afm(reading: &Reading<'_>, space: &Space) -> Subjects {
    let (mut values, mut histories) = (Vec::new(), Vec::new());
    for place in outputs(reading)? {
        // Histories come after the others in the catalogue.
        match AfmOutput::ALL.get(place) {
            Some(output) => values.push(*output),
            None => histories.push(AfmHistory::ALL[place - AfmOutput::ALL.len()]),
        }
    }
    let none = Default::default();
    let table = reading.file.afm.as_ref().map_or(&none, At::get_ref);
    let (scene, options) = constants::afm(reading.context, table, space)?;
    let moments = constants::moments(reading.context, table)?;
    let notes = constants::notes(table, &options, !histories.is_empty());
    Ok((Arc::new(AfmSubject { scene, options, outputs: values, histories, moments }), notes))
}

/// Returns the numbers of the outputs in the catalogue, in the requested order; by default the first one.
fn outputs(reading: &Reading<'_>) -> Result<Vec<usize>, Fault> {
    let Some(key) = &reading.file.outputs else { return Ok(vec![0]) };
    let Reading { context, kind, .. } = reading;
    let example = "outputs = [\"y\"], a list of names (a table of formulas needs model = \"expression\")";
    let names = match key.get_ref() {
        Outputs::Names(names) if !names.is_empty() => names,
        _ => return Err(context.fault(key.span(), Problem::missing("names of outputs", example))),
    };
    let outputs = kind.outputs();
    let mut places = Vec::new();
    for name in names {
        let valid = outputs.iter().map(|output| &*output.name);
        let place = valid.clone().position(|output| output == name.get_ref());
        let place = context.at(name, place.ok_or_else(|| unknown_name("output", name.get_ref(), valid)))?;
        if places.contains(&place) {
            let problem = Problem::Repeated { what: "output", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        places.push(place);
    }
    Ok(places)
}
