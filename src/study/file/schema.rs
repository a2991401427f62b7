//! The JSON Schema of study files: their structure comes from the types that read them, names from the lists they are
//! checked against.

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

use super::constants::CHOICES;
use super::distribution::FORMS;
use super::sections::{FactorSection, StudyFile};
use crate::afm::{ContactTheory, Fidelity, FrictionLaw, LuGreParameters, Parameter, Torsion};
use crate::design::Sampler;
use crate::estimate::Estimator;
use crate::model::{KnownAnswer, Match, ModelKind, Protocol, edge_unit};
use crate::run::FailurePolicy;
use crate::uncertainty::IntervalMethod;

/// The JSON Schema (draft 7, which editors understand) of study files. It knows every key and every name, not what the
/// parts of a study mean together: that is what [`Study::parse`](super::Study::parse) checks.
///
/// ```
/// let schema = apportion::study::study_schema();
/// assert_eq!(schema["properties"]["title"]["type"], "string");
/// ```
pub fn study_schema() -> Value {
    let settings = SchemaSettings::draft07().with_transform(RecursiveTransform(without_null));
    let mut schema = settings.into_generator().into_root_schema_for::<StudyFile>().to_value();
    if let Some(properties) = schema["properties"].as_object_mut() {
        let mut plural = properties.get("factor").cloned().unwrap_or_default();
        plural["description"] = json!("The same as `factor`.");
        properties.insert("factors".to_owned(), plural);
    }
    schema
}

/// Where a key stands in a study file, in words; `None` if there is no such key.
pub(super) fn table_of(key: &str) -> Option<&'static str> {
    let schema = study_schema();
    let has = |table: &Value| table["properties"].get(key).is_some();
    if has(&schema) {
        return Some("at the top of the file, above the first table");
    }
    let tables = [
        ("DesignSection", "in the table [design]"),
        ("AnalysisSection", "in the table [analysis]"),
        ("FactorSection", "in the table [[factor]] of a factor"),
        ("CommandSection", "in the table [command]"),
        ("ExpressionSection", "in the table [expression]"),
    ];
    tables.into_iter().find(|(name, _)| has(&schema["definitions"][*name])).map(|(_, words)| words)
}

/// TOML has no null: what is not said is left out.
fn without_null(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            object.insert("type".to_owned(), only);
        }
    }
    // A reference that may be null is the reference.
    if let Some(Value::Array(any)) = object.get_mut("anyOf") {
        any.retain(|one| one.get("type") != Some(&json!("null")));
        if let [Value::Object(only)] = &any[..] {
            let only = only.clone();
            object.remove("anyOf");
            object.insert("allOf".to_owned(), json!([only]));
        }
    }
    object.remove("format");
}

pub(super) fn models() -> Vec<&'static str> {
    ModelKind::all().into_iter().map(ModelKind::name).collect()
}

pub(super) fn samplers() -> Vec<&'static str> {
    names(&Sampler::ALL, Sampler::name)
}

/// The schema of an estimator's name.
pub(super) fn estimators() -> Value {
    json!({ "enum": names(&Estimator::ALL, Estimator::name) })
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
    FORMS.iter().map(|form| form.name).collect()
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

/// `outputs`: names, or the table that stands in that of the model.
pub(super) fn outputs(_: &mut SchemaGenerator) -> Schema {
    let names = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 });
    schemars::json_schema!({ "anyOf": [names, { "type": "object" }] })
}

/// `factor`: tables in a list, tables by the names of the factors, or the only one.
pub(super) fn factors(generator: &mut SchemaGenerator) -> Schema {
    let with_name = generator.subschema_for::<FactorSection>();
    let mut named = FactorSection::json_schema(generator);
    named.remove("required");
    named.remove("description");
    schemars::json_schema!({ "anyOf": [
        { "type": "array", "items": with_name },
        { "type": "object", "additionalProperties": named },
        with_name
    ] })
}

/// `[expression] outputs`: formulas by the names of their outputs.
pub(super) fn formulas(_: &mut SchemaGenerator) -> Schema {
    let table = json!({
        "type": "object",
        "properties": { "formula": { "type": "string" }, "unit": { "type": "string" } },
        "required": ["formula"],
        "additionalProperties": false
    });
    schemars::json_schema!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "string" }, table] } })
}

/// `[expression] constants`: numbers, or quantities with their units.
pub(super) fn expression_constants(_: &mut SchemaGenerator) -> Schema {
    schemars::json_schema!({ "type": "object", "additionalProperties": { "type": ["number", "string"] } })
}

/// `[external] outputs`: units by the names of the outputs.
pub(super) fn external_outputs(_: &mut SchemaGenerator) -> Schema {
    schemars::json_schema!({ "type": "object", "additionalProperties": { "type": "string" } })
}

/// `[command] outputs`: units, or tables that say where a number stands.
pub(super) fn program_outputs(_: &mut SchemaGenerator) -> Schema {
    let text = |description: &str| json!({ "type": "string", "description": description });
    let table = json!({
        "type": "object",
        "properties": {
            "unit": text("Unit of the program's numbers."),
            "file": text("File that a run leaves in its directory; its standard output if not said."),
            "regex": text("Regular expression, whose first group is the number."),
            "column": text("Column of a CSV table with a header."),
            "pointer": text("JSON pointer (RFC 6901), as in \"/result/force\"."),
            "match": {
                "enum": names(&Match::ALL, Match::name),
                "default": "last",
                "description": "Which match of the regex, or row of the table, is taken."
            }
        },
        "additionalProperties": false
    });
    schemars::json_schema!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "string" }, table] } })
}

fn object(properties: Map<String, Value>) -> Schema {
    schemars::json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
}
