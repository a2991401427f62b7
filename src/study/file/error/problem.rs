//! What is wrong at a place of a study file, and what would be right.

use thiserror::Error;

use crate::model::{ExpressionError, ParameterError};
use crate::quantity::UnitError;
use crate::space::DistributionError;
use crate::study::BuildError;
use crate::study::did_you_mean;

/// What is wrong at a place of a study file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// The file is not TOML, or a value has the wrong type.
    #[error("{0}")]
    Syntax(String),
    /// A key that the study format does not have.
    #[error("unknown key `{name}`{}", did_you_mean(.nearest))]
    UnknownKey {
        /// The key as typed.
        name: String,
        /// The nearest known key.
        nearest: Option<String>,
        /// All keys that could stand here.
        expected: Vec<String>,
    },
    /// A key that stands in the wrong place.
    #[error("unknown key `{name}` here: {right}")]
    Misplaced {
        /// The key as typed.
        name: String,
        /// Where it belongs, or what to write.
        right: String,
    },
    /// A form of former versions.
    #[error("{form}: factors and outputs are written in another way today")]
    OldForm {
        /// What was written.
        form: String,
        /// The lines that say the same.
        lines: String,
    },
    /// A file that is called a model.
    #[error("unknown model `{0}`: a program of your own is a `command`")]
    ModelFile(String),
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
    /// A constant that is also a factor.
    #[error("`{0}` is a factor of this study, so it cannot be fixed in [afm]")]
    FixedFactor(String),
    /// The study has no factor.
    #[error("the study has no factor: there is nothing to vary")]
    NoFactors,
    /// Something that a model needs, and that is not there.
    #[error("the study has no {what}")]
    Missing {
        /// What is missing.
        what: &'static str,
        /// What to write.
        example: &'static str,
    },
    /// A file or folder that cannot be used.
    #[error("{place}: {reason}")]
    File {
        /// The file, with line and column where there are some.
        place: String,
        /// What is wrong.
        reason: String,
        /// What would be right.
        help: String,
    },
    /// A formula that cannot be read.
    #[error("{source}{}", did_you_mean(.nearest))]
    Expression {
        /// What is wrong.
        source: ExpressionError,
        /// The nearest known name.
        nearest: Option<String>,
        /// All names that could stand here; empty where no name is wrong.
        expected: String,
    },
    /// The distribution's parameters make no sense.
    #[error("factor `{factor}`: {source}")]
    Distribution {
        /// The factor's name.
        factor: String,
        /// What is wrong.
        source: DistributionError,
    },
    /// A nominal value that the distribution does not have.
    #[error("factor `{factor}`: its nominal value is {found}, which is not one of its values")]
    NotAValue {
        /// The factor's name.
        factor: String,
        /// The nominal value.
        found: String,
        /// The values.
        values: String,
    },
    /// A text that is no unit or quantity.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// A physical quantity without its unit.
    #[error("{name} is {dimension} and needs a unit")]
    MissingUnit {
        /// The factor or constant.
        name: String,
        /// Its dimension in words.
        dimension: String,
        /// What to write, such as `unit = "um"`.
        example: String,
    },
    /// A unit of the wrong kind.
    #[error("{name} is {expected}, but `{unit}` measures {found}")]
    WrongUnit {
        /// The factor or constant.
        name: String,
        /// Its dimension in words.
        expected: String,
        /// The unit as typed.
        unit: String,
        /// The unit's dimension in words.
        found: String,
        /// What to write.
        example: String,
    },
    /// A value or range outside what is physically possible.
    #[error("{name} must be {domain}, but {found}")]
    OutOfDomain {
        /// The factor or constant.
        name: String,
        /// The domain, such as "> 0", in SI units.
        domain: String,
        /// What was found.
        found: String,
    },
    /// A value of the wrong type.
    #[error("`{key}` must be {expected}, not {found}")]
    WrongType {
        /// The key.
        key: String,
        /// What it should be.
        expected: String,
        /// What it is.
        found: String,
    },
    /// A unit beside a distribution that is not stated.
    #[error("factor `{factor}` has the function's own distribution here, which is not in `{unit}`")]
    UnitOfOwn {
        /// The factor's name.
        factor: String,
        /// The unit as typed.
        unit: String,
    },
    /// A parameter of a function that makes no sense.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A rule that every study obeys.
    #[error(transparent)]
    Build(#[from] BuildError),
}

impl Problem {
    /// What would be right, where the message does not say it yet.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::UnknownKey { expected, .. } => format!("keys that can stand here: {}", expected.join(", ")),
            Self::OldForm { lines, .. } => format!("write\n{lines}"),
            Self::ModelFile(file) => format!("write model = \"command\" and command = [{}]", program(file)),
            Self::UnknownName { expected, .. } => format!("known: {}", expected.join(", ")),
            Self::FixedFactor(name) => format!("remove `{name}` here, or from the factors"),
            Self::NoFactors => "add a table [factors] with a line for each, as in x1 = { min = 0, max = 1 }".to_owned(),
            Self::Missing { example, .. } => format!("write, for instance: {example}"),
            Self::Expression { expected, .. } if expected.is_empty() => return None,
            Self::Expression { expected, .. } => expected.clone(),
            Self::File { help, .. } => help.clone(),
            Self::Distribution { source, .. } => return source.help(),
            Self::NotAValue { values, .. } => format!("it takes {values}"),
            Self::UnitOfOwn { .. } => "remove the unit, or give the distribution too".to_owned(),
            Self::MissingUnit { example, .. } | Self::WrongUnit { example, .. } => format!("write {example}"),
            _ => return None,
        })
    }
}

/// A program file as the list that starts it.
fn program(file: &str) -> String {
    let ending = file.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase();
    let interpreter = match ending.as_str() {
        "py" => "\"python3\", ",
        "r" => "\"Rscript\", ",
        "jl" => "\"julia\", ",
        "sh" => "\"bash\", ",
        _ => "",
    };
    // What was typed as a line of a shell is a list of words here.
    let words: Vec<String> = file.split_whitespace().map(|word| format!("{word:?}")).collect();
    let interpreter = if words.len() > 1 { "" } else { interpreter };
    format!("{interpreter}{}", words.join(", "))
}
