//! Units in a study file: of factors, of outputs, and in messages.

use toml::Value;

use super::context::{Context, Fault, wrong};
use super::error::Problem;
use super::sections::{At, FactorSection};
use crate::model::Input;
use crate::quantity::{Domain, Unit};

/// The inputs of a model that has no others than the factors of the study, each in its own unit.
pub(super) fn own_inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    let input = |section: &At<FactorSection>| {
        let fields = section.get_ref();
        let unit = match &fields.unit {
            None => Unit::dimensionless(),
            Some(typed) => Unit::parse(typed.get_ref()).map_err(|error| context.fault(typed.span(), error.into()))?,
        };
        let (name, symbol) = (fields.name.get_ref().clone(), fields.name.get_ref().clone());
        // Not a number: the study alone has a nominal value.
        let (nominal, description) = (f64::NAN, "a factor of the study".to_owned());
        Ok(Input { name, symbol, unit, nominal, domain: None, distribution: None, description })
    };
    factors.iter().map(input).collect()
}

/// `name` is in a unit of another kind than `expected`, or in none.
pub(super) fn wrong_unit(name: &str, expected: &Unit, unit: Option<&Unit>, example: &str) -> Problem {
    let dimension = expected.dimension();
    let message = match unit {
        None => format!("{name} is {dimension} and needs a unit"),
        Some(unit) => format!("{name} is {dimension}, but `{unit}` measures {}", unit.dimension()),
    };
    Problem::with_help(message, format!("write {example}"))
}

/// The unit of a factor, which is of the kind that the model asks for.
pub(super) fn unit_of_factor(context: &Context<'_>, fields: &FactorSection, input: &Input) -> Result<Unit, Fault> {
    let (name, example) = (format!("factor `{}`", input.name), format!("unit = \"{}\"", input.unit));
    let Some(typed) = &fields.unit else {
        if input.unit.compatible(&Unit::dimensionless()) {
            return Ok(Unit::dimensionless());
        }
        return Err(context.fault(fields.name.span(), wrong_unit(&name, &input.unit, None, &example)));
    };
    let unit = Unit::parse(typed.get_ref()).map_err(|error| context.fault(typed.span(), error.into()))?;
    if !unit.compatible(&input.unit) {
        return Err(context.fault(typed.span(), wrong_unit(&name, &input.unit, Some(&unit), &example)));
    }
    Ok(unit)
}

/// The input's own distribution is in the input's own unit.
pub(super) fn refuse_unit_of_own(
    context: &Context<'_>,
    fields: &FactorSection,
    unit: &Unit,
    input: &Input,
) -> Result<(), Fault> {
    match &fields.unit {
        Some(typed) if [0.0, 1.0].iter().any(|&x| unit.to_si(x) != input.unit.to_si(x)) => {
            let (factor, unit) = (&input.name, typed.get_ref());
            let problem =
                format!("factor `{factor}` has the function's own distribution here, which is not in `{unit}`");
            let help = "remove the unit, or give the distribution too";
            Err(context.fault(typed.span(), Problem::with_help(problem, help)))
        }
        _ => Ok(()),
    }
}

/// The unit of an output of a program, which stands as `text` in `value`: one that is known, or any other short text.
pub(super) fn output_unit(context: &Context<'_>, value: &At<Value>, text: &str) -> Result<Unit, Fault> {
    const LONGEST: usize = 60;
    // Marks of the direction of writing would reorder the text beside them.
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if text.chars().count() > LONGEST || text.contains(|c: char| c.is_control() || turns(c)) {
        let expected = format!("a text of up to {LONGEST} characters, without control characters");
        return Err(context.fault(value.span(), wrong("unit", &expected, format!("{text:?}"))));
    }
    Ok(Unit::label(text))
}

/// A domain for people who may be thinking in degrees.
pub(super) fn in_words_of_units(domain: Domain) -> String {
    if domain == Domain::AcuteAngle { "in [0, 90 deg]".to_owned() } else { domain.to_string() }
}

/// `value` as typed, with its unit if it has one.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    if matches!(unit, "" | "1") { value.to_string() } else { format!("{value} {unit}") }
}
