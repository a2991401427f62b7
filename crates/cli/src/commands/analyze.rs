//! `apportion analyze`: indices from the outputs of an external model, at points of `sample` or of SALib.

use std::path::{Path, PathBuf};

use apportion::given::Column;
use apportion::run::Store;
use apportion::salib::{SalibError, SalibLayout, SalibProblem, salib_study};
use apportion::study::Study;
use apportion::{Unlikely, Warning};
use apportion_base::files::read_text;
use apportion_base::quantity::Unit;
use apportion_files::exchange::{
    AnswersRequest, ColumnKind, Manifest, Missing, RowReader, first_output, open_table, output_columns, read_answers,
};

use super::output::{OutputArguments, stem};
use super::run::{deliver, with_inputs};
use super::table::{TableArguments, say_of_table};
use super::{Threads, number_in, say, say_notes};
use crate::failure::{OfFile, bad_input};

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
    salib: SalibArguments,
    #[command(flatten)]
    output: OutputArguments,
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
    /// The unlikely value of each output, if it has one.
    unlikely: Vec<Option<Unlikely>>,
}

pub fn analyze(arguments: &Arguments) -> anyhow::Result<()> {
    let read = if arguments.layout.is_some() { of_salib(arguments)? } else { of_design(arguments)? };
    let Read { study, store, unlikely } = read;
    say_notes(&study);
    let artefacts = arguments.output.prepared(study.name())?.next_to_input(&arguments.data);
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

/// The outputs of a design that `sample` wrote.
fn of_design(arguments: &Arguments) -> anyhow::Result<Read> {
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
    let unlikely = answers.study.unlikely_outputs(&answers.store);
    Ok(Read { study: answers.study, store: answers.store, unlikely })
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
         or its manifest (--manifest); for points made by SALib, --layout salib",
        arguments.data.display(),
        manifest_path.display()
    )))
}

#[derive(clap::Args)]
struct SalibArguments {
    /// SALib's problem as JSON (names, groups), or a study (.toml) with the same inputs in the same order
    #[arg(long, value_name = "FILE", requires = "layout", conflicts_with = "names")]
    problem: Option<PathBuf>,
    /// Names of the inputs in SALib's order, separated by commas [default: all columns that are not outputs]
    #[arg(long, value_name = "NAMES", requires = "layout", value_delimiter = ',')]
    names: Vec<String>,
    /// The points were made with second order (calc_second_order=True, SALib's default)
    #[arg(long, requires = "layout", conflicts_with = "first_order_only")]
    second_order: bool,
    /// The points were made without second order (calc_second_order=False)
    #[arg(long, requires = "layout")]
    first_order_only: bool,
    /// Number of resamples of the bootstrap for the intervals; 0 for the delta method instead
    #[arg(long, value_name = "N", requires = "layout", default_value_t = 1000, value_parser = resamples)]
    resamples: usize,
    /// Seed of the bootstrap
    #[arg(long, value_name = "S", requires = "layout", default_value_t = 0)]
    seed: u64,
}

fn resamples(text: &str) -> Result<usize, String> {
    if text == "0" { Ok(0) } else { number_in(text, 100..=1_000_000).map_err(|error| format!("{error}, or 0")) }
}

