//! Reading of result files, with errors that name the place.

mod coherence;

use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;

use crate::result::StudyResult;
use apportion_base::files::read_whole;

/// The newest supported version of the format.
const VERSION: u32 = 1;
const FORMAT: &str = "apportion-result";

/// Why a file is not the result of a run.
#[derive(Debug, Error)]
#[error("{path}: {problem}", path = path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: ReadProblem,
}

/// What is wrong with a result file.
#[derive(Debug, Error)]
pub enum ReadProblem {
    /// It cannot be read.
    #[error("cannot read the result: {0}")]
    Unreadable(#[from] std::io::Error),
    /// It is not JSON, or not this JSON; line and column are in the message.
    #[error("not a result of `apportion run`: {0}")]
    Malformed(#[from] serde_json::Error),
    /// It is JSON of another kind, which it states as its format.
    #[error(
        "not a result of `apportion run`: its \"format\" is {stated:?}, expected \"{FORMAT}\" (the file NAME.json of a run)"
    )]
    Format { stated: String },
    /// It comes from a later version of the program.
    #[error("format version {stated} is unknown: this program reads version {VERSION}")]
    Version { stated: u32 },
    /// It is inconsistent at `key`, such as `outputs[0].scatter`.
    #[error("`{key}`: {problem}")]
    Incoherent { key: String, problem: String },
}

/// The header of every file of this program.
#[derive(Deserialize)]
struct Header {
    format: String,
    version: u32,
}

/// Reads the result of a run from its JSON file.
///
/// # Errors
/// [`ReadError`] with what is wrong: a file that cannot be read, that is not JSON or JSON of another kind, an unknown
/// version of the format, or inconsistent parts.
pub fn read_result(path: &Path) -> Result<StudyResult, ReadError> {
    let parsed = read_whole(path).map_err(ReadProblem::from).and_then(|json| parse_result(&json));
    parsed.map_err(|problem| ReadError { path: path.to_owned(), problem })
}

/// Reads the result of a run from JSON, as [`StudyResult::json`] writes it. Unknown keys of later versions are ignored.
///
/// ```
/// use apportion::result::parse_result;
/// use apportion::{Distribution, Study, function_model};
///
/// let study = Study::builder("square", function_model("y", |x| x[0] * x[0]))
///     .factor("x", Distribution::normal(0.0, 1.0)?)
///     .base_samples(256)
///     .build()?;
/// let result = study.run()?;
/// assert_eq!(parse_result(result.json().as_bytes())?, result);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReadProblem`], as for [`read_result`].
pub fn parse_result(json: &[u8]) -> Result<StudyResult, ReadProblem> {
    let Header { format, version } = serde_json::from_slice(json)?;
    if format != FORMAT {
        return Err(ReadProblem::Format { stated: format });
    }
    if version != VERSION {
        return Err(ReadProblem::Version { stated: version });
    }
    let result = serde_json::from_slice(json)?;
    let counts = coherence::counts(&serde_json::from_slice(json)?, "");
    counts
        .and_then(|()| coherence::check(&result))
        .map_err(|(key, problem)| ReadProblem::Incoherent { key, problem })?;
    Ok(result)
}
