//! What can be wrong with a study, and where in its file.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::design::DesignError;
use crate::model::{ExpressionError, ParameterError};
use crate::quantity::UnitError;
use crate::space::DistributionError;

/// A study that cannot be read or makes no sense.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file cannot be read at all.
    #[error("{path}: cannot read the study file: {source}", path = path.display())]
    Unreadable {
        /// The path as given.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// An override from the command line makes no sense.
    #[error("--set {text}: {problem}")]
    Override {
        /// The override as given.
        text: String,
        /// What is wrong with it.
        problem: OverrideProblem,
    },
    /// A place in the file is wrong.
    #[error(transparent)]
    Invalid(#[from] Box<Diagnostic>),
}

/// What is wrong with an override `KEY=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OverrideProblem {
    /// There is no `=`.
    #[error("expected KEY=VALUE, as in afm.friction=hk or factor.length.max=500")]
    NoEquals,
    /// A part of the key is empty.
    #[error("the key `{0}` has an empty part: expected names joined by dots, as in afm.friction")]
    EmptyKey(String),
    /// The key has more parts than any that a study has.
    #[error("the key has {0} parts, more than any key of a study: expected names joined by dots, as in afm.friction")]
    TooDeep(usize),
    /// `factor.NAME` names no factor of the file.
    #[error("the study has no factor `{name}`{}", suggestion(.nearest))]
    NoFactor {
        /// The name given.
        name: String,
        /// The nearest factor of the file.
        nearest: Option<String>,
    },
    /// The key leads through something that is not a table.
    #[error("`{0}` is not a table of the study, so nothing can be set inside it")]
    NotATable(String),
    /// The file can be read, but not changed.
    #[error("the study cannot be changed, because it holds a whole number beyond 2^63 - 1, which is not TOML")]
    NotEditable,
}

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

fn suggestion(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

impl Problem {
    /// What would be right, where the message does not say it yet.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::UnknownKey { expected, .. } => Some(format!("keys that can stand here: {}", expected.join(", "))),
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
            Self::NoOutputs => Some("name at least one output, or leave `outputs` out".to_owned()),
            Self::MissingParameter { takes, .. } | Self::ForeignParameter { takes, .. } => {
                Some(format!("it takes {takes}"))
            }
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

/// A [`Problem`] with its place in the file, shown as compilers show theirs.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// The file, as given.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong.
    pub problem: Problem,
    /// The overrides applied to the text before it was read, if any.
    pub overrides: Vec<String>,
    source_line: String,
    width: usize,
}

impl Diagnostic {
    pub(super) fn new(path: &Path, text: &str, span: Range<usize>, problem: Problem) -> Self {
        let start = floor_char_boundary(text, span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let end = floor_char_boundary(text, span.end).clamp(start, line_end);
        Self {
            path: path.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            problem,
            overrides: Vec::new(),
            source_line: printable(text[line_start..line_end].trim_end_matches('\r')),
            width: text[start..end].trim_end().chars().count().max(1),
        }
    }
}

/// The line without characters that would change the terminal.
fn printable(line: &str) -> String {
    line.chars().map(|c| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

fn floor_char_boundary(text: &str, place: usize) -> usize {
    (0..=place.min(text.len())).rev().find(|&p| text.is_char_boundary(p)).unwrap_or(0)
}

impl std::error::Error for Diagnostic {}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, column, problem, .. } = self;
        let margin = " ".repeat(line.to_string().len());
        writeln!(f, "{}:{line}:{column}: {problem}", path.display())?;
        writeln!(f, "{margin} |")?;
        writeln!(f, "{line} | {}", self.source_line)?;
        let pad: String =
            self.source_line.chars().take(column - 1).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        write!(f, "{margin} | {pad}{}", "^".repeat(self.width))?;
        if let Some(help) = problem.help() {
            write!(f, "\n{margin} = {help}")?;
        }
        for text in &self.overrides {
            write!(f, "\n{margin} = the file was read with --set {text}")?;
        }
        Ok(())
    }
}

/// The name in `known` nearest to `name`, if one is near enough to be meant. Names of more than 100 characters, whose
/// comparison would take long, are near to none.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    const LONGEST: usize = 100;
    let is_long = |name: &str| name.chars().nth(LONGEST).is_some();
    if is_long(name) {
        return None;
    }
    let name = name.to_lowercase();
    known
        .into_iter()
        .filter(|candidate| !is_long(candidate))
        .map(|candidate| (strsim::damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().div_ceil(3).max(1))
        .map(|(_, candidate)| candidate.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_shown_with_its_line_and_a_caret() {
        let text = "a = 1\nµ = 'x'\n";
        let start = text.find("'x'").unwrap_or(0);
        let diagnostic = Diagnostic::new(Path::new("s.toml"), text, start..start + 3, Problem::Syntax("no".to_owned()));
        assert_eq!(diagnostic.to_string(), "s.toml:2:5: no\n  |\n2 | µ = 'x'\n  |     ^^^");
    }

    #[test]
    fn spans_at_or_past_the_end_are_harmless() {
        for (text, span) in [("", 0..0), ("", 5..9), ("a =", 3..3), ("é", 1..2), ("a\r\nb", 0..4)] {
            let shown = Diagnostic::new(Path::new("s"), text, span, Problem::NoFactors).to_string();
            assert!(shown.starts_with("s:1:"), "{shown}");
        }
    }

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        let known = ["length", "width", "thickness", "height"];
        assert_eq!(nearest("lenght", known).as_deref(), Some("length"));
        assert_eq!(nearest("Width", known).as_deref(), Some("width"));
        assert_eq!(nearest("temperature", known), None);
        // Names of 50,000 letters once took half a minute.
        let long = "x".repeat(50_000);
        assert_eq!(nearest(&long[1..], [long.as_str(), "width"]), None);
        assert_eq!(nearest("widht", [long.as_str(), "width"]).as_deref(), Some("width"));
    }
}
