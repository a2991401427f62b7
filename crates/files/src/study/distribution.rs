//! The distribution, the nominal value and the unit of a factor, from the keys of its `[[factor]]` table; and units of
//! outputs and in messages.

use apportion::model::Input;
use apportion::space::distribution::{Kind, Parameter};
use apportion::space::{Distribution, DistributionError};
use apportion_base::names::{SHORT_TEXT, is_short_text};
use apportion_base::quantity::{Domain, Unit};
use toml::Value;

use super::context::{Context, Fault, unknown_name, wrong};
use super::dependence::read_measured;
use super::error::Problem;
use super::sections::{At, FactorSection, Nominal, TypedKey, TypedValue};

/// Returns whether a factor's distribution is given by something else than its own parameters.
pub(super) fn is_determined(fields: &FactorSection, distribution: &Distribution) -> bool {
    let parameters = distribution.parameters();
    let is_own = |key: &str| key == "truncate" || parameters.iter().any(|(name, _)| *name == key);
    !fields.keys.iter().all(|typed| is_own(typed.key.name))
}

/// Returns the distribution of a factor.
pub(super) fn of_factor(context: &Context<'_>, section: &At<FactorSection>) -> Result<Distribution, Fault> {
    let fields = section.get_ref();
    let factor = fields.name.get_ref();
    let kind = kind(context, fields)?;
    let values = fields.keys.iter().map(|typed| Ok((typed.key.name, parameter(context, fields, kind, typed)?)));
    let values = values.collect::<Result<Vec<_>, Fault>>()?;
    kind.make(&values).map_err(|source| {
        let first = || fields.keys.first().map(|typed| typed.span.clone());
        let of_key = source.key.and_then(|key| fields.place(key)).or_else(first).filter(|_| !source.is_incomplete);
        context.fault(of_key.unwrap_or(fields.name.span()), refused(factor, &source))
    })
}

/// Returns the problem of a factor with an invalid distribution.
pub(super) fn refused(factor: &str, error: &DistributionError) -> Problem {
    Problem::Refused { message: format!("factor `{factor}`: {error}"), help: error.help.clone() }
}

/// Returns the family, by default the first.
fn kind(context: &Context<'_>, fields: &FactorSection) -> Result<Kind, Fault> {
    match &fields.distribution {
        None => Ok(Kind::default()),
        Some(typed) => {
            let unknown = || unknown_name("distribution", typed.get_ref(), Kind::all().map(Kind::name));
            context.at(typed, Kind::from_name(typed.get_ref()).ok_or_else(unknown))
        }
    }
}

/// Returns the value of a key.
fn parameter(context: &Context<'_>, fields: &FactorSection, kind: Kind, typed: &TypedKey) -> Result<Parameter, Fault> {
    Ok(match &typed.value {
        TypedValue::Parameter(parameter) => parameter.clone(),
        TypedValue::Text(file) if typed.key.name == "file" && kind.name() == "empirical" => {
            let column = fields.keys.iter().find_map(|other| match &other.value {
                TypedValue::Text(column) if other.key.name == "column" => Some(column),
                _ => None,
            });
            let (values, source) = read_measured(context, file, column)?;
            Parameter::Measured(values, source)
        }
        TypedValue::Text(text) => Parameter::Text(text.get_ref().clone()),
        TypedValue::Bounds(list) => match list[..] {
            [min, max] => Parameter::Bounds(min, max),
            _ => {
                let expected = "two numbers, as in truncate = [1, 5]; inf or -inf for no bound";
                let found = format!("a list of {}", list.len());
                return Err(context.fault(typed.span.clone(), wrong("truncate", expected, found)));
            }
        },
        TypedValue::Quantiles(table) => {
            let pair = |(key, value): (&At<String>, &At<f64>)| {
                let expected = "values by probabilities from 0 to 1, as in { \"0\" = 1, \"0.5\" = 2, \"1\" = 5 }";
                let refused =
                    || context.fault(key.span(), wrong("quantiles", expected, format!("{:?}", key.get_ref())));
                let probability: f64 = key.get_ref().trim().parse().map_err(|_| refused())?;
                Ok((probability, *value.get_ref()))
            };
            Parameter::Quantiles(table.iter().map(pair).collect::<Result<_, Fault>>()?)
        }
    })
}

/// Returns the value of the typed one, in the factor's unit.
pub(super) fn nominal_value(factor: &str, distribution: &Distribution, typed: &Nominal) -> Result<f64, Problem> {
    let (value, found) = match typed {
        Nominal::Number(number) => (Some(*number), number.to_string()),
        Nominal::Truth(truth) => (distribution.value_of(&truth.to_string()), truth.to_string()),
        Nominal::Label(label) => (distribution.value_of(label), format!("\"{label}\"")),
    };
    match value.filter(|value| is_value(distribution, *value)) {
        Some(value) => Ok(value),
        None => Err(Problem::with_help(
            format!("factor `{factor}`: its nominal value is {found}, which is not one of its values"),
            format!("it takes {}", values(distribution)),
        )),
    }
}

/// Returns whether whole numbers and categories have this value; true for other distributions.
pub(super) fn is_value(distribution: &Distribution, value: f64) -> bool {
    match distribution {
        Distribution::Categorical(categories) => categories.label(value).is_some(),
        whole if whole.is_whole() => value.fract() == 0.0,
        _ => true,
    }
}

fn values(distribution: &Distribution) -> String {
    match distribution {
        Distribution::Categorical(categories) => {
            categories.categories().map(|(label, value, _)| format!("{label} ({value})")).collect::<Vec<_>>().join(", ")
        }
        whole if whole.is_whole() => "whole numbers".to_owned(),
        _ => "a number".to_owned(),
    }
}

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
