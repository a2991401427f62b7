//! What Python gets to see of errors.

use apportion::run::journal::JournalMismatch;
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    apportion,
    StudyError,
    PyValueError,
    "An argument is invalid: the message says which, and what is expected."
);
create_exception!(apportion, RunError, PyRuntimeError, "The run could not be completed.");

/// Wrong input.
pub fn input(error: impl std::fmt::Display) -> PyErr {
    StudyError::new_err(error.to_string())
}

/// A run that failed.
pub fn run(error: &apportion::RunError) -> PyErr {
    use apportion::RunError as Error;
    let remedy = match error {
        Error::TooManyOutputs { .. } => {
            ": use fewer base_samples or outputs, intervals=\"batches\", or start again with resume=\"never\""
        }
        Error::JournalMismatch { kind: JournalMismatch::OtherModel(_), .. } => {
            ": its runs are from the earlier version. Undo the change, or start again with resume=\"never\""
        }
        Error::NoJournal { .. } => ": name a file with journal=",
        _ => "",
    };
    let message = format!("{error}{remedy}");
    match error {
        Error::Interrupted { .. } => PyKeyboardInterrupt::new_err(message),
        Error::JournalMismatch { .. } => input(message),
        _ => RunError::new_err(message),
    }
}

/// Something else that failed.
pub fn failed(error: impl std::fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}
