//! What is on record of a study: its journal, opened, checked and filled into a store.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use apportion::files::read_whole;
use apportion::run::journal::{Contents, Journal, JournalError, differences, read_journal};
use apportion::run::{MOST_KEPT, Piece, Shard, Store};
use apportion::study::Study;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

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

/// The runs of a study that are on record, and where more are put on record.
pub struct Record {
    pub store: Store,
    journal: Journal,
}

impl Record {
    /// Puts a piece on record.
    pub fn keep(&self, piece: &Piece) -> std::io::Result<()> {
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

/// Opens the record of `study` at `path` for parts whose journals have the header `part`, however quick its runs are. What
/// is there is used if it was evaluated with the same files as the parts, and else moved aside.
pub fn open_for_parts(study: &Study, path: &Path, part: &Value) -> Result<Record, Failure> {
    if path.exists() {
        match Journal::resume(path) {
            Ok((journal, contents)) => {
                let header = &contents.header;
                let others = || other_files(&header["files"], &part["files"]).map(changed);
                let Some(why) = another_study(study, header).or_else(others) else {
                    return recalled(study, (journal, contents), Use::IfThere);
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
    let mut header = header(study, None);
    header["files"] = part["files"].clone();
    let journal = Journal::create(path, &header).map_err(wrong)?;
    Ok(Record { store: Store::new(&study.design, study.model().as_ref()), journal })
}

/// Opens the record of `study` at `path`. A journal of something else, or one that is not wanted, is moved aside. `None`
/// if there is none and the runs are quicker than it is worth.
pub fn open(study: &Study, path: &Path, (how, shard): (Use, Option<Shard>)) -> Result<Option<Record>, Failure> {
    let required = matches!(how, Use::Require | Use::RequireButFailures);
    if path.exists() {
        let (journal, contents) = match Journal::resume(path) {
            Ok(found) => found,
            Err(error @ (JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. })) if !required => {
                move_aside(path, &error.to_string())?;
                return fresh(study, path, shard);
            }
            Err(error) => return Err(wrong(error)),
        };
        let why = match how {
            Use::Discard => Some("--restart".to_owned()),
            Use::IfThere => another_study(study, &contents.header).or_else(|| changed_files(study, &contents.header)),
            Use::Require | Use::RequireButFailures => {
                if let Some(why) = another_study(study, &contents.header) {
                    return Err(Failure::Input(anyhow!("{}: {why}", path.display())));
                }
                if let Some(why) = changed_files(study, &contents.header) {
                    say(&format!("warning: {why}; runs on record are those of before"));
                }
                None
            }
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
        return recalled(study, (journal, contents), how).map(Some);
    }
    if required {
        let what = "there is no journal here: nothing is on record to go on with";
        return Err(Failure::Input(anyhow!("{}: {what}", path.display())));
    }
    fresh(study, path, shard)
}

fn recalled(study: &Study, (journal, contents): (Journal, Contents), how: Use) -> Result<Record, Failure> {
    let store = filled(study, &contents);
    let path = journal.path().display();
    if contents.cut_off > 0 {
        let what = "behind its last whole record, of runs that are evaluated again";
        say(&format!("note: {path}: {} bytes were cut off {what}", contents.cut_off));
    }
    if how == Use::RequireButFailures {
        match store.forget_failures() {
            0 => say(&format!("note: no run on record in {path} has failed")),
            1 => say("note: the run that failed is evaluated again"),
            failed => say(&format!("note: the {failed} runs that failed are evaluated again")),
        }
    }
    Ok(Record { store, journal })
}

/// A store of what a journal of this study holds.
pub fn filled(study: &Study, contents: &Contents) -> Store {
    let model = study.model();
    let store = Store::new(&study.design, model.as_ref());
    let outputs = store.outputs();
    let fits = |piece: &&Piece| {
        let rows = piece.rows(outputs);
        let failures =
            piece.failures.iter().all(|(row, output, _)| u64::from(*row) < rows && (*output as usize) < outputs);
        piece.replicate < study.design.settings().replicates
            && failures
            && rows as usize * outputs == piece.values.len()
    };
    contents.pieces.iter().filter(fits).for_each(|piece| {
        store.insert(piece);
    });
    store
}

/// Rows of the design that are in `store`.
pub fn rows_on_record(study: &Study, store: &Store) -> u64 {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    (0..study.design.settings().replicates).map(|replicate| store.count(replicate, 0..rows).0).sum()
}

fn fresh(study: &Study, path: &Path, shard: Option<Shard>) -> Result<Option<Record>, Failure> {
    if shard.is_some() || keeps_journal(study)? { begin(study, path, shard).map(Some) } else { Ok(None) }
}

/// Whether a run of `study` keeps a journal: not a large one of quick runs, nor one beyond all memory.
pub fn keeps_journal(study: &Study) -> Result<bool, Failure> {
    let model = study.model();
    let bytes = study.design.rows().saturating_mul(8 * model.outputs().len() as u64);
    // What is on record is held in memory too: beyond what fits, a run goes without.
    Ok(model.concurrency().is_some() || bytes <= LARGE || bytes <= MOST_KEPT && seconds(study)? >= QUICK)
}

fn begin(study: &Study, path: &Path, shard: Option<Shard>) -> Result<Record, Failure> {
    let store = Store::new(&study.design, study.model().as_ref());
    let journal = Journal::create(path, &header(study, shard)).map_err(wrong)?;
    Ok(Record { store, journal })
}

/// What the whole run will take, in seconds, by its first runs.
fn seconds(study: &Study) -> Result<f64, Failure> {
    let begin = Instant::now();
    let pilot = super::pilot::pilot(study)?;
    // A pilot that took long is of a run that takes longer.
    Ok(pilot.seconds.max(begin.elapsed().as_secs_f64()))
}

fn header(study: &Study, shard: Option<Shard>) -> Value {
    json!({
        "study": study.name,
        "shard": shard.map(|shard| shard.to_string()),
        "identity": study.identity(),
        "files": files(study),
    })
}

/// The user's files that the outputs depend on, with their digests.
fn files(study: &Study) -> Value {
    let digest = |path: &PathBuf| {
        let bytes = read_whole(path).ok()?;
        let hex: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        Some((path.display().to_string(), json!(hex)))
    };
    Value::Object(study.subject.files().iter().filter_map(digest).collect())
}

/// Why a journal with this header is not one of `study`, if it is not.
pub fn another_study(study: &Study, header: &Value) -> Option<String> {
    let found = differences(&header["identity"], &study.identity());
    let name = header["study"].as_str().unwrap_or_default();
    (!found.is_empty()).then(|| format!("the journal is of another study ({name}): {}", found.join("; ")))
}

/// Which of the files that the study names are not those of a journal with this header, if any.
fn changed_files(study: &Study, header: &Value) -> Option<String> {
    other_files(&header["files"], &files(study)).map(changed)
}

fn changed(names: String) -> String {
    format!("{names} changed since the journal was written")
}

/// The names of files (path: digest) that are not the same before and now, if any. They are known by their names, so that a
/// study may move, and be called by any path.
pub fn other_files(before: &Value, now: &Value) -> Option<String> {
    let known = |files: &Value| -> BTreeSet<(String, String)> {
        let name = |path: &String| Path::new(path).file_name().map(|name| name.to_string_lossy().into_owned());
        let entries = files.as_object().into_iter().flatten();
        entries.filter_map(|(path, digest)| Some((name(path)?, digest.as_str()?.to_owned()))).collect()
    };
    let (before, now) = (known(before), known(now));
    let names: BTreeSet<&str> = before.symmetric_difference(&now).map(|(name, _)| name.as_str()).collect();
    let names: Vec<&str> = names.into_iter().collect();
    (!names.is_empty()).then(|| names.join(", "))
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
        JournalError::NotAJournal { .. } | JournalError::OtherVersion { .. } => Failure::Input(error.into()),
        _ => Failure::Run(error.into()),
    }
}

/// Reads the journal at `path`, which must be one of `study`, without locking it.
pub fn read(study: &Study, path: &Path) -> Result<Contents, Failure> {
    let bytes = read_whole(path)
        .map_err(|error| Failure::Input(anyhow!("{}: cannot read the journal: {error}", path.display())))?;
    let contents = read_journal(path, &bytes).map_err(wrong)?;
    match another_study(study, &contents.header) {
        Some(why) => Err(Failure::Input(anyhow!("{}: {why}", path.display()))),
        None => Ok(contents),
    }
}
