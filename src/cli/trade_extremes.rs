//! `apportion trade --extremes`: what becomes of a study at its extremes.

use std::time::Instant;

use anyhow::anyhow;
use apportion::Study;
use apportion::report::Artefacts;
use apportion::trade::extremes::{ExtremesJob, ExtremesSettings, build_extremes, extremes, extremes_document};

use super::output::deliver;
use super::progress::Meter;
use super::stop::on_signal;
use super::{Failure, say, whole_number};

#[derive(clap::Args)]
pub struct ExtremesArguments {
    /// About how many points the model is evaluated at, besides the steps past its bounds [default: 600; of a program, 160]
    #[arg(long, value_name = "N", requires = "extremes", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    cells: Option<u64>,
    /// Seed of the points that are chosen at random [default: the study's]
    #[arg(long, value_name = "S", requires = "extremes", value_parser = whole_number)]
    seed: Option<u64>,
}

pub fn trade_extremes(
    study: &Study,
    arguments: &ExtremesArguments,
    artefacts: &Artefacts,
    threads: usize,
) -> Result<(), Failure> {
    let own = ExtremesSettings::for_study(study);
    let &ExtremesArguments { cells, seed } = arguments;
    let settings = ExtremesSettings { points: cells.unwrap_or(own.points), seed: seed.unwrap_or(own.seed) };
    artefacts.prepare()?;
    let meter = Meter::new(study.name(), settings.points);
    let start = Instant::now();
    let job = ExtremesJob {
        settings,
        threads,
        stop: Some(on_signal()),
        on_message: say,
        on_progress: &|progress| meter.update(progress),
        ..ExtremesJob::new(study)
    };
    let map = extremes(&job)?;
    meter.finish(map.points, start.elapsed().as_secs_f64());
    deliver(artefacts, &extremes_document(&build_extremes(study, settings.seed, &map)))?;
    match map.counts.wrong {
        0 => Ok(()),
        wrong => Err(Failure::Run(anyhow!("{wrong} numbers are silently wrong: see the reasons"))),
    }
}
