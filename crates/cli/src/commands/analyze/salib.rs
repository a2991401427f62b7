//! `apportion analyze --layout salib`: outputs at points from SALib.

use std::path::PathBuf;

use apportion::Unlikely;
use apportion::files::read_text;
use apportion::given::Column;
use apportion::salib::{SalibLayout, SalibProblem, recognise, salib_study};
use apportion_files::exchange::{ColumnKind, RowReader, first_output, open_table, output_columns};

use super::super::output::stem;
use super::super::table::say_of_table;
use super::super::{number_in, say};
use crate::failure::{OfFile, bad_input};

#[derive(clap::Args)]
pub struct SalibArguments {
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
pub fn study(arguments: &super::Arguments) -> anyhow::Result<super::Read> {
    let path = &*arguments.data;
    let mut reader = open_table(path, &arguments.table.options(&[])).of(path)?;
    let problem = problem(&arguments.salib)?;
    let known = problem.as_ref().map(|problem| problem.inputs.clone());
    let (inputs, outputs) = columns(reader.as_ref(), known, &arguments.outputs).of(path)?;
    let problem = match problem {
        Some(problem) => problem,
        None => SalibProblem::of_inputs(inputs.iter().map(|(_, name)| name.clone()).collect()).of(path)?,
    };
    let wanted: Vec<(usize, ColumnKind)> =
        inputs.iter().chain(&outputs).map(|(place, name)| (*place, ColumnKind::numbers(name))).collect();
    let (mut all, mut part) = (vec![Vec::new(); wanted.len()], vec![Vec::new(); wanted.len()]);
    while reader.read(&wanted, 1 << 13, &mut part).of(path)? > 0 {
        all.iter_mut().zip(&part).for_each(|(all, part)| all.extend_from_slice(part));
    }
    say_of_table(path, &[], reader.is_unended());
    let values = all.split_off(inputs.len());
    let outputs: Vec<Column> =
        outputs.into_iter().zip(values).map(|((_, name), values)| Column { name, values }).collect();
    let inputs: Vec<(String, Vec<f64>)> = inputs.into_iter().map(|(_, name)| name).zip(all).collect();
    for (name, column) in &inputs {
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            return Err(format!("row {}, column `{name}`: the input is missing", row + 1)).of(path);
        }
    }
    let SalibArguments { second_order, first_order_only, resamples, seed, .. } = arguments.salib;
    let asked = match (second_order, first_order_only) {
        (true, _) => Some(SalibLayout::SecondOrder),
        (_, true) => Some(SalibLayout::FirstOrder),
        _ => None,
    };
    // None if the file does not hold the inputs.
    let points = Some(&*inputs).filter(|inputs| !inputs.is_empty());
    let layout = recognise(outputs[0].values.len(), &problem.members, asked, points).of(path)?;
    match points {
        Some(_) => say("the points in the file have the layout of SALib"),
        None => say("note: the file has no points: its rows are assumed to be in the order of SALib"),
    }
    let (study, store) = salib_study(&stem(path), &problem, &outputs, layout, (resamples, seed)).of(path)?;
    let unlikely = |output: &Column| Unlikely::find(&output.values).map(|found| found.in_table(found.first + 1));
    Ok(super::Read { study, store, unlikely: outputs.iter().map(unlikely).collect() })
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
        return SalibProblem::of_inputs(names).map(Some).of(path);
    }
    let text = read_text(path).map_err(|error| format!("cannot read the problem: {error}")).of(path)?;
    SalibProblem::parse(&text).map(Some).of(path)
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
    let is_input = |name: &str| inputs.iter().flatten().any(|input| input == name);
    let asked: Vec<String> = match (outputs, &inputs) {
        ([], Some(_)) => names.iter().filter(|name| !is_input(name)).cloned().collect(),
        ([], None) => {
            anyhow::bail!("the outputs are unknown: name them (--outputs), or the inputs (--names, --problem)")
        }
        (asked, _) => asked.to_vec(),
    };
    let outputs = output_columns(names, &asked, &is_input)?;
    let inputs = inputs.unwrap_or_else(|| names.iter().filter(|name| !asked.contains(name)).cloned().collect());
    if inputs.is_empty() {
        anyhow::bail!("the file has only outputs: name the inputs, to give their number (--names, --problem)");
    }
    let place = |name: &String| Some((names.iter().position(|known| known == name)?, name.clone()));
    let there: Option<Places> = inputs.iter().map(place).collect();
    Ok((there.unwrap_or_default(), outputs))
}
