//! The journal of a command that runs a model: where it is, what becomes of it, and how to continue.

use std::path::{Path, PathBuf};

use apportion::run::journal::read_journal;
use apportion::run::{RunError, Shard};
use apportion::{Resume, Runner};

use super::say;
use super::stop::on_signal;

/// What becomes of the journal.
#[derive(clap::Args)]
pub struct JournalArguments {
    /// Resume an interrupted run; an error if its journal is missing or of another study. (Without this option a journal
    /// of the same study is used if it exists)
    #[arg(long, conflicts_with_all = ["restart", "no_journal"])]
    resume: bool,
    /// Evaluate the runs that failed again, and keep all others
    #[arg(long, conflicts_with_all = ["restart", "no_journal"])]
    retry_failed: bool,
    /// Evaluate every run again; an existing journal is renamed
    #[arg(long)]
    restart: bool,
    /// Neither use nor write a journal
    #[arg(long)]
    pub no_journal: bool,
    /// Always keep a journal (without this option: if the runs take longer than 10 s, or the model is a program)
    #[arg(long, conflicts_with = "no_journal")]
    journal: bool,
}

impl JournalArguments {
    /// The journal of what is called `name`, or of one of its shards, in `folder`, if there is to be one.
    pub fn path(&self, folder: &Path, name: &str, shard: Option<Shard>) -> Option<PathBuf> {
        (!self.no_journal).then(|| journal_path(folder, name, shard))
    }

    /// `runner` with the journal at `path`; a signal stops it from now on.
    pub fn keep<'a>(&self, runner: Runner<'a>, path: Option<&Path>) -> Runner<'a> {
        let resume = match self {
            Self { retry_failed: true, .. } => Resume::RetryFailed,
            Self { resume: true, .. } => Resume::Require,
            Self { restart: true, .. } => Resume::Restart,
            _ => Resume::IfThere,
        };
        let runner = runner.on_message(say).stop(on_signal()).resume(resume);
        match path {
            None => runner,
            Some(path) if self.journal => runner.journal(path),
            Some(path) => runner.journal_if_long(path),
        }
    }
}

/// The journal of what is called `name`, or of one of its shards, in `folder`.
pub fn journal_path(folder: &Path, name: &str, shard: Option<Shard>) -> PathBuf {
    match shard {
        None => folder.join(format!("{name}.journal")),
        Some(shard) => folder.join(format!("{name}-shard-{}-of-{}.journal", shard.number(), shard.count())),
    }
}

/// Adds to an error how to continue the run; a journal without runs goes.
pub fn with_journal(error: impl Into<anyhow::Error>, journal: Option<&Path>) -> anyhow::Error {
    let error = error.into();
    let (option, again) = match error.chain().find_map(|cause| cause.downcast_ref()) {
        Some(RunError::GaveUp(give_up)) if give_up.is_bad_input => return error,
        // Rows that failed before the model gave up must be retried once the model is repaired.
        Some(RunError::GaveUp(_)) => ("--retry-failed", " and to evaluate the failed runs again"),
        Some(RunError::Interrupted { .. } | RunError::NotKept { .. }) => ("--resume", ""),
        _ => return error,
    };
    let bytes = journal.and_then(|path| Some((path, std::fs::read(path).ok()?)));
    let hint = match bytes {
        Some((path, bytes)) if read_journal(path, &bytes).is_ok_and(|contents| contents.blocks.is_empty()) => {
            let _ = std::fs::remove_file(path);
            String::new()
        }
        Some((path, _)) => {
            let path = path.display();
            format!("\ncompleted runs are saved in {path}: repeat the command with {option} to continue{again}")
        }
        None if option == "--resume" => "\nno journal was kept: the runs are lost".to_owned(),
        None => String::new(),
    };
    let message = format!("{error}{hint}");
    error.context(message)
}
