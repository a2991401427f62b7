//! The tables `[afm]`, with choices by name and constants of the scene with their units, and `[function]`.

use apportion::model::OutputSeries;
use std::ops::RangeInclusive;

use apportion::model::{KnownFunction, ParameterError, ParameterValue};
use apportion::space::Space;
use apportion_afm::{AfmMoments, Fidelity, FrictionLaw, Options, Parameter, Scene, edge_unit};
use apportion_base::names::Named;
use apportion_base::quantity::{Dimension, Quantity, Unit};
use toml::{Table, Value};

use super::at::{At, Choices};
use super::context::{Context, Fault, named, names_of, number, shown, unknown_key, wrong};
use super::error::Problem;
use super::key_schemas::afm_choices;
use super::reading::Reading;
use super::units::{in_words_of_units, with_unit, wrong_unit};

/// Reads the table into a scene and options, starting from the defaults. Factors of `space` must not be fixed.
pub(super) fn afm(context: &Context, table: &Choices, space: &Space) -> Result<(Scene, Options), Fault> {
    let (mut scene, mut options) = (Scene::default(), Options::default());
    for (key, value) in table {
        let name = key.get_ref().as_str();
        if context.at(value, set_option(&mut options, name, value))? {
            continue;
        }
        let Some(parameter) = Parameter::from_name(name) else {
            let parameters = Parameter::ALL.iter().map(|parameter| parameter.name);
            let valid = afm_choices().map(|(key, _)| key).chain(parameters);
            return Err(context.fault(key.span(), unknown_key(name, valid)));
        };
        if space.factors().iter().any(|factor| factor.name == name) {
            let problem = format!("`{name}` is a factor of this study, so it cannot be fixed in [afm]");
            let help = format!("remove `{name}` here, or from the factors");
            return Err(context.fault(key.span(), Problem::with_help(problem, help)));
        }
        (parameter.set)(&mut scene, context.at(value, constant(parameter, value))?);
    }
    Ok((scene, options))
}

/// Sets the option of that name, and returns whether it is one.
fn set_option(options: &mut Options, name: &str, value: &At<Value>) -> Result<bool, Problem> {
    match name {
        "friction" => options.friction = choice(value, name, "friction law")?,
        "contact" => options.contact = choice(value, name, "contact theory")?,
        "fidelity" => options.fidelity = choice(value, name, "fidelity")?,
        "torsion" => options.torsion = choice(value, name, "torsion formula")?,
        "lugre_parameters" => options.lugre = choice(value, name, "source of LuGre parameters")?,
        "tolerance" => options.tolerance = positive(name, "1e-6", value.get_ref())?,
        "step" => options.step = positive(name, "\"10 ms\"", value.get_ref())?,
        "step_budget" => {
            options.step_budget = integer(name, "a whole number from 1", 1..=i64::MAX, value.get_ref())? as u64;
        }
        "adhesion_in_load" => {
            let typed = value.get_ref().as_bool();
            options.adhesion_in_load = typed.ok_or_else(|| wrong(name, "true or false", shown(value.get_ref())))?;
        }
        // See `moments`.
        "history" => (),
        _ => return Ok(false),
    }
    Ok(true)
}

/// Default duration in seconds and number of moments of a history: those of the papers' scene in time.
const DURATION: f64 = 0.4;
const POINTS: usize = 40;

/// Returns the moments of the outputs that are histories, from the key `history`.
pub(super) fn moments(context: &Context, table: &Choices) -> Result<AfmMoments, Fault> {
    let Some((_, typed)) = table.iter().find(|(key, _)| key.get_ref() == "history") else {
        return history(&Table::new()).map_err(|problem| context.fault(0..0, problem));
    };
    match typed.get_ref().as_table() {
        Some(table) => context.at(typed, history(table)),
        None => {
            let expected = "a table such as { duration = \"0.4 s\", points = 40 }";
            context.refuse(typed, "history", expected, shown(typed.get_ref()))
        }
    }
}

fn history(table: &Table) -> Result<AfmMoments, Problem> {
    let (mut duration, mut points) = (DURATION, POINTS);
    for (key, typed) in table {
        match key.as_str() {
            "duration" => duration = positive("history.duration", "\"0.4 s\"", typed)?,
            "points" => {
                let range = 2..=OutputSeries::MAX_VALUES as i64;
                points = integer("history.points", "a whole number from 2 to 10000", range, typed)? as usize;
            }
            other => return Err(unknown_key(other, ["duration", "points"])),
        }
    }
    AfmMoments::new(duration, points).map_err(|error| Problem::new(format!("`history`: {error}")))
}

