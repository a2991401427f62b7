//! Errors that end a run without its totals.

use thiserror::Error;

use super::journal::JournalError;
use super::{MAX_STORED_BYTES, RowPosition};
use crate::design::DesignError;
use crate::model::{GiveUp, RowFailure};

/// Why a run could not start, or was stopped.
#[derive(Debug, Error)]
pub enum RunError {
    /// The operating system could not start the threads.
    #[error("cannot start {threads} threads: {source}")]
    Threads {
        /// The number requested.
        threads: usize,
        /// The cause.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A row failed, and the run was to stop at the first failure.
    #[error("a run failed, and the study stops at the first failure: {reason}")]
    RowFailed {
        /// The row.
        row: RowPosition,
        /// The cause.
        reason: RowFailure,
    },
    /// The outputs of all runs were to be kept, and there are too many.
    #[error(
        "the outputs of {runs} runs must be in memory at once and take {bytes} bytes, more than the limit of \
         {MAX_STORED_BYTES}"
    )]
    TooManyOutputs {
        /// Model runs.
        runs: u64,
        /// Bytes that their outputs take.
        bytes: u64,
    },
    /// The run was interrupted.
    #[error("interrupted after {done}{} runs", total.map_or_else(String::new, |total| format!(" of {total}")))]
    Interrupted {
        /// Model runs finished.
        done: u64,
        /// Model runs in total, if it is known.
        total: Option<u64>,
    },
    /// A part of the run has no valid design.
    #[error("cannot make a design for a trial run or a cheaper model: {0}")]
    Design(DesignError),
    /// The model cannot continue.
    #[error("the model cannot continue: {0}")]
    GaveUp(GiveUp),
    /// A worker in another process is lost, or sent a malformed reply.
    #[error("worker {worker} in another process was lost: {source}")]
    LostWorker {
        /// Its number among the remote workers, from 0.
        worker: usize,
        /// The cause.
        source: std::io::Error,
    },
    /// The journal cannot be used, or does not fit the run.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A feature that needs a journal was used without one.
    #[error("{what} needs a journal")]
    NoJournal {
        /// The feature.
        what: &'static str,
    },
    /// A run that chooses its size has no shards.
    #[error(
        "a run with an accuracy, a maximum time or a maximum number of runs has no fixed size to divide into shards"
    )]
    NoSize,
    /// Parts of a run are missing.
    #[error("{missing} of {total} runs are missing: {places}")]
    Incomplete {
        /// Runs that are missing.
        missing: u64,
        /// Model runs of the design.
        total: u64,
        /// Which runs they are, in words.
        places: String,
    },
    /// Files of the model changed during the run, or are other ones where a worker is.
    #[error("not the files that the run began with: {files}; undo the change to resume, or start again")]
    OtherFiles {
        /// Their names.
        files: String,
    },
    /// Outputs could not be saved.
    #[error("cannot keep the outputs of finished runs: {source}")]
    NotKept {
        /// The error of the operating system.
        source: std::io::Error,
    },
}
