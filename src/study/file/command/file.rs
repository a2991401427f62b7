//! What was typed of a program: `command = [...]`, or the table `[command]`.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use crate::study::file::at::{At, Choices};
use crate::study::file::key_schemas;

/// The program alone, or a table.
#[derive(Debug)]
pub enum CommandKey {
    Program(Vec<At<String>>),
    Table(Box<CommandSection>),
}

/// A program of your own as the model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CommandSection {
    /// The program and its arguments; no shell reads them.
    #[schemars(length(min = 1))]
    pub program: Option<At<Vec<At<String>>>>,
    /// What the program gives, in its order: the unit of each output, or a table of `unit` and where the number stands
    /// after a run (`regex`, `column` or `pointer`, in `file` or else its standard output).
    #[serde(default)]
    #[schemars(schema_with = "key_schemas::program_outputs")]
    pub outputs: Choices,
    /// How rows are handed over to a program that is kept alive.
    #[schemars(extend("enum" = key_schemas::protocols(), "default" = "csv"))]
    pub protocol: Option<At<String>>,
    /// Every row has a number (`id`: the first column of CSV, a key of a JSON object), which the program writes back with its
    /// answer. Studies need not say so any more, and cannot say otherwise.
    #[schemars(extend("const" = true))]
    pub row_numbers: Option<At<bool>>,
    /// Processes at once; by default as many as there are cores.
    #[schemars(range(min = 1, max = 1024))]
    pub workers: Option<At<u64>>,
    /// How long a row may take, as in "60 s"; by default as long as it takes.
    pub timeout: Option<At<String>>,
    /// How often a row is tried again on which the program died, hung or printed rubbish; once by default.
    #[schemars(range(max = 100))]
    pub retries: Option<At<u64>>,
    /// Where the program runs and its relative paths begin, relative to the study; by default the folder of the study.
    pub directory: Option<At<String>>,
    /// Environment variables that are set for the program.
    #[serde(default)]
    pub env: BTreeMap<String, String>,
    /// Other files that decide its answers, relative to the study, such as its data: answers on record from before one of them
    /// changed are not mixed with new ones. The program and the files among its arguments need no mention, what they import does.
    #[serde(default)]
    pub depends_on: Vec<At<String>>,
    /// Template of an input file, in which {{name}} stands for the value of a factor: the program then runs once for each
    /// row, in a directory of its own.
    pub template: Option<At<String>>,
    /// Name of the input file in the directory of a run; by default that of the template.
    pub input: Option<At<String>>,
    /// Files that are copied to the directory of each run, relative to the study.
    #[serde(default)]
    pub files: Vec<At<String>>,
    /// Whether the paths of this table may lead out of the study's folder.
    pub files_outside: Option<At<bool>>,
    /// Folder in which the directories of runs are kept, relative to the study; by default each is removed after its run.
    pub keep: Option<At<String>>,
}

impl<'de> Deserialize<'de> for CommandKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Either)
    }
}

/// By a visitor and not as an untagged enum, so that every value keeps its place in the file.
struct Either;

impl<'de> Visitor<'de> for Either {
    type Value = CommandKey;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list such as [\"python3\", \"my_model.py\"], or a table [command]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<CommandKey, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(CommandKey::Program)
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<CommandKey, A::Error> {
        Deserialize::deserialize(MapAccessDeserializer::new(table)).map(CommandKey::Table)
    }
}

impl JsonSchema for CommandKey {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Command".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<CommandSection>();
        json_schema!({ "anyOf": [{ "type": "array", "items": { "type": "string" }, "minItems": 1 }, table] })
    }
}
