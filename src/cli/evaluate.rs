//! `apportion evaluate`: the model at the user's own points.

use std::fs::File;
use std::path::PathBuf;

use anyhow::anyhow;
use apportion::exchange::{EvaluateError, Evaluated, evaluate_until};
use apportion::report::{prepare_file, stream_atomically};

use super::stop::{Stoppable, on_signal};
use super::{Failure, StudyArguments, say};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The points: CSV with a header of factor names, values in the study's units
    points: PathBuf,
    /// The CSV file for the outputs
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub fn evaluate(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load()?;
    let points = arguments.points.display();
    let file = File::open(&arguments.points)
        .map_err(|error| Failure::Input(anyhow!("{points}: cannot read the points: {error}")))?;
    prepare_file(&arguments.output)?;
    let mut outcome = None;
    let written = stream_atomically(&arguments.output, |out| {
        let result = evaluate_until(&study, file, &mut Stoppable::new(out), Some(on_signal()));
        let complete = result.is_ok();
        outcome = Some(result);
        // Whatever went wrong, half a file must not take the target's place.
        if complete { Ok(()) } else { Err(std::io::Error::other("incomplete")) }
    });
    match outcome {
        Some(Err(EvaluateError::Points(error))) => Err(Failure::Input(anyhow!("{points}: {error}"))),
        Some(Err(error @ EvaluateError::Halted { .. })) => Err(Failure::Run(error.into())),
        Some(Err(error)) => Err(Failure::Run(anyhow!("{}: {error}", arguments.output.display()))),
        Some(Ok(evaluated)) => {
            written?;
            report(&evaluated, arguments);
            Ok(())
        }
        None => Ok(written?),
    }
}

fn report(evaluated: &Evaluated, arguments: &Arguments) {
    for ((output, failure), (count, first)) in &evaluated.failures {
        say(&format!("warning: {output} is empty at {count} points: {failure} (first at point {first})"));
    }
    if evaluated.points == 0 {
        say("warning: the file holds a header but no points");
    }
    say(&format!("wrote {} points to {}", evaluated.points, arguments.output.display()));
}
