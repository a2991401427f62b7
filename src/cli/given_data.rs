//! `apportion given-data`: first-order indices from a table that exists already.

use std::path::PathBuf;

use anyhow::anyhow;
use apportion::exchange::{Missing, Selection, Table, read_table, table_of_bytes};
use apportion::files::read_whole;
use apportion::given::{Method, analyse};
use apportion::report::given::{GivenFacts, build_given, given_document};
use sha2::{Digest, Sha256};

use super::Failure;
use super::evaluate::say_of_table;
use super::output::{ChartArguments, default_folder, deliver, stem};

#[derive(clap::Args)]
pub struct Arguments {
    /// The table: columns by name, a row of numbers per run, as CSV (cells separated by commas, semicolons or tabs),
    /// Parquet or NPY
    table: PathBuf,
    /// Names of the columns, separated by commas, of a table that has none: NPY, or text without a header
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = column_name)]
    names: Vec<String>,
    /// Columns that are outputs, separated by commas
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = column_name)]
    outputs: Vec<String>,
    /// Columns that are inputs, separated by commas [default: all of numbers that are no outputs]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = column_name)]
    inputs: Vec<String>,
    /// How to estimate: by ranks, by bins, or by ranks with the bins as a check
    #[arg(long, value_name = "METHOD", default_value = "both", value_parser = parse_method)]
    method: Method,
    /// Leave out rows without a value in one of these columns, and count them
    #[arg(long)]
    drop_missing: bool,
    /// Seed of the order of equal inputs in the intervals by ranks; the estimates do not depend on it
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Folder for the results [default: results/NAME of the table]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    charts: ChartArguments,
}

fn column_name(text: &str) -> Result<String, String> {
    let name = text.trim();
    if name.is_empty() { Err("expected names of columns, separated by commas".to_owned()) } else { Ok(name.to_owned()) }
}

fn parse_method(text: &str) -> Result<Method, String> {
    let names = Method::ALL.map(Method::name).join(", ");
    Method::ALL.into_iter().find(|method| method.name() == text).ok_or_else(|| format!("expected one of {names}"))
}

pub fn given_data(arguments: &Arguments) -> Result<(), Failure> {
    let path = arguments.table.display();
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(anyhow!("{path}: {error}"));
    let bytes = read_whole(&arguments.table).map_err(|error| wrong(&format!("cannot read the table: {error}")))?;
    let missing = if arguments.drop_missing { Missing::Drop } else { Missing::Refuse };
    let selection = Selection { outputs: &arguments.outputs, inputs: &arguments.inputs, missing };
    let sha256 = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    let mut rows = table_of_bytes(bytes, &arguments.names).map_err(|error| wrong(&error))?;
    let table = read_table(rows.as_mut(), &selection).map_err(|error| wrong(&error))?;
    say_of_table(&arguments.table, (&table.skipped, rows.is_unended()));
    let Table { inputs, outputs, dropped, .. } = table;
    let indices = analyse(&inputs, &outputs, arguments.method, arguments.seed).map_err(|error| wrong(&error))?;
    let name = stem(&arguments.table);
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&name));
    let artefacts = arguments.charts.artefacts(folder).beside_input(&arguments.table);
    let facts = GivenFacts {
        file: path.to_string(),
        sha256,
        dropped: dropped.map(|dropped| (dropped.rows, dropped.first_line)),
        method: arguments.method,
        seed: arguments.seed,
    };
    let result = build_given(&indices, (&inputs, &outputs), &facts);
    deliver(&artefacts, &given_document(&result, &name))
}
