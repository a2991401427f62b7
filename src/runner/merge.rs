//! Merging of the shards of a run in one journal.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::journal::{self, RunJournal, recorded};
use crate::model::Messages;
use crate::run::journal::JournalProblem;
use crate::run::{RunError, Shard, Store, differing, record};
use crate::study::Study;

/// Returns the journal at `path` extended by the contents of `journals`, with all rows of the design.
pub(super) fn merged(
    study: &Study,
    path: &Path,
    journals: &[PathBuf],
    messages: &Messages,
) -> Result<RunJournal, RunError> {
    let files = files_of_all(study, journals)?;
    let merged = journal::open_for_parts(study, path, &files, messages)?;
    let store = &merged.store;
    let mut shards = Shards::default();
    for journal in journals {
        let contents = journal::read(study, journal)?;
        let part = recorded(study, contents.blocks);
        shards.note(study, contents.header["shard"].as_str(), &part);
        for block in part.blocks() {
            let rows = block.first..block.first + block.rows(part.outputs());
            let gaps = store.missing(block.replicate, rows.clone());
            // Counts over a block cannot be divided.
            if block.is_counted() && gaps.iter().any(|gap| *gap != rows) {
                return Err(JournalProblem::PartlyMerged.at(journal).into());
            }
            for block in gaps.into_iter().filter_map(|gap| part.block(block.replicate, gap)) {
                record(&merged.open, &block)?;
                store.insert(block);
            }
        }
    }
    merged.finish()?;
    let (total, present) = (study.design.rows(), journal::rows_on_record(study, store));
    if present == total {
        return Ok(merged);
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
        let (other, expected) = first.get_or_insert_with(|| (journal, files.clone()));
        if let Some(files) = differing(expected, &files) {
            return Err(JournalProblem::OtherFiles { files, other: other.clone() }.at(journal).into());
        }
    }
    Ok(first.map_or(Value::Null, |(_, files)| files))
}

/// The number of missing runs of every shard, by the number of shards and its number.
#[derive(Default)]
struct Shards(BTreeMap<u64, BTreeMap<u64, u64>>);

impl Shards {
    fn note(&mut self, study: &Study, name: Option<&str>, store: &Store) {
        let Some(shard) = name.and_then(|name| name.parse::<Shard>().ok()) else { return };
        let rows = shard.rows(&study.design);
        let missing = rows.into_iter().flat_map(|(replicate, rows)| store.missing(replicate, rows));
        let missing = missing.map(|rows| rows.end - rows.start).sum();
        self.0.entry(shard.count()).or_default().insert(shard.number(), missing);
    }

    /// Lists the shards that are missing or incomplete; `None` if the journals are not of one division into shards.
    fn in_words(&self) -> Option<String> {
        const SHOWN: usize = 8;
        let (count, shards) = self.0.iter().next().filter(|_| self.0.len() == 1)?;
        let incomplete = (1..=*count).filter_map(|number| match shards.get(&number) {
            None => Some(format!("there is no journal of shard {number}/{count}")),
            Some(0) => None,
            Some(missing) => Some(format!("shard {number}/{count} lacks {missing} runs")),
        });
        let mut states: Vec<String> = incomplete.take(SHOWN + 1).collect();
        if states.len() > SHOWN {
            states[SHOWN] = "and more".to_owned();
        }
        (!states.is_empty()).then(|| states.join(", "))
    }
}
