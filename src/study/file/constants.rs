//! The `[afm]` table: choices by name, and constants of the scene with their units.

use std::collections::BTreeMap;

use toml::Value;

use super::context::{Context, Fault};
use super::error::Problem;
use super::key_schemas::CHOICES;
use super::sections::At;
use super::units::{in_words_of_units, with_unit};
use crate::afm::{ContactTheory, Fidelity, FrictionLaw, LuGreParameters, Options, Parameter, Scene, Torsion};
use crate::model::{AfmMoments, MOST_VALUES, edge_unit};
use crate::names::nearest;
use crate::quantity::{Dimension, Quantity, Unit};

/// Reads the table into a scene and options, starting from the defaults. `is_factor` tells the names that must not be
/// fixed.
pub(super) fn afm(
    context: &Context<'_>,
    table: &BTreeMap<At<String>, At<Value>>,
    is_factor: &dyn Fn(&str) -> bool,
) -> Result<(Scene, Options), Fault> {
    let (mut scene, mut options) = (Scene::default(), Options::default());
    for (key, value) in table {
        let name = key.get_ref().as_str();
        let fault = |problem| context.fault(value.span(), problem);
        match name {
            "friction" => options.friction = choice(value, name, FrictionLaw::ALL, FrictionLaw::name).map_err(fault)?,
            "contact" => {
                options.contact = choice(value, name, ContactTheory::ALL, ContactTheory::name).map_err(fault)?
            }
            "fidelity" => options.fidelity = choice(value, name, Fidelity::ALL, Fidelity::name).map_err(fault)?,
            "torsion" => options.torsion = choice(value, name, Torsion::ALL, Torsion::name).map_err(fault)?,
            "lugre_parameters" => {
                options.lugre = choice(value, name, LuGreParameters::ALL, LuGreParameters::name).map_err(fault)?;
            }
            "tolerance" => options.tolerance = positive(name, "1e-6", value.get_ref()).map_err(fault)?,
            "step" => options.step = positive(name, "\"10 ms\"", value.get_ref()).map_err(fault)?,
            "step_budget" => {
                let budget = value.get_ref().as_integer().and_then(|steps| u64::try_from(steps).ok());
                let budget = budget.filter(|&steps| steps > 0);
                options.step_budget = budget.ok_or_else(|| fault(wrong_type(name, "a whole number from 1", value)))?;
            }
            "adhesion_in_load" => {
                options.adhesion_in_load =
                    value.get_ref().as_bool().ok_or_else(|| fault(wrong_type(name, "true or false", value)))?;
            }
            // See `moments`.
            "history" => (),
            _ => {
                let Some(parameter) = Parameter::from_name(name) else {
                    return Err(context.fault(key.span(), unknown_key(name)));
                };
                if is_factor(name) {
                    return Err(context.fault(key.span(), Problem::FixedFactor(name.to_owned())));
                }
                (parameter.set)(&mut scene, constant(parameter, value).map_err(fault)?);
            }
        }
    }
    Ok((scene, options))
}

/// Seconds of a history, and moments in them, where nothing is said: those of the papers' scene in time.
const DURATION: f64 = 0.4;
const POINTS: usize = 40;

/// The moments of the outputs that are histories, by the key `history`.
pub(super) fn moments(context: &Context<'_>, table: &BTreeMap<At<String>, At<Value>>) -> Result<AfmMoments, Fault> {
    let entry = table.iter().find(|(key, _)| key.get_ref() == "history").map(|(_, value)| value);
    let (mut duration, mut points) = (DURATION, POINTS);
    let fault = |problem| context.fault(entry.map_or(0..0, At::span), problem);
    if let Some(value) = entry {
        let example = "a table such as { duration = \"0.4 s\", points = 40 }";
        let known = ["duration", "points"];
        for (key, value_of) in value.get_ref().as_table().ok_or_else(|| fault(wrong_type("history", example, value)))? {
            match key.as_str() {
                "duration" => duration = positive("history.duration", "\"0.4 s\"", value_of).map_err(fault)?,
                "points" => {
                    let number = value_of.as_integer().and_then(|points| usize::try_from(points).ok());
                    let wrong = || Problem::WrongType {
                        key: "history.points".to_owned(),
                        expected: "a whole number from 2 to 10000".to_owned(),
                        found: value_of.to_string(),
                    };
                    points =
                        number.filter(|points| (2..=MOST_VALUES).contains(points)).ok_or_else(|| fault(wrong()))?;
                }
                other => {
                    let expected = known.map(str::to_owned).to_vec();
                    let problem =
                        Problem::UnknownKey { name: other.to_owned(), nearest: nearest(other, known), expected };
                    return Err(fault(problem));
                }
            }
        }
    }
    AfmMoments::new(duration, points).map_err(|error| fault(Problem::Syntax(format!("`history`: {error}"))))
}

