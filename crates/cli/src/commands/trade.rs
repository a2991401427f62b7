//! `apportion trade`: accuracy against time, and the behaviour of a study at its extremes.

use std::time::Instant;

use anyhow::anyhow;
use apportion::Study;
use apportion_report::Artefacts;

use super::output::{OutputArguments, deliver};
use super::progress::Meter;
use super::stop::on_signal;
use super::{StudyArguments, Threads, say, whole_number};
use crate::failure::bad_input;
use crate::trade::extremes::{ExtremesJob, extremes, extremes_document};
use crate::trade::settings::{SettingsJob, compare_settings, settings_document};

/// Seconds that a comparison takes, and a quick one.
const SECONDS: f64 = 300.0;
const QUICK_SECONDS: f64 = 40.0;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Map the study at its extremes instead: numbers that are right, flagged, or refused with a reason
    #[arg(long)]
    extremes: bool,
    /// Approximate number of points, in addition to the steps past the bounds [default: 600; for a program 160]
    #[arg(long, value_name = "N", requires = "extremes", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    cells: Option<u64>,
    /// Seed of the points that are chosen at random [default: the study's]
    #[arg(long, value_name = "S", requires = "extremes", value_parser = whole_number)]
    seed: Option<u64>,
    /// Compare settings for less than a minute instead of five
    #[arg(long, conflicts_with_all = ["extremes", "seconds"])]
    quick: bool,
    /// Approximate time of the comparison in seconds [default: 300]
    #[arg(long, value_name = "S", conflicts_with = "extremes", value_parser = parse_seconds)]
    seconds: Option<f64>,
    /// Number of seeds for every setting; the largest of their errors counts
    #[arg(long, value_name = "N", default_value_t = 10, conflicts_with = "extremes", value_parser = clap::value_parser!(u64).range(1..=1000))]
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
    let artefacts = arguments.output.prepared(&study, if arguments.extremes { "-extremes" } else { "-trade" }, None)?;
    if arguments.extremes {
        trade_extremes(&study, arguments, &artefacts)
    } else {
        trade_settings(&study, arguments, &artefacts)
    }
}

/// The settings of the study against each other.
fn trade_settings(study: &Study, arguments: &Arguments, artefacts: &Artefacts) -> anyhow::Result<()> {
    let usual = if arguments.quick { QUICK_SECONDS } else { SECONDS };
    let job = SettingsJob {
        study,
        seconds: arguments.seconds.unwrap_or(usual),
        seeds: arguments.seeds,
        threads: arguments.threads.number(),
        stop: on_signal(),
        on_progress: &|what, share| say(&format!("{:3.0} % of the time: {what}", 100.0 * share)),
    };
    deliver(artefacts, &settings_document(&compare_settings(&job)?))
}

/// What becomes of the study at its extremes.
fn trade_extremes(study: &Study, arguments: &Arguments, artefacts: &Artefacts) -> anyhow::Result<()> {
    let default = ExtremesJob::new(study);
    let (points, seed) = (arguments.cells.unwrap_or(default.points), arguments.seed.unwrap_or(default.seed));
    let meter = Meter::new(study.name(), points);
    let start = Instant::now();
    let job = ExtremesJob {
        points,
        seed,
        threads: arguments.threads.number(),
        stop: Some(on_signal()),
        on_message: say,
        on_progress: &|progress| meter.update(progress),
        ..default
    };
    let map = extremes(&job)?;
    meter.finish(map.points, start.elapsed().as_secs_f64());
    let wrong = map.counts.wrong;
    deliver(artefacts, &extremes_document(study, seed, map))?;
    match wrong {
        0 => Ok(()),
        _ => Err(anyhow!("{wrong} numbers are silently wrong: see the table of reasons")),
    }
}
