//! Indices of outputs at points made by SALib's `sample.sobol` or `sample.saltelli`, by SALib's formulas.
//!
//! SALib (Herman and Usher 2017, J. Open Source Softw. 2(9), 97; Iwanaga, Usher and Herman 2022) writes the rows of a base
//! point one after another: A, then AB_j for every input, then, with second order, BA_j for every input, then B. AB_j is A
//! with input j from B, BA_j is B with input j from A; with groups, j counts the groups.

mod layout;
mod problem;
mod study;
#[cfg(test)]
mod tests;

pub use layout::SalibLayout;
pub use problem::SalibProblem;
pub use study::salib_study;
use thiserror::Error;

/// Why a table or a description is not SALib's, and what is allowed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SalibError {
    /// The table or the description is invalid.
    #[error("{0}")]
    Invalid(String),
    /// The number of rows fits both layouts: one must be chosen.
    #[error("{rows} rows can be read in two ways: {}", SalibLayout::ALL.map(|layout| layout.points(*rows, *members)).join(" or "))]
    Ambiguous {
        /// The number of rows.
        rows: usize,
        /// The number of inputs or groups.
        members: usize,
    },
}
