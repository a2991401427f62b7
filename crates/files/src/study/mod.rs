//! Study files: TOML as typed ([`StudyFile`](sections::StudyFile)), and its meaning. Every error in a file is reported
//! with its line and column.

mod analysis;
mod at;
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "a page starts no programs"))]
mod command;
mod constants;
mod context;
mod dependence;
mod distribution;
mod error;
mod expression;
mod factors;
mod fidelity;
mod key_schemas;
mod measured;
mod models;
mod output_table;
mod outputs;
mod overrides;
mod parse;
mod problem;
mod reading;
mod resolve;
mod schema;
mod sections;
mod subjects;
mod template;
mod units;

use std::path::Path;

use apportion::study::{Study, StudySource};
use apportion_base::digest::sha256;
use apportion_base::files::read_text;
use context::Context;
pub use error::{Diagnostic, Problem, StudyError};
pub use models::model_guide;
pub use problem::problem_factors;
pub use schema::study_schema;
pub use subjects::{ExpressionSubject, Formula};
pub use template::{NEW_PROGRAM, TemplateRequest, new_program, template};

/// Reads a study file, after applying `overrides` of the form `KEY=VALUE`.
///
/// # Errors
/// [`StudyError`] with the place in the file and what is expected.
pub fn load_study(path: &Path, overrides: &[String]) -> Result<Study, StudyError> {
    let text = read_text(path).map_err(|source| StudyError::Unreadable { path: path.to_owned(), source })?;
    parse_study(&text, path, overrides)
}

/// Reads a study from its text; `path` is used in messages, and names the study unless the text does.
///
/// ```
/// use std::path::Path;
/// use apportion::Study;
///
/// let text = r#"
///     model = "ishigami"
///     [[factor]]
///     name = "x1"
///     min = -3.14
///     max = 3.14
/// "#;
/// let study = apportion_files::parse_study(text, Path::new("small.toml"), &["design.base_samples=256".to_owned()])?;
/// assert_eq!(study.name(), "small");
/// // A and B: with one factor, A with its column from B is B, and is not run again.
/// assert_eq!(study.design().rows(), 2 * 256);
/// # Ok::<(), apportion_files::StudyError>(())
/// ```
///
/// # Errors
/// [`StudyError`] with the place in the text and what is expected.
pub fn parse_study(text: &str, path: &Path, overrides: &[String]) -> Result<Study, StudyError> {
    let effective = if overrides.is_empty() { Some(text.to_owned()) } else { overrides::apply(text, overrides)? };
    let is_editable = effective.is_some();
    let context = Context::new(path, effective.unwrap_or_else(|| text.to_owned()));
    let (study, source) = resolve::study(context).map_err(|mut diagnostic| {
        diagnostic.overrides = overrides.to_vec();
        diagnostic
    })?;
    if !is_editable {
        // The reader accepts whole numbers up to 2^64, the editor up to 2^63, as TOML requires.
        return Err(not_editable(overrides));
    }
    Ok(study.with_source(StudySource {
        path: path.to_owned(),
        text: text.to_owned(),
        sha256: sha256(text.as_bytes()),
        overrides: overrides.to_vec(),
        ..source
    }))
}

/// Returns the text of a study after `overrides`, which [`parse_study`] reads like the original text with them.
///
/// # Errors
/// [`StudyError`] if an override cannot be applied, or the text is not TOML.
pub fn edited(text: &str, overrides: &[String]) -> Result<String, StudyError> {
    overrides::apply(text, overrides)?.ok_or_else(|| not_editable(overrides))
}

fn not_editable(overrides: &[String]) -> StudyError {
    let problem = "the study cannot be changed, because it has an integer above 2^63 - 1, which TOML does not allow";
    StudyError::Override { text: overrides.join(" "), problem: problem.to_owned() }
}
