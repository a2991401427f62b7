//! The JSON Schema of study files.

use apportion::space::distribution::KEYS;
use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Value, json};

use super::key_schemas;
use super::sections::StudyFile;

/// Returns the JSON Schema (draft 7, which editors support) of study files. It contains every key and every name, but
/// not the rules across the parts of a study, which [`parse_study`](super::parse_study) checks.
///
/// ```
/// let schema = apportion_files::study_schema();
/// assert_eq!(schema["properties"]["title"]["type"], "string");
/// ```
pub fn study_schema() -> Value {
    let settings = SchemaSettings::draft07().with_transform(RecursiveTransform(without_null));
    let mut schema = settings.into_generator().into_root_schema_for::<StudyFile>().to_value();
    let factor = &mut schema["definitions"]["FactorSection"];
    if let Some(properties) = factor["properties"].as_object_mut() {
        properties.extend(KEYS.iter().map(|key| (key.name.to_owned(), key_schemas::distribution_key(key))));
    }
    let mut line = schema["definitions"]["FactorSection"].clone();
    line["properties"].as_object_mut().and_then(|keys| keys.remove("name"));
    line.as_object_mut().and_then(|line| line.remove("required"));
    schema["properties"]["factors"] = json!({
        "type": "object",
        "additionalProperties": line,
        "description": "The factors, one line for each: its name and its distribution."
    });
    schema
}

/// Removes null from the schema: TOML has none; optional keys are omitted.
fn without_null(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            object.insert("type".to_owned(), only);
        }
    }
    // A reference that may be null becomes the reference.
    if let Some(Value::Array(any)) = object.get_mut("anyOf") {
        any.retain(|one| one.get("type") != Some(&json!("null")));
        if let [Value::Object(only)] = &any[..] {
            let only = only.clone();
            object.remove("anyOf");
            object.insert("allOf".to_owned(), json!([only]));
        }
    }
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
    object.remove("format");
}
