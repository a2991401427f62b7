//! What is on record of a study: its journal, opened, checked and filled into a store.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::anyhow;
use apportion::run::journal::{Contents, Journal, JournalError, differences, read_journal_file};
use apportion::run::{MOST_KEPT, Piece, Shard, Store};
use apportion::study::Study;
use serde_json::{Value, json};

use super::model_files::{ModelFiles, differing};
use super::{Failure, say};

/// A journal of more bytes than this is kept only of runs that take their time.
const LARGE: u64 = 64 << 20;

/// Time in seconds below which evaluating again is no loss, beside writing a large journal.
const QUICK: f64 = 10.0;

/// What to do with runs that are on record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// Use them if they are of this study, else begin anew.
    IfThere,
    /// Refuse to run without them.
    Require,
    /// The same, but for those that failed.
    RequireButFailures,
    /// Begin anew.
    Discard,
}

impl Use {
    /// The option that asks for it.
    fn option(self) -> &'static str {
        if self == Self::RequireButFailures { "--retry-failed" } else { "--resume" }
    }
}

/// What is asked of a record.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    pub how: Use,
    /// Whether runs that were evaluated with other files of the model are used too.
    pub mixed: bool,
    pub shard: Option<Shard>,
}

/// Runs on record that were evaluated with other files of the model than those of now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Foreign {
    /// The names of the files that differ.
    pub names: String,
    pub rows: u64,
}

/// The runs of a study that are on record, and where more are put on record.
pub struct Record {
    pub store: Store,
    /// Those of them that another model answered, if they were asked for.
    pub foreign: Option<Foreign>,
    journal: Journal,
    files: ModelFiles,
    /// Whether the journal says that the files have changed under the run.
    uncertain: Mutex<bool>,
}

impl Record {
    fn new(store: Store, journal: Journal, files: ModelFiles) -> Self {
        Self { store, foreign: None, journal, files, uncertain: Mutex::new(false) }
    }

    /// Puts a piece on record, with the files that it was evaluated with.
    pub fn keep(&self, piece: &Piece) -> std::io::Result<()> {
        // Held until the piece is there: it must not come to lie on the wrong side of the note.
        let mut uncertain = self.uncertain.lock().unwrap_or_else(PoisonError::into_inner);
        if !*uncertain && self.files.changed().is_some() {
            self.journal.append_files(&self.files.uncertain())?;
            *uncertain = true;
        }
        self.journal.append(piece)
    }

    /// Forces what is on record to the disk.
    pub fn sync(&self) -> Result<(), Failure> {
        self.journal.sync().map_err(|error| {
            Failure::Run(anyhow!("{}: cannot write the journal: {error}", self.journal.path().display()))
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.journal.path()
    }
}

/// The journal of the study called `name`, or of one of its shards, in `folder`.
pub fn journal_path(folder: &Path, name: &str, shard: Option<Shard>) -> PathBuf {
    match shard {
        None => folder.join(format!("{name}.journal")),
        Some(shard) => folder.join(format!("{name}-shard-{}-of-{}.journal", shard.number(), shard.of())),
    }
}

/// Opens the record of `study` at `path` for parts that were evaluated with `files`, however quick its runs are. What is
/// there is used if it was evaluated with the same files, and else moved aside.
pub fn open_for_parts(study: &Study, path: &Path, files: &Value) -> Result<Record, Failure> {
    let of_parts = ModelFiles::on_record(files);
    if path.exists() {
        match Journal::resume(path) {
            Ok((journal, contents)) => {
                let recalled = recall(study, (&contents, files), Use::IfThere);
                let Some(why) = another_study(study, &contents.header).or_else(|| recalled.of_another_model()) else {
                    return gone_on((journal, &contents), (recalled.own, of_parts));
                };
                drop(journal);
                move_aside(path, &why)?;
            }
            Err(error @ (JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. })) => {
                move_aside(path, &error.to_string())?;
            }
            Err(error) => return Err(wrong(error)),
        }
    }
    begin(study, (path, None), of_parts)
}

/// Opens the record of `study` at `path`. A journal of something else, or one that is not wanted, is moved aside. `None`
/// if there is none and the runs are quicker than it is worth.
pub fn open(study: &Study, path: &Path, asked: Asked) -> Result<Option<Record>, Failure> {
    let Asked { how, mixed, shard } = asked;
    let required = matches!(how, Use::Require | Use::RequireButFailures);
    if !path.exists() {
        if required {
            let what = "there is no journal here: nothing is on record to go on with";
            return Err(Failure::Input(anyhow!("{}: {what}", path.display())));
        }
        return fresh(study, path, shard);
    }
    let (journal, contents) = match Journal::resume(path) {
        Ok(found) => found,
        Err(error @ (JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. })) if !required => {
            move_aside(path, &error.to_string())?;
            return fresh(study, path, shard);
        }
        Err(error) => return Err(wrong(error)),
    };
    let other = another_study(study, &contents.header);
    if let (true, Some(why)) = (required, &other) {
        return Err(Failure::Input(anyhow!("{}: {why}", path.display())));
    }
    let files = ModelFiles::of(study);
    let recalled = recall(study, (&contents, files.begun()), how);
    let why = match how {
        Use::Discard => Some("--restart".to_owned()),
        _ if mixed => other,
        _ if required => recalled.refuse(path, how).map(|()| None)?,
        _ => other.or_else(|| recalled.of_another_model()),
    };
    if let Some(why) = why {
        drop(journal);
        if contents.pieces.is_empty() {
            std::fs::remove_file(path).map_err(|error| in_the_way(path, error))?;
        } else {
            move_aside(path, &why)?;
        }
        return fresh(study, path, shard);
    }
    if contents.cut_off > 0 {
        let what = "behind its last whole record, of runs that are evaluated again";
        say(&format!("note: {}: {} bytes were cut off {what}", path.display(), contents.cut_off));
    }
    if how == Use::RequireButFailures {
        match recalled.forgotten {
            0 => say(&format!("note: no run on record in {} has failed", path.display())),
            1 => say("note: the run that failed is evaluated again"),
            failed => say(&format!("note: the {failed} runs that failed are evaluated again")),
        }
    }
    let Recalled { own, all, foreign, .. } = recalled;
    let store = match (&foreign, mixed) {
        (None, _) => own,
        (Some(Foreign { names, rows }), true) => {
            say(&format!(
                "warning: {rows} of the runs on record were evaluated with another {names}: the result mixes both"
            ));
            all.unwrap_or(own)
        }
        (Some(Foreign { names, rows }), false) => {
            say(&format!(
                "note: {rows} of the runs on record were evaluated with another {names}: they are evaluated again"
            ));
            own
        }
    };
    let record = gone_on((journal, &contents), (store, files))?;
    Ok(Some(Record { foreign: foreign.filter(|_| mixed), ..record }))
}

