//! Errors of a study, with their positions in its file.

mod diagnostic;
mod problem;
mod synonyms;

use std::path::PathBuf;

pub use diagnostic::Diagnostic;
pub use problem::Problem;
pub(super) use synonyms::meant;
use thiserror::Error;

/// A study that cannot be read or is invalid.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file cannot be read at all.
    #[error("{path}: cannot read the study file: {source}", path = path.display())]
    Unreadable {
        /// The path as given.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// An override from the command line is invalid.
    #[error("--set {text}: {problem}")]
    Override {
        /// The override as given.
        text: String,
        /// The problem.
        problem: String,
    },
    /// A part of the file is invalid.
    #[error(transparent)]
    Invalid(#[from] Box<Diagnostic>),
}
