//! Statements of a result with their sentences, as in JSON. Readers ignore the sentences.

use std::fmt::Display;

use serde::{Serialize, Serializer};

/// A statement with its sentence.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "{T}Record"))]
pub(super) struct WithText<T> {
    #[serde(flatten)]
    statement: T,
    /// The same in a sentence.
    text: String,
}

impl<T: Display> WithText<T> {
    fn new(statement: T) -> Self {
        Self { text: statement.to_string(), statement }
    }
}

/// Writes a statement with its sentence.
pub(super) fn with_text<T: Serialize + Display, S: Serializer>(
    statement: &Option<T>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    statement.as_ref().map(WithText::new).serialize(serializer)
}

/// Writes statements with their sentences.
pub(super) fn with_texts<T: Serialize + Display, S: Serializer>(
    statements: &[T],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(statements.iter().map(WithText::new))
}
