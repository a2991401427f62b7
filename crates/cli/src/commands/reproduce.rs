//! `apportion reproduce`: the papers' figures and claims, on one page.

use std::path::PathBuf;

use super::live::{CAN_WRITE_PAGES, add_live_page, live_page};
use super::output::{ChartArguments, deliver};
use super::progress::Meter;
use super::stop::on_signal;
use super::{DesignChanges, Threads};
use apportion_papers::reproduce::claims::claims;
use apportion_papers::reproduce::figures::{coulomb, figures};
use apportion_papers::reproduce::percentages::percentages;
use apportion_papers::reproduce::{Effort, QUICK, Reproduced, Reproduction, document, general_study, studies};

/// The file of the live page.
const LIVE: &str = "live.html";

#[derive(clap::Args)]
pub struct Arguments {
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "results/reproduce")]
    out: PathBuf,
    /// Fewer points and repetitions, for results within seconds
    #[arg(long)]
    quick: bool,
    /// Only one part of the page: the figures, or the verdicts on the claims with the percentages
    #[arg(long, value_name = "PART")]
    only: Option<Topic>,
    #[command(flatten)]
    design: DesignChanges,
    #[command(flatten)]
    charts: ChartArguments,
    #[command(flatten)]
    threads: Threads,
}

/// A part of the reproduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Topic {
    /// The figures of the papers.
    Figures,
    /// The verdicts on their claims, and their percentages with ours.
    Claims,
}

pub fn reproduce(arguments: &Arguments) -> anyhow::Result<()> {
    let artefacts = arguments.charts.artefacts(&arguments.out).prepare("index")?;
    let threads = arguments.threads.number();
    let (effort, quick) = if arguments.quick { (Effort::Quick, &QUICK[..]) } else { (Effort::Full, &[][..]) };
    let overrides: Vec<String> =
        quick.iter().map(|&setting| setting.to_owned()).chain(arguments.design.overrides()).collect();
    let mut reproduction =
        Reproduction { effort, studies: run_studies(&overrides, threads)?, ..Reproduction::default() };
    if arguments.only != Some(Topic::Claims) {
        reproduction.figures = figures(&reproduction.studies, effort)?;
        reproduction.animation = Some(coulomb()?);
    }
    if arguments.only != Some(Topic::Figures) {
        reproduction.claims = claims(&reproduction.studies, effort)?;
        reproduction.percentages = percentages(effort, threads)?;
    }
    let mut document = document(&reproduction);
    if arguments.only.is_none() && CAN_WRITE_PAGES {
        // The live page begins with all eight factors.
        add_live_page(&mut document, LIVE, live_page(&general_study(), threads, on_signal())?);
    }
    deliver(&artefacts, &document)
}

fn run_studies(overrides: &[String], threads: usize) -> anyhow::Result<Vec<Reproduced>> {
    let studies = studies(overrides)?;
    let count = studies.len();
    let mut reproduced = Vec::with_capacity(count);
    for (number, (group, friction, study)) in (1..).zip(studies) {
        let meter = Meter::new(&format!("{number} of {count} {:<21}", study.name()), study.design().rows());
        let result = study.runner().threads(threads).on_progress(|progress| meter.update(progress)).run()?;
        meter.finish(result.provenance.model_runs, result.provenance.wall_seconds);
        reproduced.push(Reproduced { friction, group, result });
    }
    Ok(reproduced)
}
