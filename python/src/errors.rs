//! What Python gets to see of errors.

use apportion::run::journal::{JournalError, JournalProblem};
use apportion_files::StudyError as StudyFileError;
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

/// An invalid study. The attribute `problem` is its message without a position, for a text made of keyword arguments.
pub fn study(py: Python<'_>, error: &StudyFileError) -> PyErr {
    let problem = match error {
        StudyFileError::Invalid(diagnostic) => {
            let message = diagnostic.problem.to_string();
            let mut problem = message.lines().next().unwrap_or_default().to_owned();
            if problem.starts_with("invalid ") {
                problem = format!("{}: {problem}", diagnostic.source_line().trim());
            }
            [Some(problem), diagnostic.problem.help()].into_iter().flatten().collect::<Vec<_>>().join("; ")
        }
        other => other.to_string(),
    };
    let error = input(error);
    match error.value(py).setattr("problem", problem) {
        Ok(()) => error,
        Err(failed) => failed,
    }
}

/// A run that failed.
pub fn run(error: &apportion::RunError) -> PyErr {
    use apportion::RunError as Error;
    let remedy = match error {
        Error::TooManyOutputs { .. } => {
            ": use fewer base_samples or outputs, intervals=\"batches\", or start again with resume=\"never\""
        }
        Error::Journal(JournalError { problem: JournalProblem::OtherModel(_), .. }) => {
            ": its runs are from the earlier version. Undo the change, or start again with resume=\"never\""
        }
        Error::NoJournal { .. } => ": name a file with journal=",
        _ => "",
    };
    let message = format!("{error}{remedy}");
    match error {
        Error::Interrupted { .. } => PyKeyboardInterrupt::new_err(message),
        Error::Journal(JournalError { problem, .. }) if problem.is_bad_input() => input(message),
        _ => RunError::new_err(message),
    }
}

/// Something else that failed.
pub fn failed(error: impl std::fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}
