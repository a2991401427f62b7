//! The journal of a study's run: found, checked against the study, and gone on with or begun anew.

mod recall;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::Resume;
use super::model_files::{differing, digests};
use crate::model::Messages;
use crate::run::journal::{Checkpoint, Contents, Journal, JournalError, differences, read_journal_file, with_ending};
use crate::run::{Piece, RunError, Shard, Store, Sums};
use crate::study::Study;
pub(super) use recall::recorded;
use recall::rows_on_record;

/// Outputs of more bytes than this are not put on record for quick runs: it takes longer than to evaluate them again.
const LARGE: u64 = 64 << 20;

/// What is asked of a record.
#[derive(Clone, Copy)]
pub(super) struct JournalRequest {
    pub resume: Resume,
    pub shard: Option<Shard>,
    pub needs_outputs: bool,
}

/// The runs of a study that are on record, and where more are put on record.
pub(super) enum OpenJournal {
    None,
    Outputs(Store, Journal),
    Sums(Checkpoint, Option<Sums>),
}

impl OpenJournal {
    /// The outputs on record, if outputs are.
    pub fn store(&self) -> Option<&Store> {
        if let Self::Outputs(store, _) = self { Some(store) } else { None }
    }

    pub fn checkpoint(&self) -> Option<&Checkpoint> {
        if let Self::Sums(checkpoint, _) = self { Some(checkpoint) } else { None }
    }

    /// The sums on record, if sums are.
    pub fn take_sums(&mut self) -> Option<Sums> {
        if let Self::Sums(_, sums) = self { sums.take() } else { None }
    }

    /// Puts a piece on record.
    pub fn append(&self, piece: &Piece) -> std::io::Result<()> {
        if let Self::Outputs(_, journal) = self { journal.append(piece) } else { Ok(()) }
    }

    /// Forces what is on record to the disk.
    pub fn sync(&self) -> Result<(), RunError> {
        let Self::Outputs(_, journal) = self else { return Ok(()) };
        journal.sync().map_err(|source| RunError::NotKept { source })
    }
}

/// Whether the outputs of every run of `study` are needed, besides their sums.
pub(super) fn needs_outputs(study: &Study, saves_outputs: bool) -> bool {
    saves_outputs || study.model().concurrency().is_some() || study.needs_outputs()
}

/// Opens the record of `study` at `path` for parts that were evaluated with `files`, however quick its runs are. What is
/// there is used if it was evaluated with the same files, and else moved aside.
pub(super) fn open_for_parts(
    study: &Study,
    path: &Path,
    files: &Value,
    messages: &Messages,
) -> Result<OpenJournal, RunError> {
    if path.exists() {
        match Journal::resume(path) {
            Ok((journal, contents)) => {
                let why = match &contents.sums {
                    Some(_) => Some("the journal holds sums, and parts are merged by their outputs".to_owned()),
                    None => another_study(study, &contents.header).or_else(|| another_model(&contents.header, files)),
                };
                let Some(why) = why else { return Ok(OpenJournal::Outputs(recorded(study, &contents), journal)) };
                drop(journal);
                move_aside(path, &why, messages)?;
            }
            Err(error @ (JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. })) => {
                move_aside(path, &error.to_string(), messages)?;
            }
            Err(error) => return Err(error.into()),
        }
    }
    begin(study, path, None, files)
}

