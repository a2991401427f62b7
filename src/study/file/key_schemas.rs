//! The schemas of single keys of study files, which their types alone do not tell.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use crate::afm::{ContactTheory, Fidelity, FrictionLaw, LuGreParameters, Parameter, Torsion};
use crate::design::Sampler;
use crate::estimate::{Estimator, ShapleyMethod, ShapleyPlayers};
use crate::given::Measure;
use crate::model::{KnownAnswer, Match, ModelKind, Protocol, edge_unit};
use crate::run::FailurePolicy;
use crate::space::CorrelationMeasure;
use crate::space::distribution::{Key, KeyKind, Kind};
use crate::study::SurrogateChoice;
use crate::uncertainty::IntervalMethod;

pub(super) const CHOICES: [&str; 10] = [
    "friction",
    "contact",
    "fidelity",
    "torsion",
    "adhesion_in_load",
    "lugre_parameters",
    "tolerance",
    "step",
    "step_budget",
    "history",
];

pub(super) fn models() -> Vec<&'static str> {
    ModelKind::all().into_iter().map(|kind| kind.name).collect()
}

pub(super) fn samplers() -> Vec<&'static str> {
    names(&Sampler::ALL, Sampler::name)
}

/// The schema of the cheaper models.
pub(super) fn lows(_: &mut SchemaGenerator) -> Schema {
    let table = json!({ "type": "object", "required": ["name"], "properties": { "name": { "type": "string" } } });
    schemars::json_schema!({ "type": "array", "items": { "anyOf": [{ "type": "string" }, table] } })
}

/// The schema of an estimator's name.
pub(super) fn estimators() -> Value {
    json!({ "enum": names(&Estimator::ALL, Estimator::name) })
}

pub(super) fn measures() -> Value {
    json!({ "enum": names(&Measure::ALL, Measure::name) })
}

pub(super) fn correlation_measures() -> Vec<&'static str> {
    names(&CorrelationMeasure::ALL, CorrelationMeasure::name)
}

pub(super) fn surrogates() -> Vec<&'static str> {
    names(&SurrogateChoice::ALL, SurrogateChoice::name)
}

pub(super) fn shapley_methods() -> Vec<&'static str> {
    names(&ShapleyMethod::ALL, ShapleyMethod::name)
}

pub(super) fn shapley_players() -> Vec<&'static str> {
    names(&ShapleyPlayers::ALL, ShapleyPlayers::name)
}

pub(super) fn intervals() -> Vec<&'static str> {
    names(&IntervalMethod::ALL, IntervalMethod::name)
}

pub(super) fn failure_policies() -> Vec<&'static str> {
    names(&FailurePolicy::ALL, FailurePolicy::name)
}

pub(super) fn protocols() -> Vec<&'static str> {
    names(&Protocol::ALL, Protocol::name)
}

pub(super) fn distributions() -> Vec<&'static str> {
    Kind::all().map(Kind::name).collect()
}

fn names<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<&'static str> {
    all.iter().map(|&choice| name(choice)).collect()
}

/// `[afm]`: the choices, and every parameter as a quantity.
pub(super) fn afm(_: &mut SchemaGenerator) -> Schema {
    let choice = |key: &str| match key {
        "friction" => json!({ "enum": names(FrictionLaw::ALL, FrictionLaw::name) }),
        "contact" => json!({ "enum": names(ContactTheory::ALL, ContactTheory::name) }),
        "fidelity" => json!({ "enum": names(Fidelity::ALL, Fidelity::name) }),
        "torsion" => json!({ "enum": names(Torsion::ALL, Torsion::name) }),
        "lugre_parameters" => json!({ "enum": names(LuGreParameters::ALL, LuGreParameters::name) }),
        "adhesion_in_load" => json!({ "type": "boolean" }),
        "step" => json!({ "type": "string", "description": "A time, as in \"10 ms\"." }),
        "step_budget" => json!({ "type": "integer", "minimum": 1 }),
        "history" => json!({
            "type": "object",
            "description": "Over which time the outputs that are histories are told, and at how many moments.",
            "properties": { "duration": { "type": "string" }, "points": { "type": "integer", "minimum": 2 } },
            "additionalProperties": false,
        }),
        _ => json!({ "type": "number", "exclusiveMinimum": 0 }),
    };
    let mut properties: Map<String, Value> = CHOICES.iter().map(|key| ((*key).to_owned(), choice(key))).collect();
    for parameter in Parameter::ALL {
        let unit = edge_unit(parameter);
        let (kinds, example) = match unit.symbol() {
            "1" => (json!(["number", "string"]), String::new()),
            symbol => (json!("string"), format!("; with its unit, as in \"1 {symbol}\"")),
        };
        let description = format!("{} ({}){example}", parameter.description, parameter.symbol);
        properties.insert(parameter.name.to_owned(), json!({ "type": kinds, "description": description }));
    }
    object(properties)
}

