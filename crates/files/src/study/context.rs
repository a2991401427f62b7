//! The text of a study file while it is read, the reports of its errors, and the paths that it names.
//!
//! A study reads and writes nothing outside its folder, by any path or link, unless it says so
//! (`files_outside = true`). Tables of measured values are the exception: they hold only numbers of a column, and are
//! often next to several studies.

use std::cell::RefCell;
use std::fmt::Display;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use apportion_base::files::real_path;
use apportion_base::names::{Named, did_you_mean, nearest};
use toml::Value;

use super::at::At;
use super::error::{Diagnostic, Problem};

/// A boxed diagnostic.
pub(super) type Fault = Box<Diagnostic>;

/// The text being read.
pub(super) struct Context {
    pub path: PathBuf,
    pub text: String,
    /// The tables of measured values read so far.
    pub measured: RefCell<Vec<PathBuf>>,
}

impl Context {
    pub fn new(path: &Path, text: String) -> Self {
        Self { path: path.to_owned(), text, measured: RefCell::default() }
    }

    pub fn fault(&self, span: Range<usize>, problem: Problem) -> Fault {
        Box::new(Diagnostic::new(&self.path, &self.text, span, problem))
    }

    /// Attaches the position of `typed` to the error of `result`.
    pub fn at<T, V, E: Into<Problem>>(&self, typed: &At<V>, result: Result<T, E>) -> Result<T, Fault> {
        result.map_err(|problem| self.fault(typed.span(), problem.into()))
    }

    /// Returns an error: `key`, with the value `typed`, must be `expected`.
    pub fn refuse<T, V>(&self, typed: &At<V>, key: &str, expected: &str, found: impl Display) -> Result<T, Fault> {
        Err(self.fault(typed.span(), wrong(key, expected, found)))
    }
}

pub(super) fn unknown_name<'a>(what: &'static str, name: &str, valid: impl IntoIterator<Item = &'a str>) -> Problem {
    let valid: Vec<&str> = valid.into_iter().collect();
    let nearest = nearest(name, valid.iter().copied());
    Problem::UnknownName {
        what,
        name: name.to_owned(),
        nearest,
        expected: valid.into_iter().map(str::to_owned).collect(),
    }
}

/// Returns the error for a key that the table does not have.
pub(super) fn unknown_key<'a>(name: &str, valid: impl IntoIterator<Item = &'a str>) -> Problem {
    let valid: Vec<&str> = valid.into_iter().collect();
    let hint = did_you_mean(&nearest(name, valid.iter().copied()));
    Problem::with_help(format!("unknown key `{name}`{hint}"), format!("keys allowed here: {}", valid.join(", ")))
}

/// Returns the names of all values of an enum.
pub(super) fn names_of<T: Named>() -> Vec<&'static str> {
    T::CHOICES.iter().map(|(name, _)| *name).collect()
}

/// Parses the choice of a text, which is a `what`.
pub(super) fn choice<T: Named>(context: &Context, typed: &At<String>, what: &'static str) -> Result<T, Fault> {
    context.at(typed, named(typed.get_ref(), what))
}

/// Does the same for a text without a position.
pub(super) fn named<T: Named>(text: &str, what: &'static str) -> Result<T, Problem> {
    let choice = T::CHOICES.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
    choice.ok_or_else(|| unknown_name(what, text, names_of::<T>()))
}

/// Parses the choice of an optional key.
pub(super) fn optional_choice<T: Named>(
    context: &Context,
    typed: &Option<At<String>>,
    what: &'static str,
) -> Result<Option<T>, Fault> {
    typed.as_ref().map(|typed| choice(context, typed, what)).transpose()
}

/// Returns a number of TOML, whole or not.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
}

/// Returns a value as a message shows it.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::Table(_) => "a table".to_owned(),
        other => other.to_string(),
    }
}

pub(super) fn wrong(key: &str, expected: &str, found: impl Display) -> Problem {
    Problem::new(format!("`{key}` must be {expected}, not {found}"))
}

/// How far a path may lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PathScope {
    /// Not out of the study's folder.
    StudyFolder,
    Anywhere,
}

/// Returns the folder of the study, absolute: programs run elsewhere.
pub(super) fn folder(context: &Context) -> PathBuf {
    let folder = context.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    // Without the "." for the current folder.
    absolute.components().collect()
}

/// Resolves the path of a key, relative to the study. It need not exist.
///
/// # Errors
/// [`Problem`] if it is outside `scope`.
pub(super) fn resolve(context: &Context, typed: &At<String>, scope: PathScope) -> Result<PathBuf, Fault> {
    let folder = folder(context);
    let path = folder.join(typed.get_ref());
    let is_inside = || Some(real_path(&path)?.starts_with(folder.canonicalize().ok()?));
    if scope == PathScope::Anywhere || is_inside().unwrap_or(false) {
        return Ok(path);
    }
    Err(outside(context, typed.span(), &path, "outside the study's folder"))
}

/// Refuses the name of a file that a run writes if it is outside the directory of the run.
///
/// # Errors
/// As for [`resolve`].
pub(super) fn refuse_outside_of_run(
    context: &Context,
    span: Range<usize>,
    file: &str,
    scope: PathScope,
) -> Result<(), Fault> {
    let mut parts = Path::new(file).components();
    if scope == PathScope::Anywhere || parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Ok(());
    }
    Err(outside(context, span, Path::new(file), "outside the directory of a run"))
}

fn outside(context: &Context, span: Range<usize>, path: &Path, place: &str) -> Fault {
    let help = "name one inside, or add files_outside = true to [command]";
    context.fault(span, Problem::with_help(format!("{}: the path leads {place}", path.display()), help))
}
