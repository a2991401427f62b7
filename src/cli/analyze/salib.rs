//! `apportion analyze --layout salib`: outputs at points that SALib made.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::exchange::{ColumnKind, RowReader, open_rows};
use apportion::files::{read_text, read_whole};
use apportion::given::Column;
use apportion::report::refused_name;
use apportion::report::salib::{SalibFacts, build_salib, file_names, salib_document};
use apportion::salib::{LayoutError, SalibLayout, SalibProblem, check_points, recognise, salib_indices};
use apportion::study::Study;
use sha2::{Digest, Sha256};

use super::super::Failure;
use super::super::evaluate::say_of_table;
use super::super::output::{default_folder, deliver, stem};

#[derive(clap::Args)]
pub struct SalibArguments {
    /// SALib's problem as JSON (names, groups), or a study (.toml) with the same inputs in the same order
    #[arg(long, value_name = "FILE", requires = "layout", conflicts_with = "names")]
    problem: Option<PathBuf>,
    /// Names of the inputs in SALib's order, separated by commas [default: all columns that are no outputs]
    #[arg(long, value_name = "NAMES", requires = "layout", value_delimiter = ',')]
    names: Vec<String>,
    /// The points were made with second order (calc_second_order=True, SALib's default)
    #[arg(long, requires = "layout", conflicts_with = "first_order_only")]
    second_order: bool,
    /// The points were made without second order (calc_second_order=False)
    #[arg(long, requires = "layout")]
    first_order_only: bool,
    /// Resamples of the bootstrap that gives the intervals; 0 for none
    #[arg(long, value_name = "N", requires = "layout", default_value_t = 1000, value_parser = resamples)]
    resamples: usize,
    /// Seed of the bootstrap
    #[arg(long, value_name = "S", requires = "layout", default_value_t = 0)]
    seed: u64,
}

fn resamples(text: &str) -> Result<usize, String> {
    const MOST: usize = 1_000_000;
    match text.parse() {
        Ok(n) if n == 0 || (100..=MOST).contains(&n) => Ok(n),
        _ => Err(format!("expected 0, or a whole number from 100 to {MOST}")),
    }
}

/// The columns of a file.
struct Table {
    problem: SalibProblem,
    /// The inputs, if the file holds them.
    inputs: Option<Vec<(String, Vec<f64>)>>,
    outputs: Vec<Column>,
    /// What is to be said of the header if the number of rows is wrong.
    header: &'static str,
}

pub fn analyze(arguments: &super::Arguments) -> Result<(), Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{}: {error}", arguments.data.display()));
    let bytes = read_whole(&arguments.data).map_err(|error| wrong(&format!("cannot read the file: {error}")))?;
    let sha256 = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    drop(bytes);
    let Table { problem, inputs, outputs, header } = table(arguments)?;
    let (rows, d) = (outputs[0].values.len(), problem.members.len());
    let SalibArguments { second_order, first_order_only, resamples, seed, .. } = arguments.salib;
    let asked = match (second_order, first_order_only) {
        (true, _) => Some(SalibLayout::SecondOrder),
        (_, true) => Some(SalibLayout::FirstOrder),
        _ => None,
    };
    let fits = inputs.as_ref().map(|inputs| |layout| check_points(inputs, &problem.members, layout));
    let fits = fits.as_ref().map(|fits| fits as &dyn Fn(SalibLayout) -> _);
    let layout = recognise(rows, d, asked, fits).map_err(|error| match error {
        LayoutError::NoMultiple { .. } => wrong(&format!("{error}{header}")),
        _ => wrong(&error),
    })?;
    let name = stem(&arguments.data);
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&name));
    let artefacts = arguments.charts.artefacts(folder).beside_input(&arguments.data);
    artefacts.check(&file_names(&name, &outputs.iter().map(|column| column.name.as_str()).collect::<Vec<_>>()))?;
    let names: Vec<String> = problem.members.iter().map(|(name, _)| name.clone()).collect();
    let analysed = outputs.into_iter().map(|column| {
        let indices = salib_indices(&column.values, d, layout, resamples, seed);
        (column, indices)
    });
    let file = arguments.data.display().to_string();
    let facts = SalibFacts { file, sha256, layout, points_checked: inputs.is_some(), bootstrap: (resamples, seed) };
    let result = build_salib(&names, &analysed.collect::<Vec<_>>(), &facts);
    deliver(&artefacts, &salib_document(&result, &name))
}

/// What the problem file says, if there is one.
fn problem(arguments: &SalibArguments) -> Result<Option<SalibProblem>, Failure> {
    let wrong = |path: &Path, error: &dyn std::fmt::Display| Failure::Input(anyhow!("{}: {error}", path.display()));
    let Some(path) = &arguments.problem else {
        if arguments.names.is_empty() {
            return Ok(None);
        }
        let names = arguments.names.iter().map(|name| name.trim().to_owned()).collect();
        let problem = SalibProblem::of_inputs(names);
        return problem.map(Some).map_err(|error| Failure::Input(anyhow!("--names: {error}")));
    };
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        let study = Study::load(path, &[])?;
        let names = study.space().factors().iter().map(|factor| factor.name.clone()).collect();
        return SalibProblem::of_inputs(names).map(Some).map_err(|error| wrong(path, &error));
    }
    let text = read_text(path).map_err(|error| wrong(path, &format!("cannot read the problem: {error}")))?;
    SalibProblem::parse(&text).map(Some).map_err(|error| wrong(path, &error))
}

