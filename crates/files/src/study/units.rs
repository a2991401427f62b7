//! Quantities and units in studies and messages, and the inputs of a model whose inputs are the factors of a study.

use apportion::model::Input;
use apportion_base::names::{SHORT_TEXT, is_short_text};
use apportion_base::quantity::{Dimension, Domain, Quantity, Unit};

use super::at::At;
use super::context::{Context, Fault};
use super::error::Problem;
use super::reading::Reading;

/// Returns the inputs of a model whose only inputs are the factors of the study, each in its own unit, which may be any text.
pub(super) fn factor_inputs(reading: &Reading) -> Result<Vec<Input>, Fault> {
    let mut inputs = Vec::new();
    for fields in reading.file.factor.iter().map(At::get_ref) {
        let unit = match &fields.unit {
            Some(typed) if is_short_text(typed.get_ref()) => Unit::label(typed.get_ref()),
            Some(typed) => {
                return reading.context.refuse(typed, "unit", SHORT_TEXT, format!("{:?}", typed.get_ref()));
            }
            None => Unit::dimensionless(),
        };
        let (name, symbol) = (fields.name.get_ref().clone(), fields.name.get_ref().clone());
        // Not a number: only the study has a nominal value.
        let (nominal, description) = (f64::NAN, "a factor of the study".to_owned());
        inputs.push(Input { name, symbol, unit, nominal, domain: None, distribution: None, description });
    }
    Ok(inputs)
}

/// Returns the problem of `name` with a unit of another kind than `expected`, or with none.
pub(super) fn wrong_unit(name: &str, expected: &Unit, unit: Option<&Unit>, example: &str) -> Problem {
    let dimension = expected.dimension();
    let message = match unit {
        None => format!("{name} is {dimension} and needs a unit"),
        Some(unit) => format!("{name} is {dimension}, but `{unit}` measures {}", unit.dimension()),
    };
    Problem::with_help(message, format!("write {example}"))
}

/// Describes a domain of angles, also in degrees.
pub(super) fn in_words_of_units(domain: Domain) -> String {
    if domain == Domain::AcuteAngle { "in [0, 90 deg]".to_owned() } else { domain.to_string() }
}

/// Formats `value` as typed, with its unit if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") { value.to_string() } else { format!("{value} {unit}") }
}

/// Parses a time above 0, in seconds.
pub(super) fn seconds(context: &Context, key: &str, typed: &At<String>) -> Result<f64, Fault> {
    let quantity = context.at(typed, Quantity::parse(typed.get_ref()))?;
    let seconds = quantity.to_si();
    if quantity.unit.dimension() != Dimension::TIME || !(seconds > 0.0 && seconds.is_finite()) {
        return context.refuse(typed, key, "a time above 0, as in \"30 s\"", format!("\"{}\"", typed.get_ref()));
    }
    Ok(seconds)
}
