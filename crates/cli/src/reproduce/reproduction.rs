//! The whole reproduction: studies, figures, claims and percentages, in this order.

use apportion::run::Progress;

use super::claims::{Claim, claims};
use super::figures::{Animation, PaperFigure, animation, figures};
use super::percentages::{Percentages, percentages};
use super::{Effort, QUICK, ReproduceError, Reproduced, studies};

/// What to reproduce.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Request {
    /// How much is computed.
    pub effort: Effort,
    /// A single part; everything if `None`.
    pub only: Option<Topic>,
    /// Changes to the design of every study, such as `design.seed=1`. Under others they are no longer the papers' studies.
    pub overrides: Vec<String>,
    /// Threads; 0 means one per core. The results do not depend on it.
    pub threads: usize,
}

/// A part of the reproduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Topic {
    /// The figures of the papers.
    Figures,
    /// The verdicts on their claims, and their percentages with ours.
    Claims,
}

/// A reproduction that has taken place.
#[derive(Debug, Clone, Default)]
pub struct Reproduction {
    /// How much was computed.
    pub effort: Effort,
    /// The nine studies, group by group.
    pub studies: Vec<Reproduced>,
    /// The figures of the papers, if asked for.
    pub figures: Vec<PaperFigure>,
    /// The animation, if figures were asked for.
    pub animation: Option<Animation>,
    /// The claims with their verdicts, if asked for.
    pub claims: Vec<Claim>,
    /// Our shares and the printed percentages, if claims were asked for.
    pub percentages: Vec<Percentages>,
}

/// What happens during a reproduction.
#[derive(Debug, Clone)]
pub enum Event<'a> {
    /// A study of so many model runs begins.
    Begins {
        /// Its number from 1, and how many there are.
        number: (usize, usize),
        /// Its name.
        name: &'a str,
        /// Its model runs.
        runs: u64,
    },
    /// How far the study has come.
    Progresses(Progress),
    /// The study is over after so many seconds.
    Ends {
        /// Its model runs.
        runs: u64,
        /// Seconds.
        seconds: f64,
    },
}

/// Reproduces what `request` asks for. `on_event` may be called from any thread.
///
/// # Errors
/// [`ReproduceError`] if an override makes no sense, or a part cannot be computed.
pub fn reproduce(request: &Request, on_event: &(dyn Fn(Event<'_>) + Sync)) -> Result<Reproduction, ReproduceError> {
    let Request { effort, only, threads, .. } = *request;
    let asked = |topic: Topic| only.is_none_or(|only| only == topic);
    let studies = run_studies(request, on_event)?;
    let mut reproduction = Reproduction { effort, studies, ..Reproduction::default() };
    if asked(Topic::Figures) {
        reproduction.figures = figures(&reproduction.studies, effort)?;
        reproduction.animation = Some(animation()?);
    }
    if asked(Topic::Claims) {
        reproduction.claims = claims(&reproduction.studies, effort)?;
        reproduction.percentages = percentages(effort, threads)?;
    }
    Ok(reproduction)
}

fn run_studies(request: &Request, on_event: &(dyn Fn(Event<'_>) + Sync)) -> Result<Vec<Reproduced>, ReproduceError> {
    let quick = if request.effort == Effort::Quick { &QUICK[..] } else { &[] };
    let overrides: Vec<String> =
        quick.iter().map(|&setting| setting.to_owned()).chain(request.overrides.iter().cloned()).collect();
    let studies = studies(&overrides)?;
    let count = studies.len();
    let mut reproduced = Vec::with_capacity(count);
    for (place, (group, friction, study)) in studies.iter().enumerate() {
        let number = (place + 1, count);
        on_event(Event::Begins { number, name: study.name(), runs: study.design().rows() });
        let result = study
            .runner()
            .threads(request.threads)
            .on_progress(|progress| on_event(Event::Progresses(progress)))
            .run()?;
        let provenance = &result.provenance;
        on_event(Event::Ends { runs: provenance.model_runs, seconds: provenance.wall_seconds });
        reproduced.push(Reproduced { friction: *friction, group: *group, result });
    }
    Ok(reproduced)
}
