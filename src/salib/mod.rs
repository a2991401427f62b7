//! Indices of outputs at points made by SALib's `sample.sobol` or `sample.saltelli`, by SALib's own formulas.
//!
//! SALib (Herman and Usher 2017, J. Open Source Softw. 2(9), 97; Iwanaga, Usher and Herman 2022) writes the rows of a base
//! point one after another: A, then AB_j for every input, then, with second order, BA_j for every input, then B. AB_j is A
//! with input j from B, BA_j is B with input j from A; with groups, j counts the groups.

mod estimate;
mod layout;
mod problem;
#[cfg(test)]
mod tests;

#[doc(hidden)]
pub use estimate::PairIndex;
pub use estimate::{SalibIndex, SalibIndices, salib_indices};
pub use layout::{LayoutError, SalibLayout};
#[doc(hidden)]
pub use layout::{WrongRow, check_points, recognise};
pub use problem::{ProblemError, SalibProblem};
