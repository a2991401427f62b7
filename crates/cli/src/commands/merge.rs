//! `apportion merge`: joins the parts of a run to one result.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::run::RunError;
use apportion_report::Artefacts;

use super::journal::journal_path;
use super::output::OutputArguments;
use super::run::deliver;
use super::{DesignChanges, StudyArguments, Threads, counted, say};
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The journals of the shards [default: all NAME-shard-I-of-N.journal in the folder for the results]
    journals: Vec<PathBuf>,
    #[command(flatten)]
    design: DesignChanges,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    threads: Threads,
}

pub fn merge(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let folder = arguments.output.folder(study.name());
    let journals =
        if arguments.journals.is_empty() { in_folder(&folder, study.name())? } else { arguments.journals.clone() };
    let path = journal_path(&folder, study.name(), None);
    let inputs = [study.files(), journals.clone()].concat();
    let artefacts = Artefacts { journal: Some(path.clone()), ..arguments.output.artefacts(study.name(), inputs) };
    let artefacts = artefacts.prepare(study.name())?;
    let runner = study.runner().threads(arguments.threads.number()).on_message(say).journal(&path);
    let result = runner.merge(&journals).map_err(|error| match error {
        RunError::Incomplete { .. } => anyhow!(
            "{error}\nthe merged runs are saved in {}: merge again with the missing shards, or evaluate the others here with the same \
             arguments for `apportion run` and --resume",
            path.display(),
        ),
        error => error.into(),
    })?;
    say(&format!(
        "{}: {} runs of {} are merged in {}",
        study.name(),
        study.design().rows(),
        counted(journals.len() as u64, "journal"),
        path.display()
    ));
    deliver(&study, &artefacts, &result)
}

/// The journals of shards in `folder`, in the order of their names.
fn in_folder(folder: &Path, name: &str) -> anyhow::Result<Vec<PathBuf>> {
    let begin = format!("{name}-shard-");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut journals: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    journals.retain(|path| {
        let file = path.file_name().and_then(|file| file.to_str()).unwrap_or_default();
        file.starts_with(&begin) && file.ends_with(".journal")
    });
    journals.sort();
    if journals.is_empty() {
        let what = format!("found no {begin}I-of-N.journal: `apportion run STUDY --shard I/N` writes these files");
        return Err(bad_input(format!("{}: {what}", folder.display())));
    }
    Ok(journals)
}
