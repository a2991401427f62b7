//! The `[external]` table: the outputs of a model that runs outside of this program.

use toml::Value;

use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::sections::{At, ExternalSection, FactorSection};
use super::subjects::ExternalSubject;
use super::units::{output_unit, own_inputs};
use crate::model::{Input, Output};
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
    let stated = entries.into_iter().map(|(name, unit)| output(context, name, unit)).collect::<Result<Vec<_>, _>>()?;
    let Some(asked) = asked else {
        let none = || context.fault(table.map_or(0..0, At::span), Problem::NoExternalOutputs);
        return if stated.is_empty() { Err(none()) } else { Ok(ExternalSubject { outputs: stated }) };
    };
    if asked.get_ref().is_empty() {
        return Err(context.fault(asked.span(), Problem::NoOutputs));
    }
    let mut outputs: Vec<Output> = Vec::new();
    for name in asked.get_ref() {
        let output = match stated.iter().find(|output| output.name == *name.get_ref()) {
            Some(output) => output.clone(),
            None if stated.is_empty() => external_output(name.get_ref(), Unit::dimensionless()),
            None => {
                let known = stated.iter().map(|output| &*output.name);
                return Err(context.fault(name.span(), unknown_name("output", name.get_ref(), known)));
            }
        };
        if outputs.contains(&output) {
            let problem = Problem::Repeated { what: "output", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        outputs.push(output);
    }
    Ok(ExternalSubject { outputs })
}

fn output(context: &Context<'_>, name: &At<String>, unit: &At<Value>) -> Result<Output, Fault> {
    let Value::String(text) = unit.get_ref() else {
        let (key, found) = (name.get_ref().clone(), unit.get_ref().to_string());
        let expected = "the output's unit as text, as in \"nN\", or \"1\" for none".to_owned();
        return Err(context.fault(unit.span(), Problem::WrongType { key, expected, found }));
    };
    Ok(external_output(name.get_ref(), output_unit(context, unit, text)?))
}

fn external_output(name: &str, unit: Unit) -> Output {
    Output::new(name.to_owned(), unit, "computed outside of this program")
}
