//! `apportion trade`: accuracy against time, and what becomes of a study at its extremes.

use anyhow::anyhow;
use apportion::Study;
use apportion::report::Artefacts;
use apportion::run::{RunError, threads_in_force};
use apportion::trade::settings::{SettingsJob, build_settings, compare_settings, settings_document};

use super::output::{OutputArguments, deliver};
use super::stop::on_signal;
use super::trade_extremes::{ExtremesArguments, trade_extremes};
use super::{Failure, StudyArguments, Threads, say};

/// Seconds that a comparison takes, and a quick one.
const SECONDS: f64 = 300.0;
const QUICK_SECONDS: f64 = 40.0;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    pub study: StudyArguments,
    /// Map what becomes of the study at its extremes instead: numbers that are right, flagged, or refused with a reason
    #[arg(long)]
    extremes: bool,
    #[command(flatten)]
    pub of_extremes: ExtremesArguments,
    /// Compare settings for less than a minute, not for five
    #[arg(long, conflicts_with_all = ["extremes", "seconds"])]
    quick: bool,
    /// Compare settings for about so many seconds [default: 300]
    #[arg(long, value_name = "S", conflicts_with = "extremes", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Seeds of every setting; the largest of their errors counts
    #[arg(long, value_name = "N", default_value_t = 3, conflicts_with = "extremes", value_parser = clap::value_parser!(u64).range(1..=1000))]
    seeds: u64,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: Threads,
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0 && seconds.is_finite());
    seconds.ok_or_else(|| "expected a number of seconds above 0, as in 60".to_owned())
}

pub fn trade(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load()?;
    if !study.space().dependences().is_empty() {
        return Err(Failure::Input(anyhow!(
            "factors of this study depend on each other, and what is compared here, surrogates, cheaper models and other samplers, \
             serves independent ones: expected a study without [[dependence]]"
        )));
    }
    let artefacts = arguments.output.artefacts(study.name());
    if arguments.extremes {
        trade_extremes(&study, &arguments.of_extremes, &artefacts, arguments.threads.number())
    } else {
        trade_settings(&study, arguments, &artefacts)
    }
}

/// The settings of the study against each other.
fn trade_settings(study: &Study, arguments: &Arguments, artefacts: &Artefacts) -> Result<(), Failure> {
    artefacts.prepare()?;
    let usual = if arguments.quick { QUICK_SECONDS } else { SECONDS };
    let job = SettingsJob {
        study,
        seconds: arguments.seconds.unwrap_or(usual),
        seeds: arguments.seeds,
        threads: arguments.threads.number(),
        stop: Some(on_signal()),
        on_progress: &|what, share| say(&format!("{:3.0} % of the time: {what}", 100.0 * share)),
    };
    let comparison = compare_settings(&job).map_err(|error: RunError| Failure::from(error))?;
    let threads = threads_in_force(arguments.threads.number());
    deliver(artefacts, &settings_document(&build_settings(study, threads, comparison)))
}