/// A record that goes on in a journal: if it ends with other files, the journal says that there are new ones.
fn gone_on((journal, contents): (Journal, &Contents), (store, files): (Store, ModelFiles)) -> Result<Record, Failure> {
    let last = contents.stretches.last().map_or(&Value::Null, |stretch| &stretch.files);
    if differing(last, files.begun()).is_some() {
        journal.append_files(files.begun()).map_err(|error| {
            Failure::Run(anyhow!("{}: cannot write the journal: {error}", journal.path().display()))
        })?;
    }
    Ok(Record::new(store, journal, files))
}

/// What is on record, by the model that answered.
struct Recalled {
    /// Runs that were evaluated with the files of now.
    own: Store,
    /// These and all others, if there are others.
    all: Option<Store>,
    foreign: Option<Foreign>,
    /// Runs that failed, and are to be evaluated again.
    forgotten: u64,
}

/// What a journal holds of `study`, whose model has `files` now. Where a run is there twice, that of the files of now
/// counts, and else the later one.
fn recall(study: &Study, (contents, files): (&Contents, &Value), how: Use) -> Recalled {
    let again = |store: &Store| if how == Use::RequireButFailures { store.forget_failures() } else { 0 };
    let is_own = |now: &Value| differing(now, files).is_none();
    let mut names = None;
    for (_, before) in contents.pieces_with_files() {
        names = names.or_else(|| differing(before, files));
    }
    let own = filled_by(study, contents, &is_own);
    let Some(names) = names else {
        let forgotten = again(&own);
        return Recalled { own, all: None, foreign: None, forgotten };
    };
    let all = filled_by(study, contents, &|before| !is_own(before));
    own.pieces().iter().for_each(|piece| {
        all.insert(piece);
    });
    let forgotten = again(&all);
    again(&own);
    let rows = all.rows().saturating_sub(own.rows());
    let foreign = (rows > 0).then_some(Foreign { names, rows });
    Recalled { own, all: Some(all), foreign, forgotten }
}

impl Recalled {
    /// Why nothing of it is of use, if runs are there, but all of another model.
    fn of_another_model(&self) -> Option<String> {
        let foreign = self.foreign.as_ref().filter(|_| self.own.rows() == 0)?;
        Some(format!("{} changed since the journal was written", foreign.names))
    }

    /// Refuses runs of another model, of which the user may not know.
    fn refuse(&self, path: &Path, how: Use) -> Result<(), Failure> {
        let Some(Foreign { names, rows }) = &self.foreign else { return Ok(()) };
        let (path, option) = (path.display(), how.option());
        Err(Failure::Input(anyhow!(
            "{path}: {names} changed since {rows} of the runs on record were evaluated: the result would mix two models. Undo \
             the change; or leave out {option}, and they are evaluated again; or add --mix-models, and they are used, which \
             the result then says"
        )))
    }
}

/// A store of what a journal of this study holds of the model as it is now.
pub fn filled(study: &Study, contents: &Contents) -> Store {
    recall(study, (contents, ModelFiles::of(study).begun()), Use::IfThere).own
}

