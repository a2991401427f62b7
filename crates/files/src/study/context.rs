//! The text of a study file while it is read, and the reports of its errors.

use std::ops::Range;
use std::path::PathBuf;

use apportion::names::Named;
use apportion::study::did_you_mean;
use toml::Value;

use super::at::At;
use super::error::{Diagnostic, Problem};
use super::synonyms::meant;

/// A boxed diagnostic.
pub(super) type Fault = Box<Diagnostic>;

/// The text being read.
pub(super) struct Context<'a> {
    pub path: PathBuf,
    pub text: &'a str,
}

impl Context<'_> {
    pub(super) fn fault(&self, span: Range<usize>, problem: Problem) -> Fault {
        Box::new(Diagnostic::new(&self.path, self.text, span, problem))
    }

    /// Attaches the position of `typed` to the error of `found`.
    pub(super) fn at<T, V, E: Into<Problem>>(&self, typed: &At<V>, found: Result<T, E>) -> Result<T, Fault> {
        found.map_err(|problem| self.fault(typed.span(), problem.into()))
    }

    /// Returns an error: `key`, with the value `typed`, must be `expected`.
    pub(super) fn refuse<T, V>(&self, typed: &At<V>, key: &str, expected: &str, found: String) -> Result<T, Fault> {
        Err(self.fault(typed.span(), wrong(key, expected, found)))
    }
}

pub(super) fn unknown_name<'a>(
    what: &'static str,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> Problem {
    Problem::UnknownName {
        what,
        name: name.to_owned(),
        nearest: meant(name, known.clone()),
        expected: known.map(str::to_owned).collect(),
    }
}

/// Returns the error for a key that the table does not have.
pub(super) fn unknown_key<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Problem {
    let hint = did_you_mean(&meant(name, known.clone()));
    let help = format!("keys allowed here: {}", known.collect::<Vec<_>>().join(", "));
    Problem::with_help(format!("unknown key `{name}`{hint}"), help)
}

/// Parses the choice of a text, which is a `what`.
pub(super) fn choice<T: Named>(context: &Context<'_>, typed: &At<String>, what: &'static str) -> Result<T, Fault> {
    context.at(typed, named(typed.get_ref(), what))
}

/// Does the same for a text without a position.
pub(super) fn named<T: Named>(text: &str, what: &'static str) -> Result<T, Problem> {
    let found = T::CHOICES.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
    found.ok_or_else(|| unknown_name(what, text, T::CHOICES.iter().map(|(name, _)| *name)))
}

/// Parses the choice of an optional key.
pub(super) fn choice_if_said<T: Named>(
    context: &Context<'_>,
    typed: &Option<At<String>>,
    what: &'static str,
) -> Result<Option<T>, Fault> {
    typed.as_ref().map(|typed| choice(context, typed, what)).transpose()
}

/// Returns a number of TOML, whole or not.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Returns a value as a message shows it.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::Table(_) => "a table".to_owned(),
        other => other.to_string(),
    }
}

pub(super) fn wrong(key: &str, expected: &str, found: String) -> Problem {
    Problem::new(format!("`{key}` must be {expected}, not {found}"))
}
