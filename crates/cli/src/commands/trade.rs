//! `apportion trade`: accuracy against time.

use super::output::{OutputArguments, deliver};
use super::stop::on_signal;
use super::{StudyArguments, Threads, say};
use crate::failure::bad_input;
use crate::trade::{SettingsJob, compare_settings, settings_document};

/// Seconds that a comparison takes, and a quick one.
const SECONDS: f64 = 300.0;
const QUICK_SECONDS: f64 = 40.0;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Compare settings for less than a minute instead of five
    #[arg(long, conflicts_with = "seconds")]
    quick: bool,
    /// Approximate time of the comparison in seconds [default: 300]
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Number of seeds for every setting; the largest of their errors counts
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=1000))]
    seeds: u64,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    threads: Threads,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0 && seconds.is_finite());
    seconds.ok_or_else(|| "expected a number of seconds above 0, as in 60".to_owned())
}

pub fn trade(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    if !study.space().dependences().is_empty() {
        return Err(bad_input(
            "factors of this study depend on each other, but this command compares surrogates, cheaper models and samplers, \
             which need independent factors: expected a study without [[dependence]]",
        ));
    }
    let artefacts = arguments.output.prepared(&study, "-trade", None)?;
    let usual = if arguments.quick { QUICK_SECONDS } else { SECONDS };
    let job = SettingsJob {
        study: &study,
        seconds: arguments.seconds.unwrap_or(usual),
        seeds: arguments.seeds,
        threads: arguments.threads.number(),
        stop: on_signal(),
        on_progress: &|what, share| say(&format!("{:3.0} % of the time: {what}", 100.0 * share)),
    };
    deliver(&artefacts, &settings_document(&compare_settings(&job)?))
}