/// A name, or a table of that type.
pub(super) fn name_or_table<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let table = generator.subschema_for::<T>();
    schemars::json_schema!({ "anyOf": [{ "type": "string" }, table] })
}

/// `[function]`: the parameters of all functions.
pub(super) fn function(_: &mut SchemaGenerator) -> Schema {
    let number_or_list = || json!([{ "type": "number" }, { "type": "array", "items": { "type": "number" } }]);
    let mut properties = Map::new();
    for parameter in KnownAnswer::all().flat_map(KnownAnswer::parameters) {
        properties
            .entry(parameter.name)
            .or_insert_with(|| json!({ "anyOf": number_or_list(), "description": parameter.description }));
    }
    object(properties)
}

/// `[expression] constants`: numbers, or quantities with their units.
pub(super) fn expression_constants(_: &mut SchemaGenerator) -> Schema {
    schemars::json_schema!({ "type": "object", "additionalProperties": { "type": ["number", "string"] } })
}

/// What makes an output a series.
fn series_properties() -> Map<String, Value> {
    let number = json!({ "type": "number" });
    let properties = json!({
        "length": { "type": "integer", "minimum": 2, "maximum": 10000,
            "description": "The output is a series of so many values along an axis." },
        "axis": { "type": "string", "default": "index", "description": "What the axis is called." },
        "axis_unit": { "type": "string", "description": "Unit of the positions." },
        "positions": { "type": "array", "items": number,
            "description": "The first position and the step, or the position of every value; 0, 1, 2, ... if not said." }
    });
    properties.as_object().cloned().unwrap_or_default()
}

/// A key of distributions.
pub(super) fn distribution_key(key: &Key) -> Value {
    let (number, text) = (json!({ "type": "number" }), json!({ "type": "string" }));
    let mut schema = match key.kind {
        KeyKind::Number => number,
        KeyKind::Numbers => json!({ "type": "array", "items": number }),
        KeyKind::Bounds => json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 }),
        KeyKind::Text => text,
        KeyKind::Texts => json!({ "type": "array", "items": text }),
        KeyKind::Quantiles => json!({ "type": "object", "additionalProperties": number }),
        KeyKind::Distributions => {
            json!({ "type": "array", "items": { "$ref": "#/definitions/ComponentSection" }, "minItems": 1 })
        }
    };
    schema["description"] = json!(key.description);
    schema
}

/// `outputs`: names, or for each a formula or its unit, or a table of more.
pub(super) fn outputs(_: &mut SchemaGenerator) -> Schema {
    let text = |description: &str| json!({ "type": "string", "description": description });
    let own = json!({
            "formula": text("Formula of the factors."),
            "unit": text("Unit of the output's numbers."),
            "file": text("File that a run leaves in its directory; its standard output if not said."),
            "regex": text("Regular expression, whose first group is the number."),
            "column": text("Column of a CSV table with a header."),
            "pointer": text("JSON pointer (RFC 6901), as in \"/result/force\"."),
            "match": {
                "enum": names(&Match::ALL, Match::name),
                "default": "last",
                "description": "Which match of the regex, or row of the table, is taken; of a series every one."
            }
    });
    let mut properties = series_properties();
    properties.extend(own.as_object().cloned().unwrap_or_default());
    let table = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    let list = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 });
    let entries = json!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "string" }, table] } });
    schemars::json_schema!({ "anyOf": [list, entries] })
}

fn object(properties: Map<String, Value>) -> Schema {
    schemars::json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
}
