//! Why a run ends without its totals.

use std::path::PathBuf;

use thiserror::Error;

use super::journal::JournalError;
use super::{MAX_STORED_BYTES, Place};
use crate::design::DesignError;
use crate::model::{GiveUp, RowFailure};

/// Why a run could not take place, or was given up.
#[derive(Debug, Error)]
pub enum RunError {
    /// The operating system refused the threads.
    #[error("cannot start {threads} threads: {source}")]
    Threads {
        /// The number asked for.
        threads: usize,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A row failed, and the run was to stop at the first one.
    #[error("a run failed, and the study says to stop then: {reason}")]
    RowFailed {
        /// The row.
        row: Place,
        /// Why.
        reason: RowFailure,
    },
    /// The outputs of all runs were to be kept, and are too many.
    #[error(
        "the outputs of {runs} runs, which are to be kept all at once, take {bytes} bytes of memory, more than the \
         {MAX_STORED_BYTES} that they may: take fewer base samples or fewer outputs, intervals = \"batches\", or begin anew without \
         saved outputs (--restart)"
    )]
    TooManyOutputs {
        /// Model runs.
        runs: u64,
        /// Bytes that their outputs take.
        bytes: u64,
    },
    /// The run was asked to end.
    #[error("interrupted after {done} of {total} runs")]
    Interrupted {
        /// Model runs finished.
        done: u64,
        /// Model runs there would have been.
        total: u64,
    },
    /// There is no design for a part of the run.
    #[error("a trial run, or that of a cheaper model, has no design: {0}")]
    Design(DesignError),
    /// The model cannot go on.
    #[error("the model cannot go on: {0}")]
    GaveUp(GiveUp),
    /// A worker in another process does not answer any more, or answers nonsense.
    #[error("the worker number {worker} in another process is lost: {source}")]
    LostWorker {
        /// Its number among the workers in other processes, from 0.
        worker: usize,
        /// Why.
        source: std::io::Error,
    },
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// What is on record, or was asked of it, does not fit the study.
    #[error("{}: {reason}", .path.display())]
    Refused {
        /// The journal.
        path: PathBuf,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// What needs a journal has none.
    #[error("{what} needs a journal: name one by Runner::journal")]
    NoJournal {
        /// What needs it.
        what: &'static str,
    },
    /// A run that decides its own size has no parts.
    #[error("a study with an accuracy, a target, a budget or max_runs has no size that could be shared out beforehand")]
    NoSize,
    /// The parts of a run are not all there.
    #[error("{missing} of {total} runs are missing: {places}")]
    Incomplete {
        /// Runs that are missing.
        missing: u64,
        /// Runs of the whole design.
        total: u64,
        /// Which they are, in words.
        places: String,
    },
    /// Outputs could not be kept.
    #[error("cannot keep the outputs of finished runs: {source}")]
    NotKept {
        /// What the operating system said.
        source: std::io::Error,
    },
}
