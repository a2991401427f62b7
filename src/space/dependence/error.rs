//! Why factors cannot depend on each other as stated.

use thiserror::Error;

/// Why factors cannot depend on each other as stated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DependenceError {
    /// A Pearson correlation that the distributions do not allow.
    #[error(
        "`{a}` and `{b}` cannot have a Pearson correlation of {found}: their distributions allow {low:.4} to {high:.4}"
    )]
    Unattainable {
        /// One factor.
        a: String,
        /// The other one.
        b: String,
        /// The correlation that was stated.
        found: f64,
        /// The least correlation of any joint distribution of these two.
        low: f64,
        /// The largest one.
        high: f64,
    },
    /// Anything else, with what would be right.
    #[error("{0}")]
    Refused(String),
}

pub(super) fn refused<T>(reason: impl Into<String>) -> Result<T, DependenceError> {
    Err(DependenceError::Refused(reason.into()))
}
