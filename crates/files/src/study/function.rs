//! The `[function]` table: parameters of a function with known indices.

use apportion::model::{KnownAnswer, KnownFunction, ParameterError, ParameterValue};
use toml::Value;

use super::context::{Context, Fault, number, shown, wrong};
use super::error::Problem;
use super::sections::{At, Choices};

/// Returns the function with the parameters of the table.
pub(super) fn known(
    context: &Context<'_>,
    answer: &'static KnownAnswer,
    table: Option<&At<Choices>>,
) -> Result<KnownFunction, Fault> {
    let Some(table) = table else { return Ok(answer.default_function()) };
    let mut parameters = Vec::new();
    for (key, value) in table.get_ref() {
        let name = key.get_ref();
        if answer.parameters.iter().all(|parameter| parameter.name != name) {
            return Err(context.fault(key.span(), unknown_key(answer, name)));
        }
        let found = || wrong(name, "a number or a list of numbers", shown(value.get_ref()));
        parameters.push((name.clone(), context.at(value, number_or_list(value.get_ref()).ok_or_else(found))?));
    }
    answer.with(&parameters).map_err(|error| {
        let about = |key: &At<String>| *key.get_ref() == error.parameter;
        let span = table.get_ref().iter().find(|(key, _)| about(key)).map_or(table.span(), |(_, value)| value.span());
        context.fault(span, Problem::new(error.to_string()))
    })
}

fn unknown_key(answer: &'static KnownAnswer, name: &str) -> Problem {
    if answer.parameters.is_empty() {
        return Problem::new(ParameterError::unknown(name).to_string());
    }
    super::context::unknown_key(name, answer.parameters.iter().map(|parameter| parameter.name))
}

fn number_or_list(value: &Value) -> Option<ParameterValue> {
    match value {
        Value::Array(list) => list.iter().map(number).collect::<Option<_>>().map(ParameterValue::List),
        other => number(other).map(ParameterValue::Number),
    }
}
