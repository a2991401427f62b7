//! `apportion run`: runs a study file and writes its results.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::anyhow;
use apportion::result::{OutputResult, StudyResult};
use apportion::run::{RunError, Shard, Store};
use apportion::study::Study;
use apportion_base::digest::sha256_of_file;
use apportion_files::exchange::{Format, Points, write_rows};
use apportion_report::{Artefacts, FileList, prepare_file, run_document, stream_atomically};

use super::journal::{JournalArguments, with_journal};
use super::output::{self, OutputArguments};
use super::progress::Meter;
use super::ranks::{self, Ranks};
use super::stop::Stoppable;
use super::{DesignChanges, StudyArguments, Threads, say};
use crate::failure::{OfFile, bad_input};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    threads: Threads,
    /// Also write the points and outputs of all runs to a file (.csv or .npy)
    #[arg(long, value_name = "FILE", conflicts_with = "shard")]
    save_outputs: Option<PathBuf>,
    #[command(flatten)]
    journal: JournalArguments,
    /// Evaluate one of N shards of the runs and write its own journal, for `apportion merge`
    #[arg(long, value_name = "I/N", conflicts_with_all = ["no_journal", "retry_failed"])]
    shard: Option<Shard>,
}

pub fn run(arguments: &Arguments, mpi_ranks: Option<&dyn Ranks>) -> anyhow::Result<()> {
    if arguments.shard.is_none() {
        ranks::refuse_copies()?;
    }
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let folder = arguments.output.folder(study.name());
    let journal = arguments.journal.path(&folder, study.name(), arguments.shard);
    let artefacts = arguments.output.artefacts(study.name(), study.files());
    let artefacts = Artefacts { journal: journal.clone(), other: arguments.save_outputs.clone(), ..artefacts };
    let artefacts = artefacts.prepare(study.name())?;
    if arguments.shard.is_some() && study.target().grows() {
        return Err(bad_input(format!("--shard: {}", RunError::NoSize)));
    }
    let mut saved = None;
    if let Some(path) = &arguments.save_outputs {
        if study.target().accuracy.is_some() {
            let why = "with `accuracy` the run chooses its rows: run again with the lines that the result shows";
            return Err(bad_input(format!("--save-outputs: {why}")));
        }
        let format = Format::from_path(path).in_file(path)?;
        prepare_file(path)?;
        saved = Some((path, format, Store::new(study.model().as_ref())));
    }
    let meter = Meter::new(study.name(), study.design().rows());
    let runner = study.runner().threads(arguments.threads.number()).on_progress(|progress| meter.update(progress));
    let runner = match mpi_ranks {
        None => runner,
        Some(mpi_ranks) => {
            // A job has a rank for every core by default.
            let threads = arguments.threads.number().max(1);
            let ranks = mpi_ranks.begin(&study, &arguments.study.study, threads)?;
            let workers = if threads == 1 { "a worker".to_owned() } else { format!("{threads} workers") };
            say(&format!("note: {ranks} ranks with {workers} each"));
            runner.threads(threads).remote_workers(mpi_ranks)
        }
    };
    // Only here, so that an earlier wait for input that never arrives can be interrupted at once.
    let mut runner = arguments.journal.keep(runner, journal.as_deref());
    if let Some((_, _, store)) = &saved {
        runner = runner.store(store);
    }
    if let Some((shard, journal)) = arguments.shard.zip(journal.as_ref()) {
        let begun = Instant::now();
        let rows = runner.run_shard(shard).map_err(|error| with_journal(error, Some(journal)))?;
        meter.finish(rows, begun.elapsed().as_secs_f64());
        say(&format!("{}: the {rows} runs of shard {shard} are in {}", study.name(), journal.display()));
        return Ok(());
    }
    let result = runner.run().map_err(|error| with_journal(with_inputs(&study, error), journal.as_deref()))?;
    let (runs, seconds) = (result.provenance.model_runs, result.provenance.wall_seconds);
    match &result.spending {
        Some(spending) => meter.finish_after(spending.runs.saturating_sub(runs), runs, seconds),
        None => meter.finish(runs, seconds),
    }
    if let Some(saved) = &saved {
        save(&study, &result, saved)?;
        FileList::open(&folder, study.name())?.add(saved.0, &sha256_of_file(saved.0)?)?;
    }
    deliver(&study, &artefacts, &result)
}

/// Writes points and outputs of all runs, which may be more than the study began with.
fn save(study: &Study, result: &StudyResult, (path, format, store): &(&PathBuf, Format, Store)) -> anyhow::Result<()> {
    let settings = study.design().settings();
    let design = study.design().with_points(result.provenance.base_samples / settings.replicates)?;
    stream_atomically(path, |out| {
        write_rows(study, &Points::Design(&design), Some(store), *format, &mut Stoppable::new(out))
    })?;
    say(&format!("wrote the points and outputs of {} runs to {}", design.rows(), path.display()));
    Ok(())
}

/// Writes the files of a result, and says what came out.
pub fn deliver(study: &Study, artefacts: &Artefacts, result: &StudyResult) -> anyhow::Result<()> {
    output::deliver(artefacts, &run_document(result))?;
    let lost: Vec<&OutputResult> = result.outputs.iter().filter(|output| is_lost(study, output)).collect();
    let Some(first) = lost.first() else { return Ok(()) };
    let others = if lost.len() > 1 { format!(" and of {} more outputs", lost.len() - 1) } else { String::new() };
    Err(anyhow!(
        "no indices of {}{others}: too many runs failed (max_failed = {} in [analysis]; the result lists them with their reasons)",
        first.name,
        study.analysis().max_failed
    ))
}

/// Whether an output has no indices because runs failed, and not because it does not vary.
fn is_lost(study: &Study, output: &OutputResult) -> bool {
    let share = output.runs_failed as f64 / (output.runs_ok + output.runs_failed) as f64;
    let too_many = share > study.analysis().max_failed || output.base_points_used < 2;
    output.indices.is_none() && output.runs_failed > 0 && too_many
}

/// Adds the inputs of the failed row to an error.
pub fn with_inputs(study: &Study, error: RunError) -> anyhow::Error {
    match &error {
        RunError::RowFailed { row, .. } => {
            anyhow!("{error}\nthe run's inputs: {}", study.inputs_in_words(*row))
        }
        _ => error.into(),
    }
}
