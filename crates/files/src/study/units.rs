//! Units in a study file: of factors, of outputs, and in messages.

use apportion::model::Input;
use apportion::names::{SHORT_TEXT, is_short_text};
use apportion::quantity::{Domain, Unit};
use toml::Value;

use super::context::{Context, Fault};
use super::error::Problem;
use super::sections::{At, FactorSection};

/// Returns the inputs of a model whose only inputs are the factors of the study, each in its own unit.
pub(super) fn own_inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    let input = |section: &At<FactorSection>| {
        let fields = section.get_ref();
        let parse = |typed: &At<String>| context.at(typed, Unit::parse(typed.get_ref()));
        let unit = fields.unit.as_ref().map_or(Ok(Unit::dimensionless()), parse)?;
        let (name, symbol) = (fields.name.get_ref().clone(), fields.name.get_ref().clone());
        // Not a number: only the study has a nominal value.
        let (nominal, description) = (f64::NAN, "a factor of the study".to_owned());
        Ok(Input { name, symbol, unit, nominal, domain: None, distribution: None, description })
    };
    factors.iter().map(input).collect()
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

/// Returns the unit of a factor, which must be of the kind that the model requires.
pub(super) fn unit_of_factor(context: &Context<'_>, fields: &FactorSection, input: &Input) -> Result<Unit, Fault> {
    let (name, example) = (format!("factor `{}`", input.name), format!("unit = \"{}\"", input.unit));
    let Some(typed) = &fields.unit else {
        if input.unit.compatible(&Unit::dimensionless()) {
            return Ok(Unit::dimensionless());
        }
        return Err(context.fault(fields.name.span(), wrong_unit(&name, &input.unit, None, &example)));
    };
    let unit = context.at(typed, Unit::parse(typed.get_ref()))?;
    if !unit.compatible(&input.unit) {
        return Err(context.fault(typed.span(), wrong_unit(&name, &input.unit, Some(&unit), &example)));
    }
    Ok(unit)
}

/// Refuses a unit for the input's own distribution, which is in the input's own unit.
pub(super) fn refuse_unit_of_own(
    context: &Context<'_>,
    fields: &FactorSection,
    unit: &Unit,
    input: &Input,
) -> Result<(), Fault> {
    match &fields.unit {
        Some(typed) if [0.0, 1.0].iter().any(|&x| unit.to_si(x) != input.unit.to_si(x)) => {
            let (factor, unit) = (&input.name, typed.get_ref());
            let problem = format!("factor `{factor}` has the function's own distribution, which is not in `{unit}`");
            let help = "remove the unit, or give a distribution";
            Err(context.fault(typed.span(), Problem::with_help(problem, help)))
        }
        _ => Ok(()),
    }
}

/// Parses the unit of a program's output, written as `text` in `value`: a known one, or any other short text.
pub(super) fn output_unit(context: &Context<'_>, value: &At<Value>, text: &str) -> Result<Unit, Fault> {
    match is_short_text(text) {
        true => Ok(Unit::label(text)),
        false => context.refuse(value, "unit", SHORT_TEXT, format!("{text:?}")),
    }
}

/// Describes a domain of angles, also in degrees.
pub(super) fn in_words_of_units(domain: Domain) -> String {
    if domain == Domain::AcuteAngle { "in [0, 90 deg]".to_owned() } else { domain.to_string() }
}

/// Formats `value` as typed, with its unit if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") { value.to_string() } else { format!("{value} {unit}") }
}
