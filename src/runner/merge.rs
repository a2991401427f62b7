//! Merging of the parts of a run, evaluated anywhere, in one journal.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::journal::{self, RunJournal, recorded, refused};
use super::model_files::differing;
use crate::model::Messages;
use crate::run::{OutputSink as _, RunError, Shard, Store};
use crate::study::Study;

/// Returns the journal at `path` extended by the contents of `journals`, the whole of the design.
pub(super) fn merged(
    study: &Study,
    path: &Path,
    journals: &[PathBuf],
    messages: &Messages,
) -> Result<RunJournal, RunError> {
    let files = files_of_all(study, journals)?;
    let record = journal::open_for_parts(study, path, &files, messages)?;
    let store = &record.store;
    let mut shards = Shards::default();
    for journal in journals {
        let contents = journal::read(study, journal)?;
        let part = recorded(study, &contents);
        shards.note(study, contents.header["shard"].as_str(), &part);
        for piece in part.pieces() {
            let rows = piece.first..piece.first + piece.rows(part.outputs());
            let gaps = store.missing(piece.replicate, rows.clone());
            // Counts over a piece cannot be divided.
            if piece.is_counted() && gaps.iter().any(|gap| *gap != rows) {
                let why = "holds some runs that are already merged and some that are not: merge the shards of one \
                           run only, into a folder without a journal (--out)";
                return Err(refused(journal, why.to_owned()));
            }
            for piece in gaps.into_iter().filter_map(|gap| part.piece(piece.replicate, gap)) {
                store.insert(&piece);
                record.append(&piece).map_err(|source| RunError::NotKept { source })?;
            }
        }
    }
    record.sync()?;
    let (total, present) = (study.design.rows(), journal::rows_on_record(study, store));
    if present == total {
        return Ok(record);
    }
    Err(RunError::Incomplete {
        missing: total - present,
        total,
        places: shards.in_words().unwrap_or_else(|| "the journals are not the shards of one run".to_owned()),
    })
}

/// Checks, before any change, that all journals are of this study and the same files; returns these files.
fn files_of_all(study: &Study, journals: &[PathBuf]) -> Result<Value, RunError> {
    let mut first: Option<(&PathBuf, Value)> = None;
    for journal in journals {
        let files = journal::read(study, journal)?.header["files"].take();
        let (other, known) = first.get_or_insert_with(|| (journal, files.clone()));
        if let Some(names) = differing(known, &files) {
            let other = other.display();
            let reason = format!("evaluated with another {names} than {other}: evaluate one of the two shards again");
            return Err(refused(journal, reason));
        }
    }
    Ok(first.map_or(Value::Null, |(_, files)| files))
}

/// The parts found: the number of missing runs of each, by the number of parts and their own.
#[derive(Default)]
struct Shards(BTreeMap<u64, BTreeMap<u64, u64>>);

impl Shards {
    fn note(&mut self, study: &Study, name: Option<&str>, store: &Store) {
        let Some(shard) = name.and_then(|name| name.parse::<Shard>().ok()) else { return };
        let rows = shard.rows(&study.design);
        let lacking = rows.into_iter().flat_map(|(replicate, rows)| store.missing(replicate, rows));
        let lacking = lacking.map(|rows| rows.end - rows.start).sum();
        self.0.entry(shard.count()).or_default().insert(shard.number(), lacking);
    }

    /// Lists the parts that are missing or incomplete; `None` if the journals are not of one division into parts.
    fn in_words(&self) -> Option<String> {
        const SHOWN: usize = 8;
        let (of, found) = self.0.iter().next().filter(|_| self.0.len() == 1)?;
        let state = |number: u64| match found.get(&number) {
            None => Some(format!("there is no journal of shard {number}/{of}")),
            Some(0) => None,
            Some(lacking) => Some(format!("shard {number}/{of} lacks {lacking} runs")),
        };
        let mut states: Vec<String> = (1..=*of).filter_map(state).take(SHOWN + 1).collect();
        if states.len() > SHOWN {
            states[SHOWN] = "and more".to_owned();
        }
        (!states.is_empty()).then(|| states.join(", "))
    }
}
