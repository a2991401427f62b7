//! Why a growing run ended.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a growing run ended, and its targets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StoppingRecord {
    /// The reason.
    pub reason: StopReason,
    /// Whether every index met the target; `null` if there was none.
    pub target_met: Option<bool>,
    /// The requested half width.
    pub target_half_width: Option<f64>,
    /// The maximum time, in seconds.
    pub budget_seconds: Option<f64>,
    /// The maximum number of model runs.
    pub max_runs: Option<u64>,
}

/// Why a growing run was not doubled again.
#[derive(Debug, Clone, Copy, PartialEq, Error, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// Every interval is as narrow as requested.
    #[error("every half width is {widest:.2e} or less: the target of {target} is met")]
    TargetMet { widest: f64, target: f64 },
    /// An output has no indices or no intervals, and more runs are not expected to change this.
    #[error(
        "indices or intervals are missing with {base_samples} base samples, and more runs may not help: see the reasons at \
         the outputs, or start with more base samples"
    )]
    NoIntervals { base_samples: u64 },
    /// Every interval is as narrow as requested, but a level of a factor is rare among the rows.
    #[error(
        "every half width is {widest:.2e} or less, but a level of a factor is in too few rows for reliable intervals: \
         about {base_samples:.0} base samples would contain it ten times"
    )]
    RareLevels { widest: f64, base_samples: f64 },
    /// There are no more points.
    #[error("the sequence has no more points")]
    EndOfSequence,
    /// The outputs of twice the runs would not fit into memory.
    #[error("the outputs of twice the runs would not fit into memory, and these intervals need all of them")]
    Memory,
    /// The next stage would have too many runs.
    #[error("the next stage would have {runs} runs in all, more than the maximum of {most}")]
    MaxRuns { runs: u64, most: u64 },
    /// The next stage would take too long.
    #[error("the next stage would take about {seconds:.1} s in all, more than the budget of {budget} s")]
    Budget { seconds: f64, budget: f64 },
}

/// What a run with a target accuracy chose, and why.
#[derive(Debug, Clone, Copy, PartialEq, Error, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "code", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AccuracyReason {
    /// Neither surrogates nor low-fidelity models serve the study.
    #[error(
        "surrogates and cheaper models need independent factors, and three or more replicates of Sobol' or random points"
    )]
    NoSurrogates,
    /// A surrogate of plain rows reached the accuracy.
    #[error("a surrogate of {runs} runs, each at a point of its own, was enough")]
    PlainRows { runs: u64 },
    /// A surrogate explained this share of the variance of runs that it was not fitted to: what it leaves is measured by
    /// swaps.
    #[error("a surrogate of {runs} runs explained {:.1} % of the variance: swaps of their points measure the rest", 100.0 * explained)]
    Swaps { runs: u64, explained: f64 },
    /// Corrected indices of that many runs would not reach the accuracy.
    #[error("corrected indices of {runs} runs would not reach the accuracy: no surrogates")]
    PlainIndices { runs: u64 },
}
