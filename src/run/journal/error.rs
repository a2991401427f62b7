//! Errors of a journal.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// A journal that cannot be used, and why.
#[derive(Debug, Error)]
#[error("{}: {problem}", .path.display())]
pub struct JournalError {
    /// The journal.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: JournalProblem,
}

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalProblem {
    /// The file cannot be read.
    #[error("cannot read the journal: {0}")]
    Unreadable(std::io::Error),
    /// The file cannot be written.
    #[error("cannot write the journal: {0}")]
    Unwritable(std::io::Error),
    /// The path is a pipe, a device or a folder.
    #[error("a pipe, a device or a folder has the name of the journal: remove it, or choose another folder")]
    NoFile,
    /// The file is open in another process.
    #[error("another run is writing this journal")]
    InUse,
    /// The file is not a journal, or its header is damaged, for this reason.
    #[error("this is not a journal of a run: {0}")]
    Invalid(String),
    /// The version of the format is unknown.
    #[error("the journal is of format {0}, and format 1 is expected")]
    OtherFormat(u32),
    /// There is no journal to resume.
    #[error("no journal found: there is nothing to resume (quick runs keep none)")]
    Missing,
    /// It is of another study of this name, with these differences.
    #[error("the journal is of another study ({0}): {1}")]
    OtherStudy(String, String),
    /// It is of another version of the model: these files changed.
    #[error("{0} changed since the journal was written")]
    OtherModel(String),
    /// It was evaluated with other files than the journal of another shard.
    #[error("evaluated with another {files} than {}: evaluate one of the two shards again", .other.display())]
    OtherFiles {
        /// The names of the files that differ.
        files: String,
        /// The journal of the other shard.
        other: PathBuf,
    },
    /// A record of a shard cannot be divided into runs that are already merged and new ones.
    #[error("holds some runs that are already merged and some that are not")]
    PartlyMerged,
}

impl JournalProblem {
    /// Returns whether the journal is not one that the run could use, rather than one that is not accessible now.
    pub fn is_bad_input(&self) -> bool {
        !matches!(self, Self::Unwritable(_) | Self::InUse)
    }

    pub(super) fn invalid(reason: &str) -> Self {
        Self::Invalid(reason.to_owned())
    }

    /// Returns this problem of the journal at `path`.
    pub(crate) fn at(self, path: &Path) -> JournalError {
        JournalError { path: path.to_owned(), problem: self }
    }
}
