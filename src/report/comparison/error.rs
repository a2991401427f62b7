//! Why two results cannot be compared.

use thiserror::Error;

/// Why two results cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CompareError {
    /// They have no output, or no factor, in common.
    #[error("there is nothing to compare, the results have no {what} in common: A has {a}, B has {b}")]
    NothingInCommon {
        /// `output` or `factor`.
        what: &'static str,
        /// Those of A.
        a: String,
        /// Those of B.
        b: String,
    },
    /// An output of one name is a quantity of two kinds.
    #[error("the output `{output}` is not the same quantity: in {a} in A, in {b} in B")]
    OtherQuantity {
        /// The output.
        output: String,
        /// Its unit in A.
        a: String,
        /// Its unit in B.
        b: String,
    },
}
