//! `apportion merge`: the parts of a run, evaluated anywhere, as one result.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::report::prepare_folder;
use apportion::run::{Piece, Shard, Store};
use apportion::study::Study;
use apportion::{Running, analyse_with};
use serde_json::Value;

use super::model_files::differing;
use super::output::{ChartArguments, default_folder};
use super::record::{self, journal_path};
use super::run::{deliver, file_names};
use super::{DesignChanges, Failure, StudyArguments, Threads, say};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The journals of the parts [default: all NAME-shard-I-of-N.journal in the folder for the results]
    journals: Vec<PathBuf>,
    #[command(flatten)]
    design: DesignChanges,
    /// Folder for the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    charts: ChartArguments,
    #[command(flatten)]
    threads: Threads,
}

pub fn merge(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&study.name));
    let journals =
        if arguments.journals.is_empty() { in_folder(&folder, &study.name)? } else { arguments.journals.clone() };
    prepare_folder(&folder)?;
    let artefacts = arguments.charts.artefacts(&folder);
    artefacts.check(&file_names(&study))?;
    let files = files_of_all(&study, &journals)?;
    let path = journal_path(&folder, &study.name, None);
    // The merged runs are put on record whatever their number: they may have cost much elsewhere.
    let record = record::open_for_parts(&study, &path, &files)?;
    let mut shards = Shards::default();
    for journal in &journals {
        let contents = record::read(&study, journal)?;
        let (part, _) = record::part(&study, (journal, &contents))?;
        shards.note(&study, contents.header["shard"].as_str(), &part);
        for piece in part.pieces() {
            let rows = piece.first..piece.first + piece.rows(part.outputs());
            let gaps = record.store.missing(piece.replicate, rows.clone());
            if gaps.iter().map(|gap| gap.end - gap.start).sum::<u64>() == rows.end - rows.start {
                keep(&record, &piece)?;
                continue;
            }
            // What is counted over a piece cannot be divided.
            let counted = piece.flags.iter().any(|raised| *raised > 0) || !piece.effort.is_none();
            if counted && !gaps.is_empty() {
                let why = "holds some of the runs that are there already, and some that are not: merge the parts of one \
                           division only, into a folder without a journal (--out)";
                return Err(Failure::Input(anyhow!("{}: {why}", journal.display())));
            }
            for gap in gaps {
                part.piece(piece.replicate, gap).map_or(Ok(()), |piece| keep(&record, &piece))?;
            }
        }
    }
    record.sync()?;
    let missing = missing(&study, &record.store);
    if !missing.is_empty() {
        return Err(Failure::Run(anyhow!(
            "{} of {} runs are missing: {}\nthose that are there are kept in {}: merge again with the missing parts, or let \
             `apportion run {} --resume` evaluate them here",
            missing.iter().map(|(_, rows)| rows.end - rows.start).sum::<u64>(),
            study.design.rows(),
            shards.in_words().unwrap_or_else(|| in_words(&study, &missing)),
            path.display(),
            arguments.study.study.display(),
        )));
    }
    say(&format!(
        "{}: {} runs of {} are merged in {}",
        study.name,
        study.design.rows(),
        if journals.len() == 1 { "1 journal".to_owned() } else { format!("{} journals", journals.len()) },
        path.display()
    ));
    let running = Running { store: Some(&record.store), ..Running::on(arguments.threads.number()) };
    let result = analyse_with(&study, running)?;
    deliver(&study, &artefacts, &result)
}

/// Checks, before anything is touched, that all journals are of this study and were evaluated with the same files; these
/// files.
fn files_of_all(study: &Study, journals: &[PathBuf]) -> Result<Value, Failure> {
    let mut first: Option<(&PathBuf, Value)> = None;
    for journal in journals {
        let contents = record::read(study, journal)?;
        let (_, files) = record::part(study, (journal, &contents))?;
        let Some((other, known)) = &first else {
            first = Some((journal, files));
            continue;
        };
        if let Some(names) = differing(known, &files) {
            return Err(Failure::Input(anyhow!(
                "{}: evaluated with another {names} than {}: evaluate one of the two parts again",
                journal.display(),
                other.display()
            )));
        }
    }
    Ok(first.map_or(Value::Null, |(_, files)| files))
}

fn keep(record: &record::Record, piece: &Piece) -> Result<(), Failure> {
    record.store.insert(piece);
    record
        .keep(piece)
        .map_err(|error| Failure::Run(anyhow!("{}: cannot write the journal: {error}", record.path().display())))
}

/// The journals of shards in `folder`, in the order of their names.
fn in_folder(folder: &Path, name: &str) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |error| Failure::Input(anyhow!("{}: cannot look for journals: {error}", folder.display()));
    let begin = format!("{name}-shard-");
    let mut found = Vec::new();
    let entries = match std::fs::read_dir(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        entries => Some(entries.map_err(unreadable)?),
    };
    for entry in entries.into_iter().flatten() {
        let path = entry.map_err(unreadable)?.path();
        let file = path.file_name().and_then(|file| file.to_str()).unwrap_or_default();
        if file.starts_with(&begin) && file.ends_with(".journal") {
            found.push(path);
        }
    }
    found.sort();
    if found.is_empty() {
        let what = format!("no {begin}I-of-N.journal is here: `apportion run STUDY --shard I/N` writes them");
        return Err(Failure::Input(anyhow!("{}: {what}", folder.display())));
    }
    Ok(found)
}

/// Rows of the design that the store lacks.
fn missing(study: &Study, store: &Store) -> Vec<(u64, std::ops::Range<u64>)> {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    let replicates = 0..study.design.settings().replicates;
    replicates
        .flat_map(|replicate| store.missing(replicate, 0..rows).into_iter().map(move |r| (replicate, r)))
        .collect()
}

fn in_words(study: &Study, missing: &[(u64, std::ops::Range<u64>)]) -> String {
    const SHOWN: usize = 3;
    let per_point = study.design.rows_per_point();
    let place = |(replicate, rows): &(u64, std::ops::Range<u64>)| {
        format!(
            "base points {} to {} of replicate {}",
            rows.start / per_point,
            (rows.end - 1) / per_point,
            replicate + 1
        )
    };
    let mut places: Vec<String> = missing.iter().take(SHOWN).map(place).collect();
    if missing.len() > SHOWN {
        places.push("and more".to_owned());
    }
    places.join(", ")
}

/// The parts that were found: how many of their runs each lacks, by the number of parts and their own.
#[derive(Default)]
struct Shards(BTreeMap<u64, BTreeMap<u64, u64>>);

impl Shards {
    fn note(&mut self, study: &Study, name: Option<&str>, store: &Store) {
        let Some(shard) = name.and_then(|name| name.parse::<Shard>().ok()) else { return };
        let rows = shard.rows(&study.design);
        let lacking = rows.into_iter().flat_map(|(replicate, rows)| store.missing(replicate, rows));
        let lacking = lacking.map(|rows| rows.end - rows.start).sum();
        self.0.entry(shard.of()).or_default().insert(shard.number(), lacking);
    }

    /// Which parts are missing or incomplete; `None` if the journals are not of one division into parts.
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
