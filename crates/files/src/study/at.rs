//! A value with its position in the file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use toml::Spanned;

/// A value with its byte range in the file; to the schema of study files it is the value alone.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct At<T>(Spanned<T>);

impl<T> At<T> {
    /// Creates a value at `span`.
    pub fn new(span: Range<usize>, value: T) -> Self {
        Self(Spanned::new(span, value))
    }

    /// Returns the value.
    pub fn get_ref(&self) -> &T {
        self.0.get_ref()
    }

    /// Returns the value without its position.
    pub fn into_inner(self) -> T {
        self.0.into_inner()
    }

    /// Returns its byte range in the file.
    pub fn span(&self) -> Range<usize> {
        self.0.span()
    }
}

impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// Returns the value of an optional key.
pub(super) fn copied<T: Copy>(typed: &Option<At<T>>) -> Option<T> {
    typed.as_ref().map(|typed| *typed.get_ref())
}

/// A value that is not in the file, without a position.
impl<T: Default> Default for At<T> {
    fn default() -> Self {
        Self::new(0..0, T::default())
    }
}

/// A table of choices by name.
pub(super) type Choices = BTreeMap<At<String>, At<toml::Value>>;

/// Returns the entries of a table in the order of the file.
pub(super) fn in_order(table: &Choices) -> Vec<(&At<String>, &At<toml::Value>)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(name, _)| name.span().start);
    entries
}
