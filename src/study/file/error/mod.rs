//! What can be wrong with a study, and where in its file.

mod diagnostic;
mod problem;
mod synonyms;

use std::path::PathBuf;

use thiserror::Error;

pub use diagnostic::Diagnostic;
pub use problem::Problem;
pub(super) use synonyms::meant;

use crate::study::did_you_mean;

/// A study that cannot be read or makes no sense.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file cannot be read at all.
    #[error("{path}: cannot read the study file: {source}", path = path.display())]
    Unreadable {
        /// The path as given.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// An override from the command line makes no sense.
    #[error("--set {text}: {problem}")]
    Override {
        /// The override as given.
        text: String,
        /// What is wrong with it.
        problem: OverrideProblem,
    },
    /// A place in the file is wrong.
    #[error(transparent)]
    Invalid(#[from] Box<Diagnostic>),
}

/// What is wrong with an override `KEY=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OverrideProblem {
    /// There is no `=`.
    #[error("expected KEY=VALUE, as in afm.friction=hk or factor.length.max=500")]
    NoEquals,
    /// A part of the key is empty.
    #[error("the key `{0}` has an empty part: expected names joined by dots, as in afm.friction")]
    EmptyKey(String),
    /// The key has more parts than any that a study has.
    #[error("the key has {0} parts, more than any key of a study: expected names joined by dots, as in afm.friction")]
    TooDeep(usize),
    /// `factor.NAME` names no factor of the file.
    #[error("the study has no factor `{name}`{}", did_you_mean(.nearest))]
    NoFactor {
        /// The name given.
        name: String,
        /// The nearest factor of the file.
        nearest: Option<String>,
    },
    /// `factor.NAME=VALUE` would fix an input of a model that has no constants.
    #[error("factor.{name}=VALUE fixes an input of afm or of a formula; all inputs of the model `{model}` are factors")]
    NotFixed {
        /// The name of the factor.
        name: String,
        /// The model of the study.
        model: String,
    },
    /// The key leads through something that is not a table.
    #[error("`{0}` is not a table of the study, so nothing can be set inside it")]
    NotATable(String),
    /// A list of names would take the place of formulas or units.
    #[error(
        "`outputs` is a table in this study, whose formulas or units a list of names would replace: change one by outputs.NAME=..."
    )]
    OutputsTable,
    /// The file can be read, but not changed.
    #[error("the study cannot be changed, because it holds a whole number beyond 2^63 - 1, which is not TOML")]
    NotEditable,
}
