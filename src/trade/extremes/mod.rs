//! What becomes of a study at the extremes: a map of where its numbers are right, where they are flagged, and where there
//! are none.
//!
//! Every cell of the map has one of three outcomes, see [`Outcome`]; the fourth, a number that is wrong without a word,
//! must not occur. The inputs go to the corners and edges of their ranges and far beyond; the outputs are scaled
//! and shifted, and the design is made as long as it goes.

mod cells;
mod charts;
mod document;
mod estimators;
mod indices;
mod judge;
mod map;
mod points;
mod record;

pub use document::extremes_document;
pub use map::{Example, Extremes, Grid, Kind, Outcome, Reason, Tally};
pub use record::{ExtremesFile, build_extremes};

use std::sync::atomic::AtomicBool;

use crate::model::RunContext;
use crate::run::{Progress, RunError};
use crate::study::Study;
use map::Collector;

/// How much is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExtremesSettings {
    /// About how many points the model is evaluated at. All steps of every factor past its bounds are among them,
    /// however many those are.
    pub points: u64,
    /// Most runs of the model for the indices of one design; longer ones are planned, and not run.
    pub max_runs: u64,
    /// Seed of the points that are chosen at random.
    pub seed: u64,
}

impl ExtremesSettings {
    /// What takes some seconds: fewer points of a model that takes its time, such as a program.
    pub fn of(study: &Study) -> Self {
        let seed = study.design().settings().seed;
        match study.model().concurrency() {
            Some(_) => Self { points: 160, max_runs: 160, seed },
            None => Self { points: 600, max_runs: 1 << 13, seed },
        }
    }
}

/// A study whose extremes are looked for.
#[derive(Clone, Copy)]
pub struct ExtremesJob<'a> {
    /// The study.
    pub study: &'a Study,
    /// How much is tried.
    pub settings: ExtremesSettings,
    /// Threads; 0 for one per core. The result is the same in every bit on any number.
    pub threads: usize,
    /// Ends the search soon after it is set.
    pub stop: Option<&'a AtomicBool>,
    /// Gets what programs say.
    pub on_message: fn(&str),
    /// Is told of points that have been evaluated.
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
}

impl<'a> ExtremesJob<'a> {
    /// With the settings of [`ExtremesSettings::of`], on one thread per core, and without a word.
    pub fn new(study: &'a Study) -> Self {
        let settings = ExtremesSettings::of(study);
        Self { study, settings, threads: 0, stop: None, on_message: |_| (), on_progress: &|_| () }
    }
}

/// The map of the extremes of a study.
///
/// ```
/// use std::path::Path;
/// use apportion::Study;
/// use apportion::trade::extremes::{ExtremesJob, extremes};
///
/// let study = Study::parse(include_str!("../../../studies/flood.toml"), Path::new("flood.toml"), &[])?;
/// let map = extremes(&ExtremesJob::new(&study))?;
/// assert!(map.counts().right > 0);
/// assert_eq!(map.counts().wrong, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if threads cannot be started or the search is ended. What the model refuses is part of the map.
pub fn extremes(job: &ExtremesJob<'_>) -> Result<Extremes, RunError> {
    let on_message = job.on_message;
    let context = RunContext::new(job.stop, on_message);
    let mut map = Collector::default();
    let (second, points) = cells::explore(job, &context, &mut map)?;
    estimators::explore(job, &mut map)?;
    Ok(map.into_map(second, points))
}
