//! The journal of a study's run: located, checked against the study, and resumed or replaced.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use serde_json::{Value, json};

use super::{Resume, Runner};
use crate::model::Messages;
use crate::run::journal::{Contents, Journal, JournalProblem, differences, read_journal_file, with_ending};
use crate::run::{MAX_STORED_BYTES, ModelFiles, Progress, RowBlock, RunError, Shard, Store, differing};
use crate::study::Study;

/// Runs that are expected to take longer than this are worth a journal.
const LONG_RUN: Duration = Duration::from_secs(10);

/// Time that a run must have taken before its duration is estimated.
const MIN_ELAPSED: Duration = Duration::from_millis(200);

/// The recorded runs of a study, and where new ones are recorded.
pub(super) struct RunJournal {
    /// Outputs that were recorded when the journal was opened.
    pub store: Store,
    pub open: OnceLock<Journal>,
    files: Arc<ModelFiles>,
    /// Path and header of the journal of a run that is not yet expected to be long.
    waiting: Mutex<Option<(PathBuf, Value)>>,
}

impl RunJournal {
    /// Returns a run without a journal.
    pub fn none(study: &Study) -> Self {
        let (store, files) = (Store::new(study.model().as_ref()), ModelFiles::new(study.subject.files()).into());
        Self { store, open: OnceLock::new(), files, waiting: Mutex::new(None) }
    }

    /// Adds a new journal at `path` with a `header`; if it `waits`, once the run is expected to be long.
    fn with_new(self, path: &Path, header: Value, waits: bool) -> Result<Self, RunError> {
        if waits {
            return Ok(Self { waiting: Mutex::new(Some((path.to_owned(), header))), ..self });
        }
        Ok(Self { open: Journal::create(path, &header)?.with_files(&self.files).into(), ..self })
    }

    /// Adds a resumed journal with these blocks.
    fn with_resumed(self, study: &Study, journal: Journal, blocks: Vec<RowBlock>) -> Self {
        Self { store: recorded(study, blocks), open: journal.with_files(&self.files).into(), ..self }
    }

    /// Creates the journal of a run that is expected to be long; an error only causes a warning.
    pub fn watch(&self, progress: Progress, outputs: usize, messages: &Messages) {
        let Progress { done, recalled, total, elapsed, .. } = progress;
        let share = done.saturating_sub(recalled) as f64 / total.saturating_sub(recalled).max(1) as f64;
        if elapsed < MIN_ELAPSED || elapsed.as_secs_f64() < share * LONG_RUN.as_secs_f64() {
            return;
        }
        let Some((path, header)) = self.waiting.lock().unwrap_or_else(PoisonError::into_inner).take() else { return };
        let bytes = total.saturating_mul(outputs as u64 * 8);
        if bytes > MAX_STORED_BYTES {
            let error = RunError::TooManyOutputs { runs: total, bytes };
            return messages.send(&format!("warning: no journal is kept: to resume, {error}"));
        }
        match Journal::create(&path, &header) {
            Ok(journal) => {
                let megabytes = bytes.div_ceil(1_000_000);
                messages.send(&format!(
                    "note: the run is expected to take longer than {} s: completed runs are now saved in {}, about \
                     {megabytes} MB in the end",
                    LONG_RUN.as_secs(),
                    path.display()
                ));
                let _ = self.open.set(journal.with_files(&self.files));
            }
            Err(error) => messages.send(&format!("warning: no journal is kept: {error}")),
        }
    }

    /// Forces recorded outputs to the disk, and checks that all outputs are of one version of the model.
    pub fn finish(&self) -> Result<(), RunError> {
        self.files.check_contents()?;
        self.open.get().map_or(Ok(()), Journal::sync).map_err(|source| RunError::NotKept { source })
    }
}

/// Opens the journal of `study` at `path` for parts that were evaluated with `files`. An existing journal is used if it
/// was evaluated with the same files, and otherwise moved aside.
pub(super) fn open_for_parts(
    study: &Study,
    path: &Path,
    files: &Value,
    messages: &Messages,
) -> Result<RunJournal, RunError> {
    let (none, header) = (RunJournal::none(study), header(study, None, files));
    let Some((journal, contents)) = resume_file(path, Resume::IfThere, messages)? else {
        return none.with_new(path, header, false);
    };
    match another_study(study, &contents.header).or_else(|| another_model(&contents.header, files)) {
        None => Ok(none.with_resumed(study, journal, contents.blocks)),
        Some(kind) => {
            drop(journal);
            move_aside(path, &kind.to_string(), messages)?;
            none.with_new(path, header, false)
        }
    }
}

