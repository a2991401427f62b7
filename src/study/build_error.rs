//! What can be wrong with a study.

use thiserror::Error;

use crate::design::DesignError;
use crate::space::{DependenceError, DistributionError};

/// Why a study cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// A value that an option cannot have, or not beside another one.
    #[error("`{key}` must be {expected}, not {found}")]
    Wrong {
        /// The option, as it is called in study files.
        key: &'static str,
        /// What would be right.
        expected: String,
        /// What was found.
        found: String,
    },
    /// A name that no table or file has room for, or with marks in it that are not seen.
    #[error("{what} {}: expected {expected}", crate::names::shown(.name))]
    Name {
        /// What it is of.
        what: &'static str,
        /// The name.
        name: String,
        /// What would be right.
        expected: String,
    },
    /// A name twice.
    #[error("{what} `{name}` is there twice")]
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
        /// Why.
        source: DistributionError,
    },
    /// There is no such design.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// Factors that cannot depend on each other as stated.
    #[error(transparent)]
    Dependence(#[from] DependenceError),
    /// A cheaper model that cannot stand in.
    #[error("cheaper model `{name}`: {problem}")]
    LowFidelity {
        /// Its name.
        name: String,
        /// What is wrong, and what would be right.
        problem: String,
    },
}
