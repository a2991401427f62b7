//! Problems at a position of a study file, and what is expected.

use apportion::quantity::UnitError;
use apportion::study::{BuildError, did_you_mean};
use thiserror::Error;

/// A problem at a position of a study file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// An unknown name.
    #[error("unknown {what} `{name}`{}", did_you_mean(.nearest))]
    UnknownName {
        /// The kind of name, such as "factor".
        what: &'static str,
        /// The name as typed.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
        /// All names that are valid here.
        expected: Vec<String>,
    },
    /// A repeated name.
    #[error("{what} `{name}` is listed twice")]
    Repeated {
        /// The kind of name.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A rule of every study.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Any other problem.
    #[error("{message}")]
    Refused {
        /// The problem.
        message: String,
        /// What is expected, if the message does not say it.
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

    /// Creates the problem of a misplaced key; `right` says where it belongs, or what to write.
    pub(in crate::study) fn misplaced(name: &str, right: &str) -> Self {
        Self::new(format!("unknown key `{name}` here: {right}"))
    }

    /// Creates the problem of a missing key that a model needs.
    pub(in crate::study) fn missing(what: &str, example: &str) -> Self {
        Self::with_help(format!("the study has no {what}"), format!("write, for instance: {example}"))
    }

    /// Creates the problem of a study without a factor.
    pub(in crate::study) fn no_factors() -> Self {
        let help = "add a table [factors] with a line for each, as in x1 = { min = 0, max = 1 }";
        Self::with_help("the study has no factors", help)
    }

    /// Returns what is expected, if the message does not say it.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::UnknownName { expected, .. } => Some(format!("known: {}", expected.join(", "))),
            Self::Refused { help, .. } => help.clone(),
            Self::Repeated { .. } | Self::Build(_) => None,
        }
    }
}
