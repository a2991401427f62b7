//! What is wrong at a place of a study file, and what would be right.

use thiserror::Error;

use super::synonyms::suggestion;
use crate::design::DesignError;
use crate::model::{ExpressionError, ParameterError};
use crate::quantity::UnitError;
use crate::space::{DependenceError, DistributionError};

/// What is wrong at a place of a study file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Problem {
    /// The file is not TOML, or a value has the wrong type.
    #[error("{0}")]
    Syntax(String),
    /// A key that the study format does not have.
    #[error("unknown key `{name}`{}", suggestion(.nearest))]
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
    /// The same thing written in two ways at once.
    #[error("the {what} stand both in `{one}` and in `{other}`: keep one of the two")]
    TwoForms {
        /// What is written twice.
        what: &'static str,
        /// One form.
        one: &'static str,
        /// The other one.
        other: &'static str,
    },
    /// A file that is called a model.
    #[error("unknown model `{0}`: a program of your own is a `command`")]
    ModelFile(String),
    /// A name that stands for nothing.
    #[error("unknown {what} `{name}`{}", suggestion(.nearest))]
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
    /// A kind of interval that would be dishonest for the sampler.
    #[error("intervals = \"{method}\" do not hold for points of the sampler `{sampler}`")]
    UnfitInterval {
        /// The kind asked for.
        method: &'static str,
        /// The sampler.
        sampler: &'static str,
        /// The kinds that hold.
        serving: String,
    },
    /// A growing run of points that cannot be added to.
    #[error("a Latin hypercube cannot grow: more points make another hypercube")]
    CannotGrow,
    /// The study has no factor.
    #[error("the study has no factor: there is nothing to vary")]
    NoFactors,
    /// Formulas are the model, and there are none.
    #[error("the study has no formula: model = \"expression\" needs a table [expression] with an output")]
    NoFormulas,
    /// The model runs outside, and nobody says what it computes.
    #[error("the study has no output: model = \"external\" needs a table [external] with the outputs and their units")]
    NoExternalOutputs,
    /// A program is the model, and is not named.
    #[error("the study has no program: model = \"command\" needs one")]
    NoProgram,
    /// A program is the model, and nobody says what its outputs are.
    #[error("the study does not say what the program's outputs are")]
    NoProgramOutputs,
    /// A file that a program's runs need, and that cannot be used.
    #[error("{place}: {reason}")]
    ProgramFile {
        /// The file, with line and column where there are some.
        place: String,
        /// What is wrong.
        reason: String,
        /// What would be right.
        help: String,
    },
    /// A formula that cannot be read.
    #[error("{source}{}", suggestion(.nearest))]
    Expression {
        /// What is wrong.
        source: ExpressionError,
        /// The nearest known name.
        nearest: Option<String>,
        /// All names that could stand here; empty where no name is wrong.
        expected: String,
    },
    /// An output in the list that the table of a program's outputs lacks.
    #[error(
        "unknown output `{name}`: the table of outputs in [command] takes the place of this list, and has {known} alone"
    )]
    NotInTable {
        /// The output.
        name: String,
        /// The outputs of the table.
        known: String,
    },
    /// The list of outputs is empty.
    #[error("`outputs` is empty: there is nothing to study")]
    NoOutputs,
    /// A parameter that the distribution needs is missing.
    #[error("factor `{factor}`: the {distribution} distribution needs `{parameter}`")]
    MissingParameter {
        /// The factor's name.
        factor: String,
        /// The distribution's name.
        distribution: &'static str,
        /// The missing key.
        parameter: &'static str,
        /// The keys it takes, in words.
        takes: &'static str,
    },
    /// A parameter that the distribution does not have.
    #[error("factor `{factor}`: the {distribution} distribution has no `{parameter}`")]
    ForeignParameter {
        /// The factor's name.
        factor: String,
        /// The distribution's name.
        distribution: &'static str,
        /// The key that does not belong.
        parameter: &'static str,
        /// The keys it takes, in words.
        takes: &'static str,
    },
    /// The distribution's parameters make no sense.
    #[error("factor `{factor}`: {source}")]
    Distribution {
        /// The factor's name.
        factor: String,
        /// What is wrong.
        source: DistributionError,
    },
    /// A parameter that is another factor.
    #[error(
        "factor `{factor}`: `{key}` is the factor `{other}`, and the two would depend on each other: first-order and total \
         indices share out the variance among independent factors"
    )]
    DependsOnFactor {
        /// The factor's name.
        factor: String,
        /// The key.
        key: String,
        /// The other factor.
        other: String,
    },
    /// Factors that cannot depend on each other as stated.
    #[error(transparent)]
    Dependence(DependenceError),
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
    /// A file of measured values that cannot be read.
    #[error("{place}: {reason}")]
    Measured {
        /// The file, with the line where there is one.
        place: String,
        /// What is wrong.
        reason: String,
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
    /// The design cannot be made.
    #[error(transparent)]
    Design(#[from] DesignError),
}

impl Problem {
    /// What would be right, where the message does not say it yet.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::UnknownKey { expected, .. } => Some(format!("keys that can stand here: {}", expected.join(", "))),
            Self::ModelFile(file) => Some(format!("write model = \"command\" and command = [{}]", program(file))),
            Self::UnknownName { expected, .. } => Some(format!("known: {}", expected.join(", "))),
            Self::FixedFactor(name) => Some(format!("remove `{name}` here, or remove its [[factor]]")),
            Self::UnfitInterval { serving, .. } => Some(format!("these do: {serving}")),
            Self::CannotGrow => Some("sampler = \"sobol\" and \"random\" can grow".to_owned()),
            Self::NoFactors => Some("add one or more [[factor]] tables with name, min, max and unit".to_owned()),
            Self::NoExternalOutputs => Some("write, for instance: [external], then outputs.force = \"nN\"".to_owned()),
            Self::NoFormulas => Some("write, for instance: [expression], then outputs.y = \"x1 + 2*x2\"".to_owned()),
            Self::Expression { expected, .. } => Some(expected.clone()).filter(|known| !known.is_empty()),
            Self::NoProgram => Some("write, for instance: command = [\"python3\", \"my_model.py\"]".to_owned()),
            Self::NoProgramOutputs => Some(
                "write, for instance: outputs = [\"y\"]; or in the table [command], with a unit: outputs.y = \"nN\""
                    .to_owned(),
            ),
            Self::ProgramFile { help, .. } => Some(help.clone()),
            Self::NotInTable { name, .. } => Some(format!(
                "give every output that the program prints a line in that table, in its order: outputs.{name} = \"1\", or its unit"
            )),
            Self::NoOutputs => Some("name at least one output, or leave `outputs` out".to_owned()),
            Self::MissingParameter { takes, .. } | Self::ForeignParameter { takes, .. } => {
                Some(format!("it takes {takes}"))
            }
            Self::DependsOnFactor { factor, other, .. } => Some(format!(
                "let a ratio or a difference vary instead, as a factor of its own: `{factor}_part` from 0 to 1, and in the \
                 model {factor} = {factor}_part*{other}"
            )),
            Self::NotAValue { values, .. } => Some(format!("it takes {values}")),
            Self::Measured { .. } => {
                Some("the file is a table in CSV, or one number a line; its path is relative to the study".to_owned())
            }
            Self::UnitOfOwn { .. } => Some("remove the unit, or give the distribution too".to_owned()),
            Self::MissingUnit { example, .. } | Self::WrongUnit { example, .. } => Some(format!("write {example}")),
            _ => None,
        }
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
