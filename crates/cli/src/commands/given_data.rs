//! `apportion given-data`: indices from an existing table.

use std::path::PathBuf;

use apportion::given::{Column, analyse, average_replicates, measures, surrogate_indices};
use apportion::result::RunFacts;
use apportion::screening::screen_table;
use apportion::{Distribution, Study};
use apportion_base::digest::Sha256;
use apportion_base::files::read_whole;
use apportion_files::exchange::{
    ColumnKind, Joined, Missing, Selection, Table, factor_column, read_table, table_of_bytes,
};
use apportion_report::given::{GivenFacts, build_given, given_document};
use apportion_report::screening::{build_screening, screening_document};

use super::output::{OutputArguments, deliver, stem};
use super::table::{TableArguments, say_of_table};
use crate::failure::{OfFile, bad_input};

#[derive(clap::Args)]
pub struct Arguments {
    /// The table: columns by name, a row of numbers per run, as CSV (cells separated by commas, semicolons, tabs or
    /// blanks) or NPY
    table: PathBuf,
    /// Names of the columns, separated by commas, for a table without them: NPY, or text without a header
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = column_name)]
    names: Vec<String>,
    #[command(flatten)]
    reading: TableArguments,
    /// The file of the outputs, if it is not the table: as many rows, in the same order; with --names it has no header either,
    /// and its columns are those of --outputs
    #[arg(long, value_name = "FILE")]
    outputs_from: Option<PathBuf>,
    /// Columns that are outputs, separated by commas
    #[arg(long, value_name = "NAMES", required = true, value_delimiter = ',', value_parser = column_name)]
    outputs: Vec<String>,
    /// Columns that are inputs, separated by commas [default: all columns of numbers that are not outputs]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = column_name)]
    inputs: Vec<String>,
    /// Study that has the inputs as factors, with the same names and units: it gives the labels of categories, and the surrogate is
    /// more accurate with its distributions
    #[arg(long, value_name = "STUDY")]
    study: Option<PathBuf>,
    /// Also estimate other measures: Borgonovo's delta, PAWN, R2-HSIC, and S_1 from the spectrum
    #[arg(long)]
    measures: bool,
    /// Leave out rows without a value in one of these columns, and count them
    #[arg(long)]
    drop_missing: bool,
    /// Seed of the order of equal inputs in the intervals by ranks; the estimates do not depend on it
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    output: OutputArguments,
}

fn column_name(text: &str) -> Result<String, String> {
    let name = text.trim();
    if name.is_empty() { Err("expected names of columns, separated by commas".to_owned()) } else { Ok(name.to_owned()) }
}

pub fn given_data(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &*arguments.table;
    let bytes = read_whole(path).map_err(|error| format!("cannot read the table: {error}")).in_file(path)?;
    let missing = if arguments.drop_missing { Missing::Drop } else { Missing::Refuse };
    let study = arguments.study.as_deref().map(|study| apportion_files::load_study(study, &[])).transpose()?;
    let kinds: Vec<ColumnKind> =
        study.iter().flat_map(|study| study.space().factors().iter().map(factor_column)).collect();
    let selection = Selection { outputs: &arguments.outputs, inputs: &arguments.inputs, missing, kinds: &kinds };
    let (mut digest, mut file) = (Sha256::default(), path.display().to_string());
    digest.update(&bytes);
    let mut rows = table_of_bytes(bytes, &arguments.reading.options(&arguments.names)).in_file(path)?;
    if let Some(path) = &arguments.outputs_from {
        let bytes = read_whole(path).map_err(|error| format!("cannot read the outputs: {error}")).in_file(path)?;
        digest.update(&bytes);
        file += &format!(" + {}", path.display());
        let names = if arguments.names.is_empty() { &[][..] } else { &arguments.outputs };
        let outputs = table_of_bytes(bytes, &arguments.reading.options(names)).in_file(path)?;
        rows = Box::new(Joined::new(rows, outputs, &arguments.outputs).in_file(path)?);
    }
    let Table { mut inputs, mut outputs, dropped, skipped, counter } =
        read_table(rows.as_mut(), &selection).in_file(path)?;
    let names: Vec<String> = skipped.iter().map(|column| column.name.clone()).collect();
    say_of_table(path, &names, rows.is_unended());
    let name = stem(path);
    let files =
        study.iter().flat_map(Study::files).chain([path.to_owned()]).chain(arguments.outputs_from.clone()).collect();
    let artefacts = arguments.output.artefacts(&name, files);
    let is_plain = study.is_none() && !arguments.measures;
    if let Some((study, screening)) = is_plain.then(|| screen_table(&name, &inputs, &outputs)).flatten() {
        let mut file = build_screening(&study, study.model().as_ref(), &screening, RunFacts::default());
        file.provenance.seed = None;
        file.notes
            .push("the rows are Morris trajectories: effects are per range of the values in the table".to_owned());
        return deliver(&artefacts, &screening_document(&file));
    }
    let replicates = average_replicates(&mut inputs, &mut outputs).in_file(path)?;
    let indices = analyse(&inputs, &outputs, arguments.seed).in_file(path)?;
    let distributions = study.as_ref().map(|study| distributions(study, &inputs)).transpose()?;
    let surrogates = surrogate_indices(&inputs, &outputs, &indices, distributions.as_deref());
    let facts = GivenFacts {
        file,
        sha256: digest.finish(),
        dropped: dropped.map(|dropped| (dropped.rows, dropped.first_line)),
        seed: arguments.seed,
    };
    let mut result = build_given(&indices, &surrogates, &inputs, &outputs, &facts)
        .after(replicates.as_ref(), counter.as_deref())
        .without(&skipped);
    if arguments.measures {
        result = result.with_measures(&measures(&inputs, &outputs, &indices, arguments.seed));
    }
    deliver(&artefacts, &given_document(&result, &name))
}

/// The distributions that the study has for the `inputs`.
fn distributions(study: &Study, inputs: &[Column]) -> anyhow::Result<Vec<Distribution>> {
    let factors = study.space().factors();
    let mut distributions = Vec::new();
    for input in inputs {
        let Some(factor) = factors.iter().find(|factor| factor.name == input.name) else {
            let names: Vec<&str> = factors.iter().map(|factor| factor.name.as_str()).collect();
            return Err(bad_input(format!(
                "--study: the input `{}` is not a factor of the study; its factors are {}; choose the inputs with --inputs",
                input.name,
                names.join(", ")
            )));
        };
        distributions.push(factor.distribution().clone());
    }
    Ok(distributions)
}
