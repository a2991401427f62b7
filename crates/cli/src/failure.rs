//! Why a command failed: exit code 2 if its input was wrong, else 1.

use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;

use apportion::design::DesignError;
use apportion::result::ReadError;
use apportion::run::RunError;
use apportion::run::journal::{JournalError, JournalProblem};
use apportion::screening::ScreeningError;
use apportion::sweep::SweepError;
use apportion_files::StudyError;
use apportion_papers::scene::simulation::SceneError;
use apportion_report::{ArtefactError, Refusal, WriteError};
use thiserror::Error;

/// The input was wrong, for this reason.
#[derive(Debug, Error)]
#[error("{0}")]
struct BadInput(String);

/// The input was wrong, and another process has reported it.
#[derive(Debug, Error)]
#[error("reported by another process")]
pub struct Silent;

/// Returns the error of a wrong input.
pub fn bad_input(reason: impl Display) -> anyhow::Error {
    BadInput(reason.to_string()).into()
}

/// Results that depend on a file of the user.
pub trait OfFile<T> {
    /// Says which file was wrong.
    fn in_file(self, file: &Path) -> anyhow::Result<T>;
}

impl<T, E: Display> OfFile<T> for Result<T, E> {
    fn in_file(self, file: &Path) -> anyhow::Result<T> {
        self.map_err(|error| bad_input(format!("{}: {error}", file.display())))
    }
}

/// Returns the message of an error, with what to do about it in the words of the command line.
pub fn message(error: &anyhow::Error) -> String {
    let remedy = match error.chain().find_map(|cause| cause.downcast_ref()) {
        Some(RunError::TooManyOutputs { .. }) => {
            ": use fewer base samples or outputs, intervals = \"batches\", or start again without saved outputs (--restart)"
        }
        Some(RunError::Journal(JournalError { problem: JournalProblem::OtherModel(_), .. })) => {
            ": its runs are from the earlier version. Undo the change, or start again with --restart"
        }
        Some(RunError::Journal(JournalError { problem: JournalProblem::PartlyMerged, .. })) => {
            ": merge the shards of one run only, into a folder without a journal (--out)"
        }
        _ if error.chain().any(|cause| matches!(cause.downcast_ref(), Some(Refusal::Exists(_)))) => ", or add --force",
        _ => "",
    };
    format!("{error}{remedy}")
}

/// Returns the exit code of an error.
pub fn exit_code(error: &anyhow::Error) -> u8 {
    if is_bad_input(error) { 2 } else { 1 }
}

fn is_bad_input(error: &anyhow::Error) -> bool {
    if error.chain().any(|cause| cause.is::<Refusal>()) {
        true
    } else if let Some(error) = error.chain().find_map(|cause| cause.downcast_ref()) {
        match error {
            RunError::GaveUp(give_up) => give_up.is_bad_input,
            RunError::Journal(JournalError { problem, .. }) => problem.is_bad_input(),
            _ => false,
        }
    } else if let Some(ArtefactError::Write(error)) = error.downcast_ref() {
        is_bad_path(error)
    } else if let Some(error) = error.downcast_ref::<WriteError>() {
        is_bad_path(error)
    } else if let Some(error) = error.downcast_ref::<SceneError>() {
        matches!(error, SceneError::OtherModel { .. })
    } else {
        error.is::<BadInput>()
            || error.is::<Silent>()
            || error.is::<StudyError>()
            || error.is::<ScreeningError>()
            || error.is::<SweepError>()
            || error.is::<ReadError>()
            || error.is::<DesignError>()
    }
}

/// Returns whether the path as given, not as resolved, is wrong.
fn is_bad_path(error: &WriteError) -> bool {
    error.source.kind() == ErrorKind::NotADirectory
}
