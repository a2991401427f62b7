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
    #[error("{}: this is not a journal of a run: {found}", .path.display())]
    NotAJournal {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        found: String,
    },
    /// The version of the format is unknown.
    #[error("{}: the journal is of format {version}, and this program reads format 1 (format 2 holds sums of runs, which are no longer kept)", .path.display())]
    OtherVersion {
        /// The file.
        path: PathBuf,
        /// Its version.
        version: u32,
    },
}

impl JournalError {
    pub(super) fn unreadable(path: &Path, source: std::io::Error) -> Self {
        Self::Unreadable { path: path.to_owned(), source }
    }

    pub(super) fn unwritable(path: &Path, source: std::io::Error) -> Self {
        Self::Unwritable { path: path.to_owned(), source }
    }
}
