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
    /// The model has no outputs.
    #[error("the model has no outputs")]
    NoOutputs,
    /// A series of outputs that are not there, or that belong to another one.
    #[error(
        "series `{name}` has outputs {first} to {last}, counted from 0: expected some of the model's {outputs}, of no other series"
    )]
    Series {
        /// Its name.
        name: String,
        /// Place of its first value.
        first: usize,
        /// Place of its last value.
        last: usize,
        /// Outputs of the model.
        outputs: usize,
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
    /// A model of other outputs than those of the study that it is put into.
    #[error("the outputs of the model are {found}, and must be those of the study: {expected}")]
    OtherOutputs {
        /// Those of the model, with their units.
        found: String,
        /// Those of the study.
        expected: String,
    },
}
