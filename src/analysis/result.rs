//! What a run of a study has found: numbers with their intervals, counts and reasons, in SI units.

use thiserror::Error;

use serde::{Deserialize, Serialize};

use super::output::{LookupError, OutputAnalysis};
use super::series::SeriesAnalysis;
use super::warning::Warning;
use crate::design::Design;
use crate::estimate::{Scaling, Undefined};
use crate::model::{Counter, Flag};
use crate::run::Repeats;
use crate::study::SurrogateChoice;
use crate::uncertainty::AggregateIndices;

/// The result of a run of a [`Study`](crate::study::Study).
///
/// ```
/// use apportion::function_model;
/// use apportion::Distribution;
/// use apportion::Study;
///
/// let study = Study::builder("product", function_model("y", |x| x[0] * x[1]))
///     .factor("a", Distribution::uniform(1.0, 2.0)?)
///     .factor("b", Distribution::uniform(1.0, 5.0)?)
///     .base_samples(1024)
///     .build()?;
/// let analysis = study.run()?;
/// let total = analysis.output("y")?.factor("a")?.total;
/// assert!(total.interval.is_some_and(|interval| interval.low < total.estimate));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Analysis {
    /// The design as it was in the end: a run that grows leaves the study's own behind.
    pub design: Design,
    /// The outputs in the order of the model.
    pub outputs: Vec<OutputAnalysis>,
    /// The validity flags of the model, and how many runs raised each.
    pub flags: Vec<(Flag, u64)>,
    /// What the model counted, in the order of its counters.
    pub counts: Vec<(Counter, f64)>,
    /// Indices over all outputs together, if the study asks for them and there are two outputs or more; or over those that
    /// belong to no series, if they are 12 or more.
    pub aggregate: Option<Aggregate>,
    /// The outputs that are series, in the order of the model.
    pub series: Vec<SeriesAnalysis>,
    /// Why a growing run ended; `None` for one of fixed size.
    pub stopped: Option<Stopped>,
    /// Threads that ran the model.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
    /// The cheaper models that were run beside the model.
    pub lows: Vec<LowRuns>,
    /// What a run that was to be accurate chose, and why; `None` for others.
    pub spending: Option<Spending>,
}

/// What a run that was asked for an [accuracy](crate::Target::accuracy) chose, and why.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Spending {
    /// The half width that was asked for.
    pub accuracy: f64,
    /// Runs of the model in all, those of trials included.
    pub runs: u64,
    /// Whether surrogates were fitted.
    pub surrogate: SurrogateChoice,
    /// Runs that the same half width would take at least without surrogates and cheaper models, by the intervals of the plain
    /// indices of this run, if they fall in proportion to the runs: those of rough outputs fall more slowly. `None` if they
    /// are unknown.
    pub plain_runs: Option<u64>,
    /// Why it was chosen, in sentences.
    pub reasons: Vec<String>,
}

/// The runs of a cheaper model beside those of the model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "study", derive(schemars::JsonSchema), schemars(rename = "LowRecord"))]
#[non_exhaustive]
pub struct LowRuns {
    /// Its name.
    pub name: String,
    /// Runs at the rows of the model.
    pub shared_runs: u64,
    /// Base samples of its own design.
    pub own_base_samples: u64,
    /// Runs of that.
    pub own_runs: u64,
}

/// Indices over several outputs together.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Aggregate {
    /// Their names.
    pub outputs: Vec<String>,
    /// How outputs are weighed against each other.
    pub scaling: Scaling,
    /// The indices of the factors, and then of the other swaps.
    pub indices: Result<AggregateIndices, Undefined>,
}

/// Why a growing run ended, and whether it met its target.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Stopped {
    /// Why.
    pub reason: StopReason,
    /// Whether every index met the target; `None` if there was none.
    pub target_met: Option<bool>,
}

/// Why a growing run was not doubled once more.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum StopReason {
    /// Every interval is as narrow as asked for.
    #[error("every half width is {widest:.2e} or less: the target of {target} is met")]
    TargetMet {
        /// The largest half width.
        widest: f64,
        /// The half width that was asked for.
        target: f64,
    },
    /// An output has no indices or no intervals, and nothing says that more runs would bring them.
    #[error(
        "there are indices or intervals missing with {base_samples} base samples, and nothing says that more runs would bring \
         them: see what is said of the outputs, or begin with more base samples"
    )]
    NoIntervals {
        /// Base samples that it has none of.
        base_samples: u64,
    },
    /// Every interval is as narrow as asked for, but rows have hardly met a level of a factor.
    #[error(
        "every half width is {widest:.2e} or less, but rows hardly met a level of a factor, so that nothing can be promised: \
         some {base_samples:.0} base samples would meet it ten times"
    )]
    RareLevels {
        /// The largest half width.
        widest: f64,
        /// Base samples with which they would meet it ten times.
        base_samples: f64,
    },
    /// There are no more points.
    #[error("the sequence of points has come to its end")]
    EndOfSequence,
    /// The outputs of twice the runs would not fit into memory.
    #[error("the outputs of twice the runs would not fit: these intervals need all of them at once")]
    Memory,
    /// Twice the runs would be too many.
    #[error("twice the runs would be {runs}, more than max_runs = {most}")]
    MaxRuns {
        /// Twice the runs.
        runs: u128,
        /// The runs that it might take.
        most: u64,
    },
    /// Twice the runs would take too long.
    #[error("twice the runs would take some {seconds:.1} s, more than the budget of {budget} s")]
    Budget {
        /// The seconds that twice the runs would take.
        seconds: f64,
        /// The seconds that the run might take.
        budget: f64,
    },
}

impl Analysis {
    /// Warns of the outputs that had other values when rows were run again.
    pub(crate) fn note_repeats(&mut self, repeats: &Repeats, has_noise: bool) {
        for (output, differing) in self.outputs.iter_mut().zip(&repeats.differing) {
            let text = repeats.warning(*differing, has_noise);
            output.warnings.extend(text.map(|text| Warning::Irreproducible { text }));
        }
    }

    /// The output called `name`.
    ///
    /// # Errors
    /// [`LookupError`] with the names that there are.
    pub fn output(&self, name: &str) -> Result<&OutputAnalysis, LookupError> {
        let known = || self.outputs.iter().map(|output| output.name.clone()).collect();
        let found = self.outputs.iter().find(|output| output.name == name);
        found.ok_or_else(|| LookupError::UnknownName { what: "output", name: name.to_owned(), known: known() })
    }

    /// The series called `name`.
    ///
    /// # Errors
    /// [`LookupError`] with the names that there are.
    pub fn series(&self, name: &str) -> Result<&SeriesAnalysis, LookupError> {
        let known = || self.series.iter().map(|series| series.series.name.clone()).collect();
        let found = self.series.iter().find(|series| series.series.name == name);
        found.ok_or_else(|| LookupError::UnknownName { what: "series", name: name.to_owned(), known: known() })
    }
}
