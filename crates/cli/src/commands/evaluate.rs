//! `apportion evaluate`: the model at points of the user.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::space::Space;
use apportion_base::digest::sha256_of_file;
use apportion_files::exchange::{EvaluateError, Evaluated, evaluate as evaluate_points, open_table};
use apportion_report::format::count;
use apportion_report::{prepare_outputs, significant, stream_atomically};
use serde_json::Value;

use super::journal::{JournalArguments, with_journal};
use super::stop::Stoppable;
use super::table::{TableArguments, say_of_table};
use super::{StudyArguments, say};
use crate::failure::OfFile;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The points: columns named after factors, values in the study's units, as CSV (cells separated by commas, semicolons,
    /// tabs or blanks) or NPY
    points: PathBuf,
    /// Names of the columns, separated by commas, for a file without them: NPY, or text without a header
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    names: Vec<String>,
    #[command(flatten)]
    table: TableArguments,
    /// Also write the points, before their outputs: a table for `apportion given-data`
    #[arg(long)]
    with_points: bool,
    /// The CSV file for the outputs
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    journal: JournalArguments,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

pub fn evaluate(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    let options = arguments.table.options(&arguments.names);
    let mut rows = open_table(&arguments.points, &options).in_file(&arguments.points)?;
    let inputs = [study.files(), vec![arguments.points.clone()]].concat();
    prepare_outputs(&inputs, std::slice::from_ref(&arguments.output), arguments.force)?;
    // What comes from a pipe cannot be compared, and what goes into one is not there to be resumed.
    let is_kept = arguments.points.is_file() && (arguments.output.is_file() || !arguments.output.exists());
    let mut path = arguments.output.clone().into_os_string();
    path.push(".journal");
    let journal = (is_kept && !arguments.journal.no_journal).then_some(Path::new(&path));
    let identity = if is_kept { sha256_of_file(&arguments.points)?.into() } else { Value::Null };
    let runner = arguments.journal.keep(study.runner(), journal);
    let mut outcome = None;
    let written = stream_atomically(&arguments.output, |out| {
        let out = &mut Stoppable::new(out);
        let result = outcome.insert(runner.run_table(identity, None, |run| {
            evaluate_points(run, study.space(), rows.as_mut(), out, arguments.with_points)
        }));
        // After any error, an incomplete file must not replace the target.
        result.as_ref().map(drop).map_err(|_| std::io::Error::other("incomplete"))
    });
    match outcome {
        Some(Err(EvaluateError::Points(error))) => Err(error).in_file(&arguments.points),
        Some(Err(EvaluateError::Output(error))) => Err(anyhow!("{}: {error}", arguments.output.display())),
        Some(Err(error)) => Err(with_journal(error, journal)),
        Some(Ok(evaluated)) => {
            written?;
            report(&evaluated, arguments, study.space());
            Ok(())
        }
        None => Ok(written?),
    }
}

fn report(evaluated: &Evaluated, arguments: &Arguments, space: &Space) {
    say_of_table(&arguments.points, &evaluated.skipped, evaluated.unended);
    if !evaluated.nominal.is_empty() {
        let values = evaluated.nominal.iter().map(|&number| {
            let factor = &space.factors()[number];
            let unit = match factor.unit().symbol() {
                "" | "1" => String::new(),
                symbol => format!(" {symbol}"),
            };
            format!("{} = {}{unit}", factor.name, factor.in_words(factor.nominal, significant))
        });
        let values: Vec<String> = values.collect();
        let points = arguments.points.display();
        say(&format!("note: {points}: factors without a column are at their nominal values: {}", values.join(", ")));
    }
    for ((output, failure), (points, first)) in &evaluated.failures {
        say(&format!(
            "warning: {output} is empty at {}: {failure} (first at point {first})",
            count(*points, "point", "points")
        ));
    }
    if evaluated.points == 0 {
        say("warning: the file has a header but no points");
    }
    say(&format!("wrote {} to {}", count(evaluated.points, "point", "points"), arguments.output.display()));
}
