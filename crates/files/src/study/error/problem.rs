//! What is wrong at a place of a study file, and what would be right.

use apportion::quantity::UnitError;
use apportion::study::{BuildError, did_you_mean};
use thiserror::Error;

/// What is wrong at a place of a study file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// A name that stands for nothing.
    #[error("unknown {what} `{name}`{}", did_you_mean(.nearest))]
    UnknownName {
        /// What the name should be of, such as "factor".
        what: &'static str,
        /// The name as typed.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
        /// All names that could stand here.
        expected: Vec<String>,
    },
    /// The same name twice.
    #[error("{what} `{name}` stands here twice")]
    Repeated {
        /// What the name is of.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A rule that every study obeys.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Anything else.
    #[error("{message}")]
    Refused {
        /// What is wrong.
        message: String,
        /// What would be right, where the message does not say it yet.
        help: Option<String>,
    },
}

impl From<UnitError> for Problem {
    fn from(error: UnitError) -> Self {
        Self::new(error.to_string())
    }
}

impl Problem {
    pub(in crate::study) fn new(message: impl Into<String>) -> Self {
        Self::Refused { message: message.into(), help: None }
    }

    pub(in crate::study) fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Refused { message: message.into(), help: Some(help.into()) }
    }

    /// A key that stands in the wrong place; `right` says where it belongs, or what to write.
    pub(in crate::study) fn misplaced(name: &str, right: &str) -> Self {
        Self::new(format!("unknown key `{name}` here: {right}"))
    }

    /// Something that a model needs, and that is not there.
    pub(in crate::study) fn missing(what: &str, example: &str) -> Self {
        Self::with_help(format!("the study has no {what}"), format!("write, for instance: {example}"))
    }

    /// The study has no factor.
    pub(in crate::study) fn no_factors() -> Self {
        let help = "add a table [factors] with a line for each, as in x1 = { min = 0, max = 1 }";
        Self::with_help("the study has no factor: there is nothing to vary", help)
    }

    /// What would be right, where the message does not say it yet.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::UnknownName { expected, .. } => Some(format!("known: {}", expected.join(", "))),
            Self::Refused { help, .. } => help.clone(),
            Self::Repeated { .. } | Self::Build(_) => None,
        }
    }
}