/// The outputs in a table in SALib's order, as the runs of a study.
fn of_salib(arguments: &Arguments) -> anyhow::Result<Read> {
    let path = &*arguments.data;
    let mut reader = open_table(path, &arguments.table.options(&[])).in_file(path)?;
    let problem = problem(&arguments.salib)?;
    let input_names = problem.as_ref().map(|problem| problem.inputs.clone());
    let (inputs, outputs) = columns(reader.as_ref(), input_names, &arguments.outputs).in_file(path)?;
    let problem = match problem {
        Some(problem) => problem,
        None => SalibProblem::of_inputs(inputs.iter().map(|(_, name)| name.clone()).collect()).in_file(path)?,
    };
    let wanted: Vec<(usize, ColumnKind)> =
        inputs.iter().chain(&outputs).map(|(place, name)| (*place, ColumnKind::numbers(name))).collect();
    let (mut all, mut part) = (vec![Vec::new(); wanted.len()], vec![Vec::new(); wanted.len()]);
    while reader.read(&wanted, 1 << 13, &mut part).in_file(path)? > 0 {
        for (all, part) in all.iter_mut().zip(&part) {
            all.extend_from_slice(part);
        }
    }
    say_of_table(path, &[], reader.is_unended());
    let values = all.split_off(inputs.len());
    let outputs: Vec<Column> =
        outputs.into_iter().zip(values).map(|((_, name), values)| Column { name, values }).collect();
    let inputs: Vec<(String, Vec<f64>)> = inputs.into_iter().map(|(_, name)| name).zip(all).collect();
    for (name, column) in &inputs {
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            return Err(format!("row {}, column `{name}`: the input is missing", row + 1)).in_file(path);
        }
    }
    let SalibArguments { second_order, first_order_only, resamples, seed, .. } = arguments.salib;
    let stated_layout = match (second_order, first_order_only) {
        (true, _) => Some(SalibLayout::SecondOrder),
        (_, true) => Some(SalibLayout::FirstOrder),
        _ => None,
    };
    // None if the file does not hold the inputs.
    let points = Some(&*inputs).filter(|inputs| !inputs.is_empty());
    let layout =
        SalibLayout::recognise(outputs[0].values.len(), &problem.members, stated_layout, points).map_err(|error| {
            match error {
                SalibError::Ambiguous { .. } => format!("{error}: choose one by --second-order or --first-order-only"),
                SalibError::Invalid(problem) => problem,
            }
        });
    let layout = layout.in_file(path)?;
    match points {
        Some(_) => say("the points in the file have the layout of SALib"),
        None => say("note: the file has no points: its rows are assumed to be in the order of SALib"),
    }
    let (study, store) = salib_study(&stem(path), &problem, &outputs, layout, (resamples, seed)).in_file(path)?;
    Ok(Read { study, store, unlikely: outputs.iter().map(|output| Unlikely::find(&output.values)).collect() })
}

/// What the problem file says, if there is one.
fn problem(arguments: &SalibArguments) -> anyhow::Result<Option<SalibProblem>> {
    let Some(path) = &arguments.problem else {
        if arguments.names.is_empty() {
            return Ok(None);
        }
        let names = arguments.names.iter().map(|name| name.trim().to_owned()).collect();
        return SalibProblem::of_inputs(names).map(Some).map_err(|error| bad_input(format!("--names: {error}")));
    };
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        let study = apportion_files::load_study(path, &[])?;
        let names = study.space().factors().iter().map(|factor| factor.name.clone()).collect();
        return SalibProblem::of_inputs(names).map(Some).in_file(path);
    }
    let text = read_text(path).map_err(|error| format!("cannot read the problem: {error}")).in_file(path)?;
    SalibProblem::parse(&text).map(Some).in_file(path)
}

/// Columns with their names.
type Places = Vec<(usize, String)>;

/// Which columns are inputs (none if the file does not hold all of them), and which are outputs.
fn columns(
    reader: &dyn RowReader,
    inputs: Option<Vec<String>>,
    outputs: &[String],
) -> anyhow::Result<(Places, Places)> {
    let Some(names) = reader.names() else {
        let Some(inputs) = inputs else {
            anyhow::bail!("the columns have no names: name the inputs (--names, --problem)")
        };
        let width = reader.width();
        let is_one = outputs.is_empty() && (width == 1 || width == inputs.len() + 1);
        let outputs = if is_one { &["y".to_owned()] } else { outputs };
        let first = first_output(width, inputs.len(), outputs.len())?;
        let inputs = inputs.into_iter().take(first).enumerate().collect();
        return Ok((inputs, (first..).zip(outputs.iter().cloned()).collect()));
    };
    let output_names: Vec<String> = match (outputs, &inputs) {
        ([], Some(inputs)) => names.iter().filter(|name| !inputs.contains(name)).cloned().collect(),
        ([], None) => {
            anyhow::bail!("the outputs are unknown: name them (--outputs), or the inputs (--names, --problem)")
        }
        (outputs, _) => outputs.to_vec(),
    };
    let outputs = output_columns(names, &output_names, &|name| inputs.iter().flatten().any(|input| input == name))?;
    let inputs = inputs.unwrap_or_else(|| names.iter().filter(|name| !output_names.contains(name)).cloned().collect());
    if inputs.is_empty() {
        anyhow::bail!("the file has only outputs: name the inputs, to give their number (--names, --problem)");
    }
    let places = inputs.iter().map(|name| Some((names.iter().position(|other| other == name)?, name.clone())));
    Ok((places.collect::<Option<Places>>().unwrap_or_default(), outputs))
}
