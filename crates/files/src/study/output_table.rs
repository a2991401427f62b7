//! The key `outputs` as typed: names, or a table with an entry for each output.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::at::{At, Choices};
use crate::Match;

/// Names of outputs, or a table with one entry for each.
#[derive(Debug)]
pub(super) enum Outputs {
    Names(Vec<At<String>>),
    Table(Choices),
}

impl<'de> Deserialize<'de> for Outputs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OutputsVisitor)
    }
}

/// A visitor, because an untagged enum would lose the positions of the values.
struct OutputsVisitor;

impl<'de> Visitor<'de> for OutputsVisitor {
    type Value = Outputs;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list in square brackets, or a table")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Outputs, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(Outputs::Names)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Outputs, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(table)).map(Outputs::Table)
    }
}

/// The table of an output: its formula, the place of its number after a run, the axis of a series.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OutputTable {
    /// Formula of the factors.
    pub formula: Option<String>,
    /// Unit of the output's numbers.
    pub unit: Option<String>,
    /// File that a run writes in its directory; standard output by default.
    pub file: Option<String>,
    /// Regular expression, whose first group is the number.
    pub regex: Option<String>,
    /// Column of a CSV table with a header.
    pub column: Option<String>,
    /// JSON pointer (RFC 6901), as in "/result/force".
    pub pointer: Option<String>,
    /// Which match of the regex, or row of the table, to use; a series uses all.
    #[serde(rename = "match")]
    #[schemars(extend("enum" = Match::ALL.map(Match::name), "default" = "last"))]
    pub which: Option<String>,
    /// The number of values, if the output is a series along an axis.
    #[schemars(range(min = 2, max = 10000))]
    pub length: Option<u64>,
    /// Name of the axis.
    #[schemars(extend("default" = "index"))]
    pub axis: Option<String>,
    /// Unit of the positions.
    pub axis_unit: Option<String>,
    /// The first position and the step, or the position of every value; 0, 1, 2, ... by default.
    pub positions: Option<Vec<f64>>,
}