/// What a journal of a part holds, and the files that it was evaluated with.
///
/// # Errors
/// [`Failure::Input`] if several models have answered.
pub fn part(study: &Study, (path, contents): (&Path, &Contents)) -> Result<(Store, Value), Failure> {
    let last = contents.pieces_with_files().last().map(|(_, files)| files);
    let files = last.or(contents.stretches.last().map(|stretch| &stretch.files)).unwrap_or(&Value::Null);
    let recalled = recall(study, (contents, files), Use::IfThere);
    match recalled.foreign {
        None => Ok((recalled.own, files.clone())),
        Some(Foreign { names, rows }) => Err(Failure::Input(anyhow!(
            "{}: {rows} of its runs were evaluated with another {names} than the others: evaluate this part again",
            path.display()
        ))),
    }
}

fn filled_by(study: &Study, contents: &Contents, wanted: &dyn Fn(&Value) -> bool) -> Store {
    let model = study.model();
    let store = Store::new(&study.design, model.as_ref());
    let outputs = store.outputs();
    let fits = |piece: &Piece| {
        let rows = piece.rows(outputs);
        let failures =
            piece.failures.iter().all(|(row, output, _)| u64::from(*row) < rows && (*output as usize) < outputs);
        piece.replicate < study.design.settings().replicates
            && failures
            && rows as usize * outputs == piece.values.len()
    };
    for (piece, files) in contents.pieces_with_files() {
        if wanted(files) && fits(piece) {
            store.insert(piece);
        }
    }
    store
}

/// Rows of the design that are in `store`.
pub fn rows_on_record(study: &Study, store: &Store) -> u64 {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    (0..study.design.settings().replicates).map(|replicate| store.count(replicate, 0..rows).0).sum()
}

fn fresh(study: &Study, path: &Path, shard: Option<Shard>) -> Result<Option<Record>, Failure> {
    if shard.is_some() || keeps_journal(study)? {
        begin(study, (path, shard), ModelFiles::of(study)).map(Some)
    } else {
        Ok(None)
    }
}

/// Whether a run of `study` keeps a journal: not a large one of quick runs, nor one beyond all memory.
pub fn keeps_journal(study: &Study) -> Result<bool, Failure> {
    let model = study.model();
    let bytes = study.design.rows().saturating_mul(8 * model.outputs().len() as u64);
    // What is on record is held in memory too: beyond what fits, a run goes without.
    Ok(model.concurrency().is_some() || bytes <= LARGE || bytes <= MOST_KEPT && seconds(study)? >= QUICK)
}

fn begin(study: &Study, (path, shard): (&Path, Option<Shard>), files: ModelFiles) -> Result<Record, Failure> {
    let store = Store::new(&study.design, study.model().as_ref());
    let header = json!({
        "study": study.name,
        "shard": shard.map(|shard| shard.to_string()),
        "identity": study.identity(),
        "files": files.begun(),
    });
    let journal = Journal::create(path, &header).map_err(wrong)?;
    Ok(Record::new(store, journal, files))
}

/// What the whole run will take, in seconds, by its first runs.
fn seconds(study: &Study) -> Result<f64, Failure> {
    let begin = Instant::now();
    let pilot = super::pilot::pilot(study)?;
    // A pilot that took long is of a run that takes longer.
    Ok(pilot.seconds.max(begin.elapsed().as_secs_f64()))
}

/// Why a journal with this header is not one of `study`, if it is not.
pub fn another_study(study: &Study, header: &Value) -> Option<String> {
    let found = differences(&header["identity"], &study.identity());
    let name = header["study"].as_str().unwrap_or_default();
    (!found.is_empty()).then(|| format!("the journal is of another study ({name}): {}", found.join("; ")))
}

/// Moves a journal out of the way, to a name that no other has.
fn move_aside(path: &Path, why: &str) -> Result<(), Failure> {
    let more = (2..).map(|number| format!("journal.old{number}"));
    let mut names = std::iter::once("journal.old".to_owned()).chain(more).map(|ending| path.with_extension(ending));
    let aside = names.find(|name| !name.exists()).unwrap_or_else(|| path.with_extension("journal.old"));
    std::fs::rename(path, &aside).map_err(|error| in_the_way(path, error))?;
    say(&format!("note: {why}: the journal was moved to {}, and its runs are not used", aside.display()));
    Ok(())
}

fn in_the_way(path: &Path, error: std::io::Error) -> Failure {
    Failure::Run(anyhow!("{}: cannot move the journal aside: {error}", path.display()))
}

fn wrong(error: JournalError) -> Failure {
    match error {
        JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. } | JournalError::NoFile { .. } => {
            Failure::Input(error.into())
        }
        _ => Failure::Run(error.into()),
    }
}

/// Reads the journal at `path`, which must be one of `study`, without locking it.
pub fn read(study: &Study, path: &Path) -> Result<Contents, Failure> {
    let contents = read_journal_file(path).map_err(|error| match error {
        // Named by the user, or found a moment ago.
        JournalError::Unreadable { .. } => Failure::Input(error.into()),
        error => wrong(error),
    })?;
    match another_study(study, &contents.header) {
        Some(why) => Err(Failure::Input(anyhow!("{}: {why}", path.display()))),
        None => Ok(contents),
    }
}
