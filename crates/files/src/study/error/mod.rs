//! What can be wrong with a study, and where in its file.

mod diagnostic;
mod problem;
mod synonyms;

use std::path::PathBuf;

pub use diagnostic::Diagnostic;
pub use problem::Problem;
pub(super) use synonyms::meant;
use thiserror::Error;

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
        problem: String,
    },
    /// A place in the file is wrong.
    #[error(transparent)]
    Invalid(#[from] Box<Diagnostic>),
}
