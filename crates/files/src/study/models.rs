//! The registry of the models that a study file can name: for each table of a kind of model, how it is read, its text
//! in a new study, and its description for users.

use std::ops::Range;
use std::sync::Arc;

use apportion::model::{Expression, Input, KnownFunction};
use apportion::space::Space;
use apportion_afm::{AfmHistory, AfmOutput, AfmSubject};

use super::at::At;
use super::constants::known_function;
use super::context::{Fault, unknown_name};
use super::error::Problem;
use super::output_table::Outputs;
use super::reading::{Configured, Reading};
use super::sections::StudyFile;
use super::subjects::KnownSubject;
use super::units::factor_inputs;
use super::{command, constants, expression, outputs as external};
use crate::ModelKind;

/// A table of study files for a kind of model.
pub(super) struct ModelTable {
    /// The key.
    pub name: &'static str,
    /// Its position, if it is present.
    pub span: fn(&StudyFile) -> Option<Range<usize>>,
    /// The possible factors.
    pub inputs: fn(&Reading) -> Result<Vec<Input>, Fault>,
    /// The configured model.
    pub subject: fn(&Reading, &Space) -> Configured,
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
        inputs: |reading| Ok(known_function(reading)?.as_ref().map_or_else(Vec::new, KnownFunction::model_inputs)),
        subject: function,
        guide: None,
    },
    ModelTable {
        name: "expression",
        span: |file| file.expression.as_ref().map(At::span),
        inputs: expression::inputs,
        subject: expression::subject,
        guide: Some(include_str!("../../templates/guides/expression.txt")),
    },
    ModelTable {
        name: "external",
        span: |_| None,
        inputs: external::inputs,
        subject: outside,
        guide: Some(include_str!("../../templates/guides/external.txt")),
    },
    ModelTable {
        name: "command",
        span: |file| file.command.as_ref().map(At::span),
        inputs: factor_inputs,
        subject: program,
        guide: Some(include_str!("../../templates/guides/command.txt")),
    },
];

#[cfg(not(target_family = "wasm"))]
use {command::subject as program, external::subject as outside};

/// A page starts no programs, and does not contain the code for them.
#[cfg(target_family = "wasm")]
use program as outside;

#[cfg(target_family = "wasm")]
fn program(reading: &Reading, _: &Space) -> Configured {
    Err(reading.context.fault(0..0, command::no_program()))
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

fn function(reading: &Reading, space: &Space) -> Configured {
    outputs(reading)?;
    // A test covers all kinds of this table.
    let function = known_function(reading)?.ok_or_else(|| reading.context.fault(0..0, Problem::no_factors()))?;
    let mut notes = Vec::new();
    for factor in space.factors() {
        let Some(input) = function.inputs().iter().find(|input| input.name == factor.name) else { continue };
        let ((low, high), (from, to)) = (factor.distribution().support(), input.distribution.support());
        if low < from || high > to {
            let (name, model) = (&factor.name, function.answer.name);
            notes.push(format!("the exact indices of {model} hold for {name} from {from} to {to}, and not here"));
        }
    }
    Ok((Arc::new(KnownSubject { function }), notes))
}

fn afm(reading: &Reading, space: &Space) -> Configured {
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
    let (scene, options) = constants::afm(&reading.context, table, space)?;
    let moments = constants::moments(&reading.context, table)?;
    let notes = constants::notes(table, &options, !histories.is_empty());
    Ok((Arc::new(AfmSubject { scene, options, outputs: values, histories, moments }), notes))
}

/// Returns the numbers of the outputs in the catalogue, in the requested order; by default the first one.
fn outputs(reading: &Reading) -> Result<Vec<usize>, Fault> {
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
