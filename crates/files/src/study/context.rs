//! The text of a study file while it is read, and how its faults are reported.

use std::ops::Range;
use std::path::PathBuf;

use apportion::names::Named;
use apportion::study::did_you_mean;
use toml::Value;

use super::at::At;
use super::error::{Diagnostic, Problem, meant};

/// A diagnostic on its way up.
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

    /// What `found` is, or its problem at the place of `typed`.
    pub(super) fn at<T, V, E: Into<Problem>>(&self, typed: &At<V>, found: Result<T, E>) -> Result<T, Fault> {
        found.map_err(|problem| self.fault(typed.span(), problem.into()))
    }

    /// That `key`, which is `typed` otherwise, must be `expected`.
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

/// A key that the table does not have.
pub(super) fn unknown_key<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Problem {
    let hint = did_you_mean(&meant(name, known.clone()));
    let help = format!("keys that can stand here: {}", known.collect::<Vec<_>>().join(", "));
    Problem::with_help(format!("unknown key `{name}`{hint}"), help)
}

/// The choice that a text names, which is a `what`.
pub(super) fn choice<T: Named>(context: &Context<'_>, typed: &At<String>, what: &'static str) -> Result<T, Fault> {
    context.at(typed, named(typed.get_ref(), what))
}

/// The same of a text alone.
pub(super) fn named<T: Named>(text: &str, what: &'static str) -> Result<T, Problem> {
    let found = T::CHOICES.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
    found.ok_or_else(|| unknown_name(what, text, T::CHOICES.iter().map(|(name, _)| *name)))
}

/// The choice of a key that may be left out.
pub(super) fn choice_if_said<T: Named>(
    context: &Context<'_>,
    typed: &Option<At<String>>,
    what: &'static str,
) -> Result<Option<T>, Fault> {
    typed.as_ref().map(|typed| choice(context, typed, what)).transpose()
}

/// A number of TOML, whole or not.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

pub(super) fn wrong(key: &str, expected: &str, found: String) -> Problem {
    Problem::new(format!("`{key}` must be {expected}, not {found}"))
}
