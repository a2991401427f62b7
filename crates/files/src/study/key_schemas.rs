//! The schemas of single keys of study files, which do not follow from their types.

use apportion::model::KnownAnswer;
use apportion::space::distribution::{Key, KeyKind};
use apportion_afm::{Parameter, edge_unit};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::output_table::OutputTable;
use crate::ModelKind;

/// Returns the choices of `[afm]`, each with its possible names.
pub(super) fn afm_choices() -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
    ModelKind::AFM.choices().into_iter().map(|choice| (choice.key, choice.values))
}

/// Returns the schema of the low-fidelity models.
pub(super) fn lows(_: &mut SchemaGenerator) -> Schema {
    let table = json!({ "type": "object", "required": ["name"], "properties": { "name": { "type": "string" } } });
    schemars::json_schema!({ "type": "array", "items": { "anyOf": [{ "type": "string" }, table] } })
}

/// Returns the schema of `[afm]`: the choices, and every parameter as a quantity.
pub(super) fn afm(_: &mut SchemaGenerator) -> Schema {
    let mut properties = Map::new();
    for (key, names) in afm_choices() {
        let schema = match key {
            "tolerance" => json!({ "type": "number", "exclusiveMinimum": 0 }),
            "adhesion_in_load" => json!({ "type": "boolean" }),
            "step" => json!({ "type": "string", "description": "A time, as in \"10 ms\"." }),
            "step_budget" => json!({ "type": "integer", "minimum": 1 }),
            "history" => json!({
                "type": "object",
                "description": "Duration of the outputs that are histories, and their number of points in time.",
                "properties": { "duration": { "type": "string" }, "points": { "type": "integer", "minimum": 2 } },
                "additionalProperties": false,
            }),
            _ => json!({ "enum": names }),
        };
        properties.insert(key.to_owned(), schema);
    }
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

/// Returns the schema of a name, or a table of that type.
pub(super) fn name_or_table<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let table = generator.subschema_for::<T>();
    schemars::json_schema!({ "anyOf": [{ "type": "string" }, table] })
}

/// Returns the schema of a list of texts, or a table of that type.
pub(super) fn list_or_table<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let table = generator.subschema_for::<T>();
    schemars::json_schema!({ "anyOf": [{ "type": "array", "items": { "type": "string" }, "minItems": 1 }, table] })
}

/// Returns the schema of `[function]`: the parameters of all functions.
pub(super) fn function(_: &mut SchemaGenerator) -> Schema {
    let number_or_list = json!([{ "type": "number" }, { "type": "array", "items": { "type": "number" } }]);
    let mut properties = Map::new();
    for parameter in KnownAnswer::all().flat_map(|answer| answer.parameters) {
        let entry = properties.entry(parameter.name);
        entry.or_insert(json!({ "anyOf": number_or_list, "description": parameter.description }));
    }
    object(properties)
}

/// Returns the schema of `[expression] constants`: numbers, or quantities with their units.
pub(super) fn expression_constants(_: &mut SchemaGenerator) -> Schema {
    schemars::json_schema!({ "type": "object", "additionalProperties": { "type": ["number", "string"] } })
}

/// Returns the schema of a key of distributions.
pub(super) fn distribution_key(key: &Key) -> Value {
    let (number, text) = (json!({ "type": "number" }), json!({ "type": "string" }));
    let mut schema = match key.kind {
        KeyKind::Number => number,
        KeyKind::Numbers => json!({ "type": "array", "items": number }),
        KeyKind::Bounds => json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 }),
        KeyKind::Text => text,
        KeyKind::Texts => json!({ "type": "array", "items": text }),
        KeyKind::Quantiles => json!({ "type": "object", "additionalProperties": number }),
    };
    schema["description"] = json!(key.description);
    schema
}

/// Returns the schema of `outputs`: names, or for each a formula or its unit, or a table of more.
pub(super) fn outputs(generator: &mut SchemaGenerator) -> Schema {
    let table = generator.subschema_for::<OutputTable>();
    let list = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 });
    let entries = json!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "string" }, table] } });
    schemars::json_schema!({ "anyOf": [list, entries] })
}

fn object(properties: Map<String, Value>) -> Schema {
    schemars::json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
}