/// Returns notes on keys of the table that are valid but have no effect under `options`.
pub(super) fn notes(table: &Choices, options: &Options, has_histories: bool) -> Vec<String> {
    let is_marched = options.fidelity != Fidelity::ClosedForm;
    let (friction, fidelity) = (options.friction.name(), options.fidelity.name());
    let mut notes = Vec::new();
    for name in table.keys().map(At::get_ref) {
        let has_effect = match name.as_str() {
            "step" => options.fidelity == Fidelity::FixedStep,
            "tolerance" => is_marched && options.fidelity != Fidelity::FixedStep,
            "step_budget" => is_marched,
            "lugre_parameters" => is_marched && options.friction == FrictionLaw::LuGre,
            _ => true,
        };
        if !has_effect {
            notes.push(format!("`{name}` has no effect with friction = \"{friction}\" and fidelity = \"{fidelity}\""));
        }
    }
    if !has_histories && table.keys().any(|key| key.get_ref() == "history") {
        notes.push("`history` has no effect without an output that is one, such as force_history".to_owned());
    }
    notes
}

fn integer(key: &str, expected: &str, range: RangeInclusive<i64>, value: &Value) -> Result<i64, Problem> {
    let integer = value.as_integer().filter(|integer| range.contains(integer));
    integer.ok_or_else(|| wrong(key, expected, shown(value)))
}

fn choice<T: Named>(value: &At<Value>, key: &str, what: &'static str) -> Result<T, Problem> {
    match value.get_ref() {
        Value::String(text) => named(text, what),
        other => {
            let names: Vec<String> = names_of::<T>().iter().map(|name| format!("{name:?}")).collect();
            Err(wrong(key, &format!("one of {}", names.join(", ")), shown(other)))
        }
    }
}

/// Parses the SI value of a constant given as `"0.7 deg"`, or as a bare number if the parameter has no dimension.
fn constant(parameter: &Parameter, value: &At<Value>) -> Result<f64, Problem> {
    let unit = edge_unit(parameter);
    let (name, default) = (parameter.name, (parameter.get)(&Scene::default()));
    let example = match unit.compatible(&Unit::dimensionless()) {
        true => format!("{name} = {default}"),
        false => format!("{name} = \"{} {unit}\"", unit.from_si(default)),
    };
    let quantity = match value.get_ref() {
        Value::String(text) => Quantity::parse(text)?,
        other => match number(other) {
            Some(value) => Quantity { value, unit: Unit::dimensionless() },
            None => return Err(wrong(name, &format!("a quantity, as in {example}"), shown(other))),
        },
    };
    if !quantity.unit.compatible(&unit) {
        let stated = Some(&quantity.unit).filter(|unit| !unit.compatible(&Unit::dimensionless()));
        return Err(wrong_unit(&format!("`{name}`"), &unit, stated, &example));
    }
    let si = quantity.unit.to_si(quantity.value);
    if !parameter.domain.contains(si) || !unit.from_si(si).is_finite() {
        let domain = in_words_of_units(parameter.domain);
        let value = with_unit(quantity.value, quantity.unit.symbol());
        return Err(Problem::new(format!("`{name}` must be {domain}, but it is {value}")));
    }
    Ok(si)
}

/// Parses a number greater than 0: bare if it has no dimension, as `example` shows, or a time with its unit.
fn positive(key: &str, example: &str, value: &Value) -> Result<f64, Problem> {
    let is_time = example.starts_with('"');
    let kind = if is_time { "time" } else { "number" };
    let number = match value {
        Value::String(text) if is_time => {
            let quantity = Quantity::parse(text)?;
            (quantity.unit.dimension() == Dimension::TIME).then(|| quantity.to_si())
        }
        other => number(other).filter(|_| !is_time),
    };
    number
        .filter(|number| *number > 0.0 && number.is_finite())
        .ok_or_else(|| wrong(key, &format!("a {kind} greater than 0, as in {key} = {example}"), value))
}

/// Returns the function with the parameters of its table; `None` for models that are none.
pub(super) fn known_function(reading: &Reading) -> Result<Option<KnownFunction>, Fault> {
    let Reading { context, file, kind } = reading;
    let Some(answer) = kind.known else { return Ok(None) };
    let Some(table) = &file.function else { return Ok(Some(answer.default_function())) };
    let mut parameters = Vec::new();
    for (key, value) in table.get_ref() {
        let name = key.get_ref();
        if answer.parameters.is_empty() {
            return Err(context.fault(key.span(), Problem::new(ParameterError::unknown(name).to_string())));
        }
        if answer.parameters.iter().all(|parameter| parameter.name != name) {
            let valid = answer.parameters.iter().map(|parameter| parameter.name);
            return Err(context.fault(key.span(), unknown_key(name, valid)));
        }
        let Some(parameter) = number_or_list(value.get_ref()) else {
            return context.refuse(value, name, "a number or a list of numbers", shown(value.get_ref()));
        };
        parameters.push((name.clone(), parameter));
    }
    answer.with(&parameters).map(Some).map_err(|error| {
        let typed = table.get_ref().iter().find(|(key, _)| *key.get_ref() == error.parameter);
        let span = typed.map_or(table.span(), |(_, value)| value.span());
        context.fault(span, Problem::new(error.to_string()))
    })
}

fn number_or_list(value: &Value) -> Option<ParameterValue> {
    match value {
        Value::Array(list) => list.iter().map(number).collect::<Option<_>>().map(ParameterValue::List),
        other => number(other).map(ParameterValue::Number),
    }
}
