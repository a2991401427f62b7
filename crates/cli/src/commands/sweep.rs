//! `apportion sweep`: one factor at a time around the nominal point.

use apportion::sweep::Sweeps;
use apportion::sweep::find;
use apportion_report::sweep::{build_sweep, sweep_document};

use super::journal::{JournalArguments, with_journal};
use super::output::{OutputArguments, deliver};
use super::progress::Meter;
use super::{StudyArguments, number_in};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// A factor to sweep over its range; once for each [default: every factor]
    #[arg(long = "factor", value_name = "NAME")]
    factors: Vec<String>,
    /// Points over the range of each factor
    #[arg(long, value_name = "N", default_value_t = 101, value_parser = |text: &str| number_in(text, 2..=Sweeps::MAX_POINTS))]
    points: usize,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    journal: JournalArguments,
}

pub fn sweep(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    let factors = find(study.space(), &arguments.factors)?;
    let model = study.model();
    let artefacts = arguments.output.prepared(&study, "-sweep", Some(&arguments.journal))?;
    let journal = artefacts.journal.as_deref();
    let meter = Meter::new(study.name(), 0);
    let runner = study.runner().on_progress(|progress| meter.update(progress));
    let sweeps = arguments.journal.keep(runner, journal).sweep(&factors, arguments.points);
    let sweeps = sweeps.map_err(|error| with_journal(error, journal))?;
    drop(meter);
    deliver(&artefacts, &sweep_document(&build_sweep(&study, model.as_ref(), sweeps)))
}