/// Opens the record of `study` at `path`. A journal of something else, or one that is not wanted, is moved aside.
pub(super) fn open(
    study: &Study,
    path: &Path,
    request: JournalRequest,
    messages: &Messages,
) -> Result<OpenJournal, RunError> {
    let JournalRequest { resume, .. } = request;
    if !path.exists() {
        // Quick runs with many outputs are not recorded: a result of theirs is doubled by evaluating all of them.
        if resume.is_required() && resume != Resume::Double {
            return Err(refused(path, "there is no journal here: nothing is on record to go on with".to_owned()));
        }
        return fresh(study, path, request);
    }
    let (journal, mut contents) = match Journal::resume(path) {
        Ok(found) => found,
        Err(error @ (JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. }))
            if !resume.is_required() =>
        {
            move_aside(path, &error.to_string(), messages)?;
            return fresh(study, path, request);
        }
        Err(error) => return Err(error.into()),
    };
    let other = another_study(study, &contents.header);
    if let (true, Some(why)) = (resume.is_required(), &other) {
        return Err(refused(path, why.clone()));
    }
    if let Some(sums) = contents.sums.take() {
        return open_sums(study, path, journal, sums, other, request, messages);
    }
    let changed = another_model(&contents.header, &digests(study));
    if let Some(changed) = changed.as_ref().filter(|_| resume != Resume::Never && !contents.pieces.is_empty()) {
        let advice = "its runs are of the program as it was. Undo the change, or begin again with --restart";
        return Err(refused(path, format!("{changed}: {advice}")));
    }
    let why = if resume == Resume::Never { Some("--restart".to_owned()) } else { other.or(changed) };
    if why.is_some() || contents.pieces.is_empty() && !request.needs_outputs {
        drop(journal);
        return anew(study, path, request, contents.pieces.is_empty(), why, messages);
    }
    if contents.cut_off > 0 {
        let what = "behind its last whole record, of runs that are evaluated again";
        messages.send(&format!("note: {}: {} bytes were cut off {what}", path.display(), contents.cut_off));
    }
    let store = recorded(study, &contents);
    if resume == Resume::RetryFailed {
        match store.forget_failures() {
            0 => messages.send(&format!("note: no run on record in {} has failed", path.display())),
            1 => messages.send("note: the run that failed is evaluated again"),
            failed => messages.send(&format!("note: the {failed} runs that failed are evaluated again")),
        }
    }
    tell_recorded(study, path, rows_on_record(study, &store), messages);
    Ok(OpenJournal::Outputs(store, journal))
}

/// Opens a record of sums, which is of another study if `other` says so.
fn open_sums(
    study: &Study,
    path: &Path,
    journal: Journal,
    sums: Sums,
    other: Option<String>,
    request: JournalRequest,
    messages: &Messages,
) -> Result<OpenJournal, RunError> {
    let JournalRequest { resume, needs_outputs, .. } = request;
    let (model, settings) = (study.model(), study.design.settings());
    let (points, grows) = (study.design.points_per_replicate(), study.target.grows());
    let is_empty = sums.rows() == 0;
    let fits = || {
        let coherent = sums.is_coherent(settings.replicates);
        coherent && sums.totals().all(|totals| totals.fits(&study.design, model.as_ref()))
    };
    let why = if resume == Resume::Never {
        Some("--restart".to_owned())
    } else if other.is_some() {
        other
    } else if needs_outputs && !is_empty {
        let what = "the journal holds the sums of the runs, and their outputs are needed";
        Some(if resume.is_required() { format!("{what}: leave out {}", resume.option()) } else { what.to_owned() })
    } else if !fits() {
        Some("this is no journal of a run: its sums are not of this design".to_owned())
    } else if !sums.is_stage_of(points, grows) {
        Some("the journal holds sums of a run that grew from another number of base samples".to_owned())
    } else {
        None
    };
    match why {
        Some(why) if resume.is_required() => return Err(refused(path, why)),
        None if !grows && sums.points() > points => {
            let recorded = sums.points() * settings.replicates;
            let what = format!(
                "the journal holds the sums of {recorded} base samples, which cannot be divided into those of {}",
                settings.base_samples
            );
            if resume.is_required() {
                return Err(refused(
                    path,
                    format!("{what}: ask for as many or more, or leave out {}", resume.option()),
                ));
            }
            messages
                .send(&format!("note: {}: {what}: it stays as it is, and this run is not recorded", path.display()));
            return Ok(OpenJournal::None);
        }
        None if !needs_outputs => (),
        why => {
            drop(journal);
            return anew(study, path, request, is_empty, why, messages);
        }
    }
    let header = header(study, None, &digests(study));
    if resume == Resume::RetryFailed {
        messages.send("note: the journal holds sums: all runs are evaluated anew, those that failed among them");
        let checkpoint = journal.into_checkpoint(&header);
        return Ok(OpenJournal::Sums(checkpoint, Some(Sums::new(settings.replicates))));
    }
    tell_recorded(study, path, sums.rows(), messages);
    Ok(OpenJournal::Sums(journal.into_checkpoint(&header), Some(sums)))
}

