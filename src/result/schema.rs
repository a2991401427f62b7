//! The JSON Schema of result files, generated from the types that write them.

use schemars::generate::SchemaSettings;

use crate::result::StudyResult;

/// Returns the JSON Schema (draft 7, which editors support) of result files.
///
/// ```
/// let schema = apportion::result::result_schema();
/// assert_eq!(schema["properties"]["format"]["type"], "string");
/// ```
pub fn result_schema() -> serde_json::Value {
    SchemaSettings::draft07().into_generator().into_root_schema_for::<StudyResult>().to_value()
}
