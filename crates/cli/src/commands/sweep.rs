//! `apportion sweep`: one factor at a time around the nominal point.

use apportion::model::RunContext;
use apportion::sweep::Sweeps;
use apportion::sweep::find;
use apportion_report::sweep::{build_sweep, sweep_document};

use super::output::{OutputArguments, deliver};
use super::stop::on_signal;
use super::{StudyArguments, number_in, say};

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
}

pub fn sweep(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    let factors = find(study.space(), &arguments.factors)?;
    let model = study.model();
    let artefacts = arguments.output.prepared(&study, "-sweep")?;
    let context = RunContext::new(Some(on_signal()), say);
    let sweeps = apportion::sweep::sweep(study.space(), model.as_ref(), &factors, arguments.points, &context)?;
    deliver(&artefacts, &sweep_document(&build_sweep(&study, model.as_ref(), sweeps)))
}
