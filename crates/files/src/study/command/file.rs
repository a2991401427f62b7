//! The settings of a program as typed: `command = [...]`, or the table `[command]`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::Protocol;
use crate::study::at::{At, ListOrTable};
use crate::study::key_schemas::names;

/// The program alone, or a table.
pub type CommandKey = ListOrTable<Box<CommandSection>>;

/// A program of your own as the model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [command]")]
pub struct CommandSection {
    /// The program and its arguments; no shell reads them.
    #[schemars(length(min = 1))]
    pub program: Option<At<Vec<At<String>>>>,
    /// How rows are handed over to a program that is kept alive.
    #[schemars(extend("enum" = names(&Protocol::ALL, Protocol::name), "default" = "csv"))]
    pub protocol: Option<At<String>>,
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