/// Notes on keys of the table that are understood but cannot act under `options`.
pub(super) fn idle(table: &BTreeMap<At<String>, At<Value>>, options: &Options, has_histories: bool) -> Vec<String> {
    let marched = !matches!(options.fidelity, Fidelity::ClosedForm);
    let acts = |name: &str| match name {
        "step" => options.fidelity == Fidelity::FixedStep,
        "tolerance" => marched && options.fidelity != Fidelity::FixedStep,
        "step_budget" => marched,
        "lugre_parameters" => marched && options.friction == FrictionLaw::LuGre,
        _ => true,
    };
    let (friction, fidelity) = (options.friction.name(), options.fidelity.name());
    let idle = table.keys().map(|key| key.get_ref().as_str()).filter(|name| !acts(name));
    let notes =
        idle.map(|name| format!("`{name}` has no effect with friction = \"{friction}\" and fidelity = \"{fidelity}\""));
    let without = !has_histories && table.keys().any(|key| key.get_ref() == "history");
    let of_history =
        without.then(|| "`history` has no effect without an output that is one, such as force_history".to_owned());
    notes.chain(of_history).collect()
}

fn unknown_key(name: &str) -> Problem {
    let expected: Vec<&str> = CHOICES.into_iter().chain(Parameter::ALL.iter().map(|p| p.name)).collect();
    Problem::UnknownKey {
        name: name.to_owned(),
        nearest: nearest(name, expected.iter().copied()),
        expected: expected.into_iter().map(str::to_owned).collect(),
    }
}

fn choice<T: Copy>(value: &At<Value>, key: &str, all: &[T], name: fn(T) -> &'static str) -> Result<T, Problem> {
    let names = || all.iter().map(|&variant| name(variant));
    let Some(text) = value.get_ref().as_str() else {
        let expected = format!("one of {}", names().map(|n| format!("{n:?}")).collect::<Vec<_>>().join(", "));
        return Err(wrong_type(key, &expected, value));
    };
    all.iter().copied().find(|&variant| name(variant) == text).ok_or_else(|| Problem::UnknownName {
        what: match key {
            "friction" => "friction law",
            "contact" => "contact theory",
            "fidelity" => "fidelity",
            "torsion" => "torsion formula",
            _ => "source of LuGre parameters",
        },
        name: text.to_owned(),
        nearest: nearest(text, names()),
        expected: names().map(str::to_owned).collect(),
    })
}

/// The SI value of a constant given as `"0.7 deg"`, or as a bare number where the parameter has no dimension.
fn constant(parameter: &Parameter, value: &At<Value>) -> Result<f64, Problem> {
    let unit = edge_unit(parameter);
    let dimensionless = unit.compatible(&Unit::dimensionless());
    let example = || match dimensionless {
        true => format!("{} = {}", parameter.name, (parameter.get)(&Scene::default())),
        false => format!("{} = \"{} {unit}\"", parameter.name, unit.from_si((parameter.get)(&Scene::default()))),
    };
    let quantity = match value.get_ref() {
        Value::String(text) => Quantity::parse(text)?,
        Value::Integer(number) => Quantity { value: *number as f64, unit: Unit::dimensionless() },
        Value::Float(number) => Quantity { value: *number, unit: Unit::dimensionless() },
        _ => return Err(wrong_type(parameter.name, &format!("a quantity, as in {}", example()), value)),
    };
    if !quantity.unit.compatible(&unit) {
        let name = format!("`{}`", parameter.name);
        let dimension = unit.dimension().to_string();
        return Err(if quantity.unit.compatible(&Unit::dimensionless()) {
            Problem::MissingUnit { name, dimension, example: example() }
        } else {
            let found = quantity.unit.dimension().to_string();
            Problem::WrongUnit { name, expected: dimension, unit: quantity.unit.to_string(), found, example: example() }
        });
    }
    let si = quantity.unit.to_si(quantity.value);
    if !parameter.domain.contains(si) || !unit.from_si(si).is_finite() {
        return Err(Problem::OutOfDomain {
            name: format!("`{}`", parameter.name),
            domain: in_words_of_units(parameter.domain),
            found: format!("it is {}", with_unit(quantity.value, quantity.unit.symbol())),
        });
    }
    Ok(si)
}

/// A number greater than 0: bare where it has no dimension, as `example` shows, or a time with its unit.
fn positive(key: &str, example: &str, value: &Value) -> Result<f64, Problem> {
    let is_time = example.starts_with('"');
    let number = match value {
        Value::String(text) if is_time => {
            let quantity = Quantity::parse(text)?;
            (quantity.unit.dimension() == Dimension::TIME).then(|| quantity.to_si())
        }
        Value::Integer(number) if !is_time => Some(*number as f64),
        Value::Float(number) if !is_time => Some(*number),
        _ => None,
    };
    let expected = || format!("greater than 0, as in {key} = {example}");
    number.filter(|number| *number > 0.0 && number.is_finite()).ok_or_else(|| Problem::WrongType {
        key: key.to_owned(),
        expected: expected(),
        found: value.to_string(),
    })
}

fn wrong_type(key: &str, expected: &str, value: &At<Value>) -> Problem {
    Problem::WrongType {
        key: key.to_owned(),
        expected: expected.to_owned(),
        found: value.get_ref().type_str().to_owned(),
    }
}
