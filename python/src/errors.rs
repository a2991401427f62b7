//! What Python gets to see of errors.

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
    match error {
        apportion::RunError::Interrupted { .. } => PyKeyboardInterrupt::new_err(error.to_string()),
        apportion::RunError::Refused { .. } => input(error),
        _ => RunError::new_err(error.to_string()),
    }
}

/// Something else that failed.
pub fn failed(error: impl std::fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}