/// Opens the journal of `runner` at `path`. A journal of another study, or an unwanted one, is moved aside.
pub(super) fn open(
    runner: &Runner<'_>,
    path: &Path,
    shard: Option<Shard>,
    messages: &Messages,
) -> Result<RunJournal, RunError> {
    let Runner { study, resume, only_if_long, .. } = *runner;
    let none = RunJournal::none(study);
    let mut header = header(study, shard, &none.files.digests);
    if !runner.points.is_null() {
        header["identity"]["points"] = runner.points.clone();
    }
    // Even a few runs of a slow model may have cost much.
    let waits = only_if_long && shard.is_none() && !study.model().is_slow();
    let Some((journal, contents)) = resume_file(path, resume, messages)? else {
        return none.with_new(path, header, waits);
    };
    let other = another_identity(&header["identity"], &contents.header);
    let changed = another_model(&contents.header, &none.files.digests);
    let reason = match (other, changed) {
        _ if resume == Resume::Restart => Some("restarted".to_owned()),
        (Some(other), _) if resume.is_required() => return Err(other.at(path).into()),
        (_, Some(changed)) if !contents.blocks.is_empty() => return Err(changed.at(path).into()),
        (other, changed) => other.or(changed).map(|kind| kind.to_string()),
    };
    if let Some(reason) = reason {
        drop(journal);
        if contents.blocks.is_empty() {
            std::fs::remove_file(path).map_err(|error| in_the_way(path, &error))?;
        } else {
            move_aside(path, &reason, messages)?;
        }
        return none.with_new(path, header, waits);
    }
    if contents.cut_off > 0 {
        let what = "after its last complete record; their runs are evaluated again";
        messages.send(&format!("note: {}: {} bytes were cut off {what}", path.display(), contents.cut_off));
    }
    let resumed = none.with_resumed(study, journal, contents.blocks);
    if resume == Resume::RetryFailed {
        match resumed.store.forget_failures() {
            0 => messages.send(&format!("note: no run in {} has failed", path.display())),
            1 => messages.send("note: the run that failed is evaluated again"),
            failed => messages.send(&format!("note: the {failed} runs that failed are evaluated again")),
        }
    }
    let rows = rows_on_record(study, &resumed.store);
    if !runner.points.is_null() {
        let rows = resumed.store.count(0, 0..u64::MAX).0;
        messages.send(&format!("note: {rows} runs are already saved in {}", path.display()));
    } else if rows > 0 {
        let total = study.design.rows();
        messages.send(&format!("note: {rows} of {total} runs are already saved in {}", path.display()));
    }
    Ok(resumed)
}

/// Opens the journal at `path` and reads it; returns `None` if there is none, or if it was invalid and moved aside.
fn resume_file(path: &Path, resume: Resume, messages: &Messages) -> Result<Option<(Journal, Contents)>, RunError> {
    if !path.exists() {
        if resume.is_required() {
            return Err(JournalProblem::Missing.at(path).into());
        }
        return Ok(None);
    }
    match Journal::resume(path) {
        Err(error)
            if !resume.is_required()
                && matches!(error.problem, JournalProblem::Invalid(_) | JournalProblem::OtherFormat(_)) =>
        {
            move_aside(path, &error.to_string(), messages)?;
            Ok(None)
        }
        resumed => Ok(Some(resumed?)),
    }
}

fn header(study: &Study, shard: Option<Shard>, files: &Value) -> Value {
    json!({
        "study": study.name,
        "shard": shard.map(|shard| shard.to_string()),
        "identity": study.identity(),
        "files": files,
    })
}

/// Returns how the study of a journal with this header differs from `study`, if it does.
fn another_study(study: &Study, header: &Value) -> Option<JournalProblem> {
    another_identity(&study.identity(), header)
}

fn another_identity(identity: &Value, header: &Value) -> Option<JournalProblem> {
    let differences = differences(&header["identity"], identity).join("; ");
    let name = header["study"].as_str().unwrap_or_default().to_owned();
    (!differences.is_empty()).then_some(JournalProblem::OtherStudy(name, differences))
}

/// Returns how the model of a journal with this header differs from one with `files` (path: digest), if it does.
fn another_model(header: &Value, files: &Value) -> Option<JournalProblem> {
    differing(&header["files"], files).map(JournalProblem::OtherModel)
}

/// Renames a journal to an unused name.
fn move_aside(path: &Path, why: &str, messages: &Messages) -> Result<(), RunError> {
    let more = (2..).map(|number| format!(".old{number}"));
    let mut names = std::iter::once(".old".to_owned()).chain(more).map(|ending| with_ending(path, &ending));
    let aside: PathBuf = names.find(|name| !name.exists()).unwrap_or_else(|| with_ending(path, ".old"));
    std::fs::rename(path, &aside).map_err(|error| in_the_way(path, &error))?;
    messages.send(&format!("note: {why}: the journal was moved to {}, and its runs are not used", aside.display()));
    Ok(())
}

fn in_the_way(path: &Path, source: &std::io::Error) -> RunError {
    let source = std::io::Error::new(source.kind(), format!("cannot move it aside: {source}"));
    JournalProblem::Unwritable(source).at(path).into()
}

/// Reads the journal at `path`, which must belong to `study`, without locking it.
pub(super) fn read(study: &Study, path: &Path) -> Result<Contents, RunError> {
    let contents = read_journal_file(path)?;
    match another_study(study, &contents.header) {
        Some(problem) => Err(problem.at(path).into()),
        None => Ok(contents),
    }
}

/// Counts the runs of `study` recorded in the journal at `path`.
pub(super) fn recorded_runs(study: &Study, path: &Path) -> Result<u64, RunError> {
    let contents = read(study, path)?;
    if let Some(problem) = another_model(&contents.header, &ModelFiles::new(study.subject.files()).digests) {
        return Err(problem.at(path).into());
    }
    Ok(rows_on_record(study, &recorded(study, contents.blocks)))
}

/// Returns a store of the runs of `study` in the blocks of a journal; of duplicates, the later one counts.
pub(super) fn recorded(study: &Study, blocks: Vec<RowBlock>) -> Store {
    let store = Store::new(study.model().as_ref());
    let outputs = store.outputs();
    for block in blocks {
        if block.replicate < study.design.settings().replicates && block.is_complete(outputs) {
            store.insert(block);
        }
    }
    store
}

/// Counts the rows of the design that are in `store`.
pub(super) fn rows_on_record(study: &Study, store: &Store) -> u64 {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    (0..study.design.settings().replicates).map(|replicate| store.count(replicate, 0..rows).0).sum()
}

#[cfg(test)]
#[path = "tests/journal.rs"]
mod tests;
