//! The distribution and the nominal value of a factor, from the keys of its `[[factor]]` table.

use apportion::space::distribution::{Kind, Parameter};
use apportion::space::{Distribution, DistributionError};

use super::at::At;
use super::context::{Context, Fault, unknown_name, wrong};
use super::error::Problem;
use super::measured::read_measured;
use super::sections::{FactorSection, Nominal, TypedKey, TypedValue};

/// Returns whether a factor's distribution is given by something else than its own parameters.
pub(super) fn is_determined(fields: &FactorSection, distribution: &Distribution) -> bool {
    let parameters = distribution.parameters();
    let mut keys = fields.keys.iter().map(|typed| typed.key.name);
    keys.any(|key| key != "truncate" && parameters.iter().all(|(name, _)| *name != key))
}

/// Returns the distribution of a factor.
pub(super) fn of_factor(context: &Context, section: &At<FactorSection>) -> Result<Distribution, Fault> {
    let fields = section.get_ref();
    let typed = fields.distribution.as_ref();
    let kind = typed.map_or(Ok(Kind::default()), |typed| context.at(typed, kind(typed.get_ref())))?;
    let mut values = Vec::with_capacity(fields.keys.len());
    for typed in &fields.keys {
        values.push((typed.key.name, parameter(context, fields, kind, typed)?));
    }
    kind.make(&values).map_err(|source| {
        let first = fields.keys.first().map(|typed| typed.span.clone());
        let span = source.key.and_then(|key| fields.place(key)).or(first).filter(|_| !source.is_incomplete);
        context.fault(span.unwrap_or(fields.name.span()), refused(fields.name.get_ref(), &source))
    })
}

/// Returns the problem of a factor with an invalid distribution.
pub(super) fn refused(factor: &str, error: &DistributionError) -> Problem {
    Problem::Refused { message: format!("factor `{factor}`: {error}"), help: error.help.clone() }
}

/// Returns the family of that name.
pub(super) fn kind(name: &str) -> Result<Kind, Problem> {
    Kind::from_name(name).ok_or_else(|| unknown_name("distribution", name, Kind::all().map(Kind::name)))
}

/// Returns the value of a key.
fn parameter(context: &Context, fields: &FactorSection, kind: Kind, typed: &TypedKey) -> Result<Parameter, Fault> {
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
                let problem = wrong("truncate", expected, format!("a list of {}", list.len()));
                return Err(context.fault(typed.span.clone(), problem));
            }
        },
        TypedValue::Quantiles(table) => {
            let mut pairs = Vec::with_capacity(table.len());
            for (key, value) in table {
                let Ok(probability) = key.get_ref().trim().parse() else {
                    let expected = "values by probabilities from 0 to 1, as in { \"0\" = 1, \"0.5\" = 2, \"1\" = 5 }";
                    return context.refuse(key, "quantiles", expected, format!("{:?}", key.get_ref()));
                };
                pairs.push((probability, *value.get_ref()));
            }
            Parameter::Quantiles(pairs)
        }
    })
}

/// Returns the value of the typed one, in the factor's unit.
pub(super) fn nominal_value(factor: &str, distribution: &Distribution, typed: &Nominal) -> Result<f64, Problem> {
    let (value, text) = match typed {
        Nominal::Number(number) => (Some(*number), number.to_string()),
        Nominal::Truth(truth) => (distribution.value_of(&truth.to_string()), truth.to_string()),
        Nominal::Label(label) => (distribution.value_of(label), format!("\"{label}\"")),
    };
    match value.filter(|value| is_value(distribution, *value)) {
        Some(value) => Ok(value),
        None => Err(Problem::with_help(
            format!("factor `{factor}`: its nominal value is {text}, which is not one of its values"),
            format!("it takes {}", values(distribution)),
        )),
    }
}

/// Returns whether whole numbers and categories have this value; true for other distributions.
pub(super) fn is_value(distribution: &Distribution, value: f64) -> bool {
    match distribution {
        Distribution::Categorical(categories) => categories.label(value).is_some(),
        distribution if distribution.is_whole() => value.fract() == 0.0,
        _ => true,
    }
}

fn values(distribution: &Distribution) -> String {
    match distribution {
        Distribution::Categorical(categories) => {
            categories.categories().map(|(label, value, _)| format!("{label} ({value})")).collect::<Vec<_>>().join(", ")
        }
        distribution if distribution.is_whole() => "whole numbers".to_owned(),
        _ => "a number".to_owned(),
    }
}
