//! `nominal`: the value of a factor when it does not vary.

use apportion::space::Distribution;

use super::error::Problem;
use super::sections::Nominal;

/// Returns the value of the typed one, in the factor's unit.
pub(super) fn value(factor: &str, distribution: &Distribution, typed: &Nominal) -> Result<f64, Problem> {
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
