//! Errors of a journal.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// The file cannot be read.
    #[error("{}: cannot read the journal: {source}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error("{}: cannot write the journal: {source}", .path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The path is a pipe, a device or a folder.
    #[error("{}: a pipe, a device or a folder has the name of the journal: remove it, or choose another folder", .path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
    /// The file is open in another process.
    #[error("{}: another run is writing this journal", .path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// The file is not a journal, or its header is damaged.
    #[error("{}: this is not a journal of a run: {reason}", .path.display())]
    NotAJournal {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The version of the format is unknown.
    #[error("{}: the journal is of format {version}, and format 1 is expected", .path.display())]
    OtherVersion {
        /// The file.
        path: PathBuf,
        /// Its version.
        version: u32,
    },
}

/// Why a journal does not fit a run.
#[derive(Debug, Error)]
pub enum JournalMismatch {
    /// There is no journal to resume.
    #[error("no journal found: there is nothing to resume (quick runs keep none)")]
    Missing,
    /// The file cannot be read.
    #[error("cannot read the journal: {0}")]
    Unreadable(std::io::Error),
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

impl JournalError {
    pub(super) fn invalid(path: &Path, reason: &str) -> Self {
        Self::NotAJournal { path: path.to_owned(), reason: reason.to_owned() }
    }

    pub(super) fn unreadable(path: &Path, source: std::io::Error) -> Self {
        Self::Unreadable { path: path.to_owned(), source }
    }

    pub(super) fn unwritable(path: &Path, source: std::io::Error) -> Self {
        Self::Unwritable { path: path.to_owned(), source }
    }
}
