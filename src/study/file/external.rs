//! The `[external]` table: the outputs of a model that runs outside of this program.

use toml::Value;

use super::context::{Context, Fault, wrong};
use super::error::Problem;
use super::sections::{At, ExternalSection, FactorSection};
use super::series::{SERIES_KEYS, axis, places, refuse_repeated};
use super::subjects::ExternalSubject;
use super::units::{output_unit, own_inputs};
use crate::model::{Input, Output, OutputSeries};
use crate::names::nearest;
use crate::quantity::Unit;

/// The inputs of the model: the factors of the study, each in its own unit.
pub(super) fn inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    for section in factors {
        let name = &section.get_ref().name;
        if name.get_ref().trim() != name.get_ref() || name.get_ref().is_empty() {
            let (key, found) = ("name of a factor".to_owned(), format!("{:?}", name.get_ref()));
            let expected = "a text without spaces around it (it is the header of a column)".to_owned();
            return Err(context.fault(name.span(), Problem::WrongType { key, expected, found }));
        }
    }
    own_inputs(context, factors)
}

/// The outputs that the table says, those of them that are asked for; without a table those asked for, without units.
pub(super) fn subject(
    context: &Context<'_>,
    table: Option<&At<ExternalSection>>,
    asked: Option<&At<Vec<At<String>>>>,
) -> Result<ExternalSubject, Fault> {
    let mut entries: Vec<(&At<String>, &At<Value>)> = table.iter().flat_map(|t| &t.get_ref().outputs).collect();
    // In the order of the file.
    entries.sort_by_key(|(name, _)| name.span().start);
    let mut stated = ExternalSubject { outputs: Vec::new(), series: Vec::new() };
    for (name, value) in entries {
        add_output(context, name, value, &mut stated)?;
    }
    let Some(asked) = asked else {
        let none = || context.fault(table.map_or(0..0, At::span), Problem::NoExternalOutputs);
        return if stated.outputs.is_empty() { Err(none()) } else { Ok(stated) };
    };
    let names: Vec<&str> = match &stated.outputs[..] {
        [] => asked.get_ref().iter().map(|name| name.get_ref().as_str()).collect(),
        outputs => outputs.iter().map(|output| &*output.name).collect(),
    };
    let places = places(context, &names, &stated.series, asked)?;
    let output = |&place: &usize| match stated.outputs.get(place) {
        Some(output) => output.clone(),
        None => external_output(names[place], Unit::dimensionless()),
    };
    let outputs = places.iter().map(output).collect();
    Ok(ExternalSubject { outputs, series: OutputSeries::chosen(&stated.series, &places) })
}

fn add_output(
    context: &Context<'_>,
    name: &At<String>,
    value: &At<Value>,
    to: &mut ExternalSubject,
) -> Result<(), Fault> {
    let wrong = |expected: &str, found: String| {
        context.fault(value.span(), wrong(&format!("outputs.{}", name.get_ref()), expected, found))
    };
    let (unit, axis) = match value.get_ref() {
        Value::String(unit) => (unit.as_str(), None),
        Value::Table(table) => {
            let known = || SERIES_KEYS.into_iter().chain(["unit"]);
            if let Some(unknown) = table.keys().find(|key| !known().any(|known| known == key.as_str())) {
                let expected = known().map(str::to_owned).collect();
                let problem =
                    Problem::UnknownKey { name: unknown.clone(), nearest: nearest(unknown, known()), expected };
                return Err(context.fault(value.span(), problem));
            }
            let key = format!("outputs.{}", name.get_ref());
            let axis = axis(&key, table).map_err(|problem| context.fault(value.span(), problem))?;
            match table.get("unit") {
                None => ("", axis),
                Some(Value::String(unit)) => (unit.as_str(), axis),
                Some(other) => return Err(wrong("a table whose `unit` is a text", other.to_string())),
            }
        }
        other => {
            let expected = "the output's unit as text, as in \"nN\", or \"1\" for none, or a table such as \
                            { length = 365, axis = \"day\" }";
            return Err(wrong(expected, other.to_string()));
        }
    };
    let unit = output_unit(context, value, unit)?;
    match axis {
        None => to.outputs.push(external_output(name.get_ref(), unit)),
        Some(axis) => {
            let series = OutputSeries { name: name.get_ref().clone(), first: to.outputs.len(), axis };
            to.outputs.extend(series.outputs(&unit, OUTSIDE));
            to.series.push(series);
        }
    }
    if to.series.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = to.outputs.iter().map(|output| &*output.name).collect();
    refuse_repeated(&names, &to.series).map_err(|problem| context.fault(name.span(), problem))
}

/// What such outputs are.
const OUTSIDE: &str = "computed outside of this program";

fn external_output(name: &str, unit: Unit) -> Output {
    Output::new(name.to_owned(), unit, OUTSIDE)
}
