//! `apportion reproduce`: the papers' figures and claims, on one page.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use apportion::study::Study;

use super::output::{ChartArguments, deliver};
use super::progress::Meter;
use super::stop::on_signal;
use super::{DesignChanges, Failure, Threads};
use crate::live::{live_page, place_next_to};
use crate::reproduce::{Effort, Event, ReproduceError, Request, Topic, document, reproduce as run};

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

impl From<ReproduceError> for Failure {
    fn from(error: ReproduceError) -> Self {
        Self::input_if(matches!(error, ReproduceError::Study(_)), error)
    }
}

pub fn reproduce(arguments: &Arguments) -> Result<(), Failure> {
    let overrides = arguments.design.overrides();
    let artefacts = arguments.charts.artefacts(&arguments.out);
    artefacts.prepare()?;
    let request = Request {
        effort: if arguments.quick { Effort::Quick } else { Effort::Full },
        only: arguments.only,
        overrides,
        threads: arguments.threads.number(),
    };
    let current = Mutex::new(None);
    let reproduction = run(&request, &|event| show(&current, &event))?;
    let mut document = document(&reproduction);
    if request.only.is_none() {
        let page = live_page(&live_study()?, request.threads, on_signal())?;
        place_next_to(&mut document, LIVE, page);
    }
    deliver(&artefacts, &document)
}

/// The study that the live page begins with: all eight factors.
fn live_study() -> Result<Study, Failure> {
    Ok(apportion_files::parse_study(
        include_str!("../../../../studies/coulomb-general.toml"),
        Path::new("coulomb-general.toml"),
        &[],
    )?)
}

/// Shows how far the current study has come.
fn show(current: &Mutex<Option<Meter>>, event: &Event<'_>) {
    let Ok(mut current) = current.lock() else { return };
    match event {
        Event::Begins { number: (number, count), name, runs } => {
            *current = Some(Meter::new(&format!("{number} of {count} {name:<21}"), *runs));
        }
        Event::Progresses(progress) => current.iter().for_each(|meter| meter.update(*progress)),
        Event::Ends { runs, seconds } => current.iter().for_each(|meter| meter.finish(*runs, *seconds)),
    }
}
