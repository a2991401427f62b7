//! `apportion analyze`: indices from the outputs of an external model, at points of `sample`.

use std::path::{Path, PathBuf};

use apportion::Warning;
use apportion::result::RunFacts;
use apportion::screening::{ScreeningSettings, screen_stored};
use apportion_base::files::read_text;
use apportion_base::quantity::{Unit, Unlikely};
use apportion_files::exchange::{Answers, AnswersRequest, Manifest, Missing, open_table, read_answers};
use apportion_report::screening::{build_screening, screening_document};

use super::output::{self, OutputArguments};
use super::run::{deliver, with_inputs};
use super::table::{TableArguments, say_of_table};
use super::{Threads, say, say_notes};
use crate::failure::{OfFile, bad_input};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  apportion analyze outputs.csv --design design.csv\n  \
                        apportion analyze design.csv --outputs y      (the design file with a column y added)")]
pub struct Arguments {
    /// The outputs: one row for each point, in the order of the points, with or without the points (CSV or NPY)
    data: PathBuf,
    #[command(flatten)]
    table: TableArguments,
    /// The file of points that `sample` wrote, with its manifest next to it [default: DATA]
    #[arg(long, value_name = "FILE")]
    design: Option<PathBuf>,
    /// The manifest, if it is not next to the points
    #[arg(long, value_name = "FILE", conflicts_with = "design")]
    manifest: Option<PathBuf>,
    /// Columns that are outputs, separated by commas [default: those of the study, or all that are not factors]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    outputs: Vec<String>,
    /// Unit of an output, if it differs from the study: force=nN
    #[arg(long, value_name = "NAME=UNIT", value_delimiter = ',', value_parser = output_unit)]
    units: Vec<(String, Unit)>,
    /// Count rows without a finite output as runs that failed, instead of refusing the file
    #[arg(long)]
    missing_as_failed: bool,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    threads: Threads,
}

fn output_unit(text: &str) -> Result<(String, Unit), String> {
    let (name, unit) = text.split_once('=').ok_or("expected NAME=UNIT, as in force=nN")?;
    Ok((name.trim().to_owned(), Unit::label(unit)))
}

pub fn analyze(arguments: &Arguments) -> anyhow::Result<()> {
    let (Answers { study, store, .. }, screening) = answers(arguments)?;
    say_notes(&study);
    let inputs = study.files().into_iter().chain([arguments.data.clone(), manifest_path(arguments)?]);
    let inputs = inputs.chain(arguments.design.clone()).collect();
    let ending = if screening.is_some() { "-screen" } else { "" };
    let artefacts = arguments.output.artefacts(study.name(), inputs).prepare(&format!("{}{ending}", study.name()))?;
    if let Some(settings) = screening {
        let model = study.model();
        let screening = screen_stored(&study, settings, &store)?;
        let file = build_screening(&study, model.as_ref(), &screening, RunFacts::default());
        return output::deliver(&artefacts, &screening_document(&file));
    }
    let unlikely = study.unlikely_outputs(&store);
    let runner = study.runner().threads(arguments.threads.number()).store(&store);
    let mut result = runner.run().map_err(|error| with_inputs(&study, error))?;
    for (output, unlikely) in result.outputs.iter_mut().zip(unlikely) {
        if let Some(Unlikely { value, .. }) = unlikely {
            say(&format!("note: --missing-value={value:?} reads {value:?} of {} as a missing value", output.name));
        }
        output.warnings.splice(0..0, unlikely.map(Warning::UnlikelyInTable));
    }
    deliver(&study, &artefacts, &result)
}

/// The outputs of a design that `sample` wrote, and the settings of the screening, if it is one.
fn answers(arguments: &Arguments) -> anyhow::Result<(Answers, Option<ScreeningSettings>)> {
    let path = manifest_path(arguments)?;
    let text = read_text(&path).map_err(|error| format!("cannot read the manifest: {error}")).in_file(&path)?;
    let manifest = Manifest::parse(&text).in_file(&path)?;
    let missing = if arguments.missing_as_failed { Missing::Drop } else { Missing::Refuse };
    let request = AnswersRequest { manifest: &manifest, outputs: &arguments.outputs, units: &arguments.units, missing };
    let mut reader = open_table(&arguments.data, &arguments.table.options(&[])).in_file(&arguments.data)?;
    let answers = read_answers(reader.as_mut(), &request).in_file(&arguments.data)?;
    say_of_table(&arguments.data, &[], reader.is_unended());
    match answers.compared.len() {
        0 => say("note: the file has no points: its rows are assumed to be in the order of the design"),
        _ => say("the points in the file are those of the design, in its order"),
    }
    Ok((answers, manifest.screening()))
}

/// The manifest that was named, or the one next to the points.
fn manifest_path(arguments: &Arguments) -> anyhow::Result<PathBuf> {
    if let Some(manifest) = &arguments.manifest {
        return Ok(manifest.clone());
    }
    let points: &Path = arguments.design.as_deref().unwrap_or(&arguments.data);
    let manifest_path = Manifest::path_for(points);
    if manifest_path.exists() {
        return Ok(manifest_path);
    }
    Err(bad_input(format!(
        "{}: there is no {} that describes these points: give the file that `apportion sample` wrote (--design) \
         or its manifest (--manifest)",
        arguments.data.display(),
        manifest_path.display()
    )))
}