fn tell_recorded(study: &Study, path: &Path, rows: u64, messages: &Messages) {
    if rows > 0 {
        let total = study.design.rows();
        messages.send(&format!("note: {rows} of {total} runs are on record in {}", path.display()));
    }
}

/// Begins a record anew, in place of one that is moved aside if there is something in it.
fn anew(
    study: &Study,
    path: &Path,
    request: JournalRequest,
    is_empty: bool,
    why: Option<String>,
    messages: &Messages,
) -> Result<OpenJournal, RunError> {
    if is_empty {
        std::fs::remove_file(path).map_err(|error| in_the_way(path, &error))?;
    } else {
        move_aside(path, why.as_deref().unwrap_or_default(), messages)?;
    }
    fresh(study, path, request)
}

fn fresh(study: &Study, path: &Path, request: JournalRequest) -> Result<OpenJournal, RunError> {
    let (model, files) = (study.model(), digests(study));
    if !request.needs_outputs {
        let sums = Sums::new(study.design.settings().replicates);
        let checkpoint = Checkpoint::create(path, &header(study, None, &files), &sums)?;
        return Ok(OpenJournal::Sums(checkpoint, Some(sums)));
    }
    let bytes = study.design.rows().saturating_mul(8 * model.outputs().len() as u64);
    if request.shard.is_some() || model.concurrency().is_some() || bytes <= LARGE {
        begin(study, path, request.shard, &files)
    } else {
        Ok(OpenJournal::None)
    }
}

fn begin(study: &Study, path: &Path, shard: Option<Shard>, files: &Value) -> Result<OpenJournal, RunError> {
    let store = Store::new(&study.design, study.model().as_ref());
    let journal = Journal::create(path, &header(study, shard, files))?;
    Ok(OpenJournal::Outputs(store, journal))
}

fn header(study: &Study, shard: Option<Shard>, files: &Value) -> Value {
    json!({
        "study": study.name,
        "shard": shard.map(|shard| shard.to_string()),
        "identity": study.identity(),
        "files": files,
    })
}

/// Why a journal with this header is not one of `study`, if it is not.
fn another_study(study: &Study, header: &Value) -> Option<String> {
    let found = differences(&header["identity"], &study.identity());
    let name = header["study"].as_str().unwrap_or_default();
    (!found.is_empty()).then(|| format!("the journal is of another study ({name}): {}", found.join("; ")))
}

/// Why a journal with this header is of another version of the model than that of `files` (path: digest), if it is.
fn another_model(header: &Value, files: &Value) -> Option<String> {
    differing(&header["files"], files).map(|names| format!("{names} changed since the journal was written"))
}

/// Moves a journal out of the way, to a name that no other has.
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
    JournalError::Unwritable { path: path.to_owned(), source }.into()
}

pub(super) fn refused(path: &Path, reason: String) -> RunError {
    RunError::Refused { path: path.to_owned(), reason }
}

/// Reads the journal at `path`, which must be one of `study`, without locking it.
pub(super) fn read(study: &Study, path: &Path) -> Result<Contents, RunError> {
    let contents = read_journal_file(path).map_err(|error| match error {
        // Named by the user, or found a moment ago.
        JournalError::Unreadable { source, .. } => refused(path, format!("cannot read the journal: {source}")),
        error => error.into(),
    })?;
    match another_study(study, &contents.header) {
        Some(why) => Err(refused(path, why)),
        None => Ok(contents),
    }
}

/// Runs of `study` on record in the journal at `path`.
pub(super) fn recorded_runs(study: &Study, path: &Path) -> Result<u64, RunError> {
    let contents = read(study, path)?;
    if let Some(why) = another_model(&contents.header, &digests(study)) {
        return Err(refused(path, why));
    }
    Ok(match &contents.sums {
        Some(sums) => sums.rows(),
        None => rows_on_record(study, &recorded(study, &contents)),
    })
}