fn table(arguments: &super::Arguments) -> Result<Table, Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{}: {error}", arguments.data.display()));
    let mut reader = open_rows(&arguments.data).map_err(|error| wrong(&error))?;
    let header = super::numbers_as_names(reader.as_ref());
    let problem = problem(&arguments.salib)?;
    let known = problem.as_ref().map(|problem| problem.inputs.clone());
    let (inputs, outputs) = columns(reader.as_ref(), known, &arguments.outputs).map_err(|error| wrong(&error))?;
    let input_names: Vec<String> = inputs.iter().map(|(_, name)| name.clone()).collect();
    let problem = match problem {
        Some(problem) => problem,
        None => SalibProblem::of_inputs(input_names).map_err(|error| wrong(&error))?,
    };
    let names = problem.members.iter().map(|(name, _)| name).chain(outputs.iter().map(|(_, name)| name));
    if let Some((name, expected)) = names.into_iter().find_map(|name| Some((name, refused_name(name)?))) {
        return Err(wrong(&format!("the name {:.60?} of an input or output: expected {expected}", name)));
    }
    let wanted: Vec<(usize, ColumnKind)> =
        inputs.iter().chain(&outputs).map(|(place, name)| (*place, ColumnKind::numbers(name))).collect();
    let (mut all, mut part) = (vec![Vec::new(); wanted.len()], vec![Vec::new(); wanted.len()]);
    while reader.read(&wanted, 1 << 13, &mut part).map_err(|error| wrong(&error))? > 0 {
        all.iter_mut().zip(&part).for_each(|(all, part)| all.extend_from_slice(part));
    }
    say_of_table(&arguments.data, &[], reader.is_unended());
    for ((_, kind), column) in wanted.iter().zip(&all) {
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            let found = if column[row].is_nan() { "the value is missing" } else { "the value is infinite" };
            return Err(wrong(&format!("row {}, column `{}`: {found}", row + 1, kind.name)));
        }
    }
    let values = all.split_off(inputs.len());
    let outputs = outputs.into_iter().zip(values).map(|((_, name), values)| Column { name, values }).collect();
    let inputs: Vec<(String, Vec<f64>)> = inputs.into_iter().map(|(_, name)| name).zip(all).collect();
    Ok(Table { problem, inputs: (!inputs.is_empty()).then_some(inputs), outputs, header })
}

/// Columns with their names.
type Places = Vec<(usize, String)>;

/// Which columns are inputs (none if the file does not hold all of them), and which are outputs.
fn columns(
    reader: &dyn RowReader,
    inputs: Option<Vec<String>>,
    outputs: &[String],
) -> anyhow::Result<(Places, Places)> {
    let Some(names) = reader.names() else { return unnamed(reader.width(), inputs, outputs) };
    let place = |name: &String| {
        let place = names.iter().position(|known| known == name);
        place.ok_or_else(|| anyhow!("no column is called `{name}`; the columns are {}", names.join(", ")))
    };
    let is_input = |name: &&String| inputs.iter().flatten().any(|input| input == *name);
    let asked: Vec<String> = match (outputs, &inputs) {
        ([], Some(_)) => names.iter().filter(|name| !is_input(name)).cloned().collect(),
        ([], None) => {
            anyhow::bail!("which columns are outputs? name them (--outputs), or the inputs (--names, --problem)")
        }
        (asked, _) => asked.to_vec(),
    };
    if asked.is_empty() {
        anyhow::bail!("all columns are inputs: {}", names.join(", "));
    }
    if let Some(k) = (0..asked.len()).find(|&k| is_input(&&asked[k]) || asked[..k].contains(&asked[k])) {
        anyhow::bail!("`{}` is asked for as an output, but is an input, or asked for twice", asked[k]);
    }
    let is_output = |name: &&String| asked.contains(*name);
    let inputs = inputs.unwrap_or_else(|| names.iter().filter(|name| !is_output(name)).cloned().collect());
    if inputs.is_empty() {
        anyhow::bail!("how many inputs are there? the file holds outputs only: name the inputs (--names, --problem)");
    }
    let outputs = asked.iter().map(|name| Ok((place(name)?, name.clone()))).collect::<anyhow::Result<Places>>()?;
    let there: Option<Places> = inputs.iter().map(|name| Some((place(name).ok()?, name.clone()))).collect();
    Ok((there.unwrap_or_default(), outputs))
}

/// The same for a file without names.
fn unnamed(width: usize, inputs: Option<Vec<String>>, outputs: &[String]) -> anyhow::Result<(Places, Places)> {
    let Some(inputs) = inputs else {
        anyhow::bail!("the columns have no names: name the inputs (--names, --problem)");
    };
    let d = inputs.len();
    let outputs = if outputs.is_empty() && (width == 1 || width == d + 1) { &["y".to_owned()] } else { outputs };
    let first = match width.checked_sub(outputs.len()) {
        Some(before) if !outputs.is_empty() && (before == 0 || before == d) => before,
        _ => anyhow::bail!(
            "{width} columns without names: expected the outputs, or the {d} inputs and then the outputs; name the \
             outputs (--outputs)"
        ),
    };
    let inputs = if first == 0 { Vec::new() } else { inputs };
    Ok((inputs.into_iter().enumerate().collect(), (first..).zip(outputs.iter().cloned()).collect()))
}
