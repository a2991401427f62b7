//! Errors of a study, with their positions in its file.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use apportion::study::BuildError;
use apportion_base::names::did_you_mean;
use apportion_base::quantity::UnitError;
use thiserror::Error;

/// A study that cannot be read or is invalid.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file cannot be read at all.
    #[error("{path}: cannot read the study file: {source}", path = path.display())]
    Unreadable {
        /// The path as given.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// An override from the command line is invalid.
    #[error("--set {text}: {problem}")]
    Override {
        /// The override as given.
        text: String,
        /// The problem.
        problem: String,
    },
    /// A part of the file is invalid.
    #[error(transparent)]
    Invalid(#[from] Box<Diagnostic>),
}

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
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self::Refused { message: message.into(), help: None }
    }

    pub(super) fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Refused { message: message.into(), help: Some(help.into()) }
    }

    /// Creates the problem of a misplaced key; `right` says where it belongs, or what to write.
    pub(super) fn misplaced(name: &str, right: &str) -> Self {
        Self::new(format!("unknown key `{name}` here: {right}"))
    }

    /// Creates the problem of a missing key that a model needs.
    pub(super) fn missing(what: &str, example: &str) -> Self {
        Self::with_help(format!("the study has no {what}"), format!("write, for instance: {example}"))
    }

    /// Creates the problem of a study without a factor.
    pub(super) fn no_factors() -> Self {
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

/// A [`Problem`] with its position in the file, shown in the style of compilers.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// The file, as given.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The problem.
    pub problem: Problem,
    /// The overrides applied to the text before it was read, if any.
    pub overrides: Vec<String>,
    /// The line, or the part of a long one around the position.
    source_line: String,
    /// The position in it, in characters from 0, and the number of marked characters.
    mark: (usize, usize),
}

impl Diagnostic {
    pub(super) fn new(path: &Path, text: &str, span: Range<usize>, problem: Problem) -> Self {
        let start = text.floor_char_boundary(span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let end = text.floor_char_boundary(span.end).clamp(start, line_end);
        let before = text[line_start..start].chars().count();
        let width = text[start..end].trim_end().chars().count().max(1);
        let line = printable(text[line_start..line_end].trim_end_matches('\r'));
        let from = if line.chars().count() > MAX_LINE { before.saturating_sub(LEAD) } else { 0 };
        let source_line: String = line.chars().skip(from).take(MAX_LINE).collect();
        let place = before - from;
        let mark = (place, width.min(MAX_LINE.saturating_sub(place)).max(1));
        Self {
            path: path.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            column: before + 1,
            problem,
            overrides: Vec::new(),
            source_line,
            mark,
        }
    }

    /// Returns the line of the file, or the part of a long one around the position.
    pub fn source_line(&self) -> &str {
        &self.source_line
    }
}

/// Maximum number of characters of a line that are shown, and the number shown before the position in a longer one.
const MAX_LINE: usize = 160;
const LEAD: usize = 40;

/// Shortens a long message to its beginning and its end.
fn shortened(message: &str) -> Cow<'_, str> {
    const MAX_BYTES: usize = 2000;
    const KEPT_BYTES: usize = 300;
    if message.len() <= MAX_BYTES {
        return message.into();
    }
    let start = message.floor_char_boundary(KEPT_BYTES);
    let end = message.floor_char_boundary(message.len() - KEPT_BYTES);
    format!("{} ... {}", &message[..start], &message[end..]).into()
}

/// Removes characters that would change the terminal from the line.
fn printable(line: &str) -> String {
    line.chars().map(|c| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

impl std::error::Error for Diagnostic {}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, column, problem, .. } = self;
        let margin = " ".repeat(line.to_string().len());
        writeln!(f, "{}:{line}:{column}: {}", path.display(), shortened(&problem.to_string()))?;
        writeln!(f, "{margin} |")?;
        writeln!(f, "{line} | {}", self.source_line)?;
        let pad: String =
            self.source_line.chars().take(self.mark.0).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        write!(f, "{margin} | {pad}{}", "^".repeat(self.mark.1))?;
        if let Some(help) = problem.help() {
            write!(f, "\n{margin} = {}", shortened(&help))?;
        }
        for text in &self.overrides {
            write!(f, "\n{margin} = the file was read with --set {text}")?;
        }
        Ok(())
    }
}
