//! The key `command` as typed: a program of the user's own as the model.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::at::{At, ListOrTable};
use super::context::names_of;
use crate::Protocol;

/// The program alone, or a table.
pub(super) type CommandKey = ListOrTable<Box<CommandSection>>;

/// A program of your own as the model.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table [command]")]
pub(super) struct CommandSection {
    /// The program and its arguments; no shell reads them.
    #[schemars(length(min = 1))]
    pub program: Option<At<Vec<At<String>>>>,
    /// The format of rows and answers of a program that is kept alive.
    #[schemars(extend("enum" = names_of::<Protocol>(), "default" = "csv"))]
    pub protocol: Option<At<String>>,
    /// Number of processes at the same time; by default the number of cores.
    #[schemars(range(min = 1, max = 1024))]
    pub workers: Option<At<u64>>,
    /// Time limit for a row, as in "60 s"; by default none.
    pub timeout: Option<At<String>>,
    /// How often a row is retried after the program crashed, hung or printed an invalid answer; once by default.
    #[schemars(range(max = 100))]
    pub retries: Option<At<u64>>,
    /// Working directory of the program, relative to the study; by default the folder of the study.
    pub directory: Option<At<String>>,
    /// Environment variables that are set for the program.
    #[serde(default)]
    pub env: BTreeMap<String, String>,
    /// Other files that its answers depend on, such as data, relative to the study: recorded answers from before a change of these
    /// files are not reused. The program and files among its arguments are included; list what they import.
    #[serde(default)]
    pub depends_on: Vec<At<String>>,
    /// Template of an input file, in which {{name}} stands for the value of a factor: the program then runs once for each
    /// row, in its own directory.
    pub template: Option<At<String>>,
    /// Name of the input file in the directory of a run; by default that of the template.
    pub input: Option<At<String>>,
    /// Files that are copied to the directory of each run, relative to the study.
    #[serde(default)]
    pub files: Vec<At<String>>,
    /// Whether paths in this table may lead outside the study's folder.
    pub files_outside: Option<At<bool>>,
    /// Folder that keeps the directories of runs, relative to the study; by default each is removed after its run.
    pub keep: Option<At<String>>,
}
