//! Errors in a study.

use thiserror::Error;

use crate::design::DesignError;
use crate::space::{DependenceError, DistributionError};

/// Why a study cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// A value that an option cannot have, or not with another option.
    #[error("`{key}` must be {expected}, not {found}")]
    Wrong {
        /// The option's key in study files.
        key: &'static str,
        /// What is allowed.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A name that is too long for tables and files, or contains invisible characters.
    #[error("{what} {}: expected {expected}", apportion_base::names::shown(.name))]
    Name {
        /// What the name is of.
        what: &'static str,
        /// The name.
        name: String,
        /// What is allowed.
        expected: String,
    },
    /// A duplicate name.
    #[error("{what} `{name}` is listed twice")]
    Repeated {
        /// What the name is of.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A factor cannot be converted to SI units.
    #[error("factor `{factor}`: {source}")]
    Factor {
        /// Its name.
        factor: String,
        /// The cause.
        source: DistributionError,
    },
    /// The design is invalid.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// Factors cannot depend on each other as stated.
    #[error(transparent)]
    Dependence(#[from] DependenceError),
    /// A low-fidelity model cannot be used.
    #[error("cheaper model `{name}`: {problem}")]
    LowFidelity {
        /// Its name.
        name: String,
        /// What is wrong, and what is allowed.
        problem: String,
    },
}
