//! `apportion analyze`: indices from the outputs of an external model.

mod salib;

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::Warning;
use apportion::analysis::unlikely_outputs;
use apportion::files::read_text;
use apportion::quantity::Unit;
use apportion::run::Store;
use apportion::study::Study;
use apportion_files::exchange::{AnswersRequest, Manifest, Missing, open_table, read_answers};

use super::live::LiveArguments;
use super::output::OutputArguments;
use super::run::{deliver, with_inputs};
use super::table::{TableArguments, say_of_table};
use super::{Failure, Threads, say, say_notes};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  apportion analyze outputs.csv --design design.csv\n  \
                        apportion analyze design.csv --outputs y      (the design file with a column y added)\n  \
                        apportion analyze y.npy --layout salib --names x1,x2,x3")]
pub struct Arguments {
    /// The outputs: one row for each point, in the order of the points, with or without the points (CSV or NPY)
    data: PathBuf,
    #[command(flatten)]
    table: TableArguments,
    /// The file of points that `sample` wrote, with its manifest next to it [default: DATA]
    #[arg(long, value_name = "FILE", conflicts_with = "layout")]
    design: Option<PathBuf>,
    /// The manifest, if it is not next to the points
    #[arg(long, value_name = "FILE", conflicts_with_all = ["design", "layout"])]
    manifest: Option<PathBuf>,
    /// Columns that are outputs, separated by commas [default: those of the study, or all that are not factors]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    outputs: Vec<String>,
    /// Unit of an output, if it differs from the study: force=nN
    #[arg(long, value_name = "NAME=UNIT", value_delimiter = ',', value_parser = output_unit, conflicts_with = "layout")]
    units: Vec<(String, Unit)>,
    /// Count rows without a finite output as runs that failed, instead of refusing the file
    #[arg(long, conflicts_with = "layout")]
    missing_as_failed: bool,
    /// Points made by another program: `salib` for SALib's sample.sobol and sample.saltelli
    #[arg(long, value_name = "LAYOUT", value_parser = ["salib"])]
    layout: Option<String>,
    #[command(flatten)]
    salib: salib::SalibArguments,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    live: LiveArguments,
    #[command(flatten)]
    threads: Threads,
}

fn output_unit(text: &str) -> Result<(String, Unit), String> {
    let (name, unit) = text.split_once('=').ok_or("expected NAME=UNIT, as in force=nN")?;
    Ok((name.trim().to_owned(), Unit::label(unit)))
}

/// A table of outputs as the runs of a study.
struct Read {
    study: Study,
    store: Store,
    /// A sentence on the unlikely value of each output, if it has one.
    unlikely: Vec<Option<String>>,
}

pub fn analyze(arguments: &Arguments) -> Result<(), Failure> {
    let read = if arguments.layout.is_some() { salib::study(arguments)? } else { of_design(arguments)? };
    let Read { study, store, unlikely } = read;
    say_notes(&study);
    let artefacts = arguments.output.artefacts(study.name()).next_to_input(&arguments.data);
    artefacts.prepare()?;
    let runner = study.runner().threads(arguments.threads.number()).store(&store);
    let mut result = runner.run().map_err(|error| with_inputs(&study, error))?;
    for (output, unlikely) in result.outputs.iter_mut().zip(unlikely) {
        output.warnings.splice(0..0, unlikely.map(|text| Warning::Unlikely { text }));
    }
    deliver(&study, &artefacts, &result, &arguments.live)
}

/// The outputs of a design that `sample` wrote.
fn of_design(arguments: &Arguments) -> Result<Read, Failure> {
    let data = arguments.data.display();
    let path = manifest_path(arguments)?;
    let of_manifest = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{}: {error}", path.display()));
    let text = read_text(&path).map_err(|error| of_manifest(&format!("cannot read the manifest: {error}")))?;
    let manifest = Manifest::parse(&text).map_err(|error| of_manifest(&error))?;
    let missing = if arguments.missing_as_failed { Missing::Drop } else { Missing::Refuse };
    let request = AnswersRequest { manifest: &manifest, outputs: &arguments.outputs, units: &arguments.units, missing };
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{data}: {error}"));
    let mut reader = open_table(&arguments.data, &arguments.table.options(&[])).map_err(|error| wrong(&error))?;
    let answers = read_answers(reader.as_mut(), &request).map_err(|error| wrong(&error))?;
    say_of_table(&arguments.data, &[], reader.is_unended());
    match answers.compared.len() {
        0 => say("note: the file has no points: its rows are assumed to be in the order of the design"),
        _ => say("the points in the file are those of the design, in its order"),
    }
    let unlikely = unlikely_outputs(&answers.study, &answers.store);
    Ok(Read { study: answers.study, store: answers.store, unlikely })
}

/// The manifest that was named, or the one next to the points.
fn manifest_path(arguments: &Arguments) -> Result<PathBuf, Failure> {
    if let Some(manifest) = &arguments.manifest {
        return Ok(manifest.clone());
    }
    let points: &Path = arguments.design.as_deref().unwrap_or(&arguments.data);
    let beside = Manifest::path_for(points);
    if beside.exists() {
        return Ok(beside);
    }
    Err(Failure::Input(anyhow!(
        "{}: there is no {} that describes these points: give the file that `apportion sample` wrote (--design) \
         or its manifest (--manifest); for points made by SALib, --layout salib",
        arguments.data.display(),
        beside.display()
    )))
}
