//! The registry of the models that a study file can name: for each table of a kind of model, how it is read, its text
//! in a new study, and its description for users.

use std::ops::Range;
use std::sync::Arc;

use apportion::model::{Expression, Input, KnownFunction, known_inputs};
use apportion::space::Space;
use apportion::study::Subject;
use apportion_afm::{AfmHistory, AfmOutput, AfmSubject};

use super::at::ListOrTable;
use super::context::{Context, Fault, unknown_name};
use super::distribution::own_inputs;
use super::error::Problem;
use super::sections::{At, StudyFile};
use super::subjects::KnownSubject;
use super::{command, constants, expression, outputs as own};
use crate::ModelKind;

/// A study file with a known model.
pub(super) struct Reading<'a> {
    pub context: &'a Context<'a>,
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
        inputs: |reading| Ok(known(reading)?.as_ref().map_or_else(Vec::new, known_inputs)),
        subject: |reading, _| {
            outputs(reading)?;
            // A test covers all kinds of this table.
            let function = known(reading)?.ok_or_else(|| reading.context.fault(0..0, Problem::no_factors()))?;
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
        inputs: |reading| own::inputs(reading.context, &reading.file.factor),
        subject: outside,
        guide: Some(include_str!("../../templates/guides/external.txt")),
    },
    ModelTable {
        name: "command",
        span: |file| file.command.as_ref().map(At::span),
        inputs: |reading| own_inputs(reading.context, &reading.file.factor),
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
    Ok((Arc::new(own::subject(context, file.outputs.as_ref())?), Vec::new()))
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
fn known(reading: &Reading<'_>) -> Result<Option<KnownFunction>, Fault> {
    let with_table = |answer| constants::known(reading.context, answer, reading.file.function.as_ref());
    reading.kind.known.map(with_table).transpose()
}

fn afm(reading: &Reading<'_>, space: &Space) -> Subjects {
    let is_factor = |name: &str| space.factors().iter().any(|factor| factor.name == name);
    // Histories come after the others in the catalogue.
    let (places, histories): (Vec<usize>, Vec<usize>) =
        outputs(reading)?.into_iter().partition(|place| *place < AfmOutput::ALL.len());
    let outputs = places.into_iter().map(|place| AfmOutput::ALL[place]).collect();
    let histories: Vec<AfmHistory> =
        histories.into_iter().map(|place| AfmHistory::ALL[place - AfmOutput::ALL.len()]).collect();
    let none = Default::default();
    let table = reading.file.afm.as_ref().map_or(&none, At::get_ref);
    let (scene, options) = constants::afm(reading.context, table, &is_factor)?;
    let moments = constants::moments(reading.context, table)?;
    let notes = constants::idle(table, &options, !histories.is_empty());
    Ok((Arc::new(AfmSubject { scene, options, outputs, histories, moments }), notes))
}

/// Returns the numbers of the outputs in the catalogue, in the requested order; by default the first one.
fn outputs(reading: &Reading<'_>) -> Result<Vec<usize>, Fault> {
    let Some(key) = &reading.file.outputs else { return Ok(vec![0]) };
    let Reading { context, kind, .. } = reading;
    let example = "outputs = [\"y\"], a list of names (a table of formulas needs model = \"expression\")";
    let asked = match key.get_ref() {
        ListOrTable::List(names) if !names.is_empty() => names,
        _ => return Err(context.fault(key.span(), Problem::missing("names of outputs", example))),
    };
    let known = kind.outputs();
    let mut places = Vec::new();
    for name in asked {
        let unknown = || unknown_name("output", name.get_ref(), known.iter().map(|output| &*output.name));
        let place = known.iter().position(|output| *output.name == **name.get_ref());
        let place = context.at(name, place.ok_or_else(unknown))?;
        if places.contains(&place) {
            let problem = Problem::Repeated { what: "output", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        places.push(place);
    }
    Ok(places)
}
