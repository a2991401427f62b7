//! Reasons why a growing run stops.

use thiserror::Error;

/// Why a growing run ended, and whether it met its target.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stopped {
    /// The reason.
    pub reason: StopReason,
    /// Whether every index met the target; `None` if there was none.
    pub target_met: Option<bool>,
}

/// Why a growing run was not doubled again.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub(crate) enum StopReason {
    /// Every interval is as narrow as requested.
    #[error("every half width is {widest:.2e} or less: the target of {target} is met")]
    TargetMet {
        /// The largest half width.
        widest: f64,
        /// The requested half width.
        target: f64,
    },
    /// An output has no indices or no intervals, and more runs are not expected to change this.
    #[error(
        "there are indices or intervals missing with {base_samples} base samples, and nothing says that more runs would bring \
         them: see what is said of the outputs, or begin with more base samples"
    )]
    NoIntervals {
        /// Base samples of the run.
        base_samples: u64,
    },
    /// Every interval is as narrow as requested, but a level of a factor is rare among the rows.
    #[error(
        "every half width is {widest:.2e} or less, but rows hardly met a level of a factor, so that nothing can be promised: \
         some {base_samples:.0} base samples would meet it ten times"
    )]
    RareLevels {
        /// The largest half width.
        widest: f64,
        /// Base samples with which each level is expected ten times.
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
        /// The maximum number of runs.
        most: u64,
    },
    /// Twice the runs would take too long.
    #[error("twice the runs would take some {seconds:.1} s, more than the budget of {budget} s")]
    Budget {
        /// The seconds that twice the runs would take.
        seconds: f64,
        /// The maximum time in seconds.
        budget: f64,
    },
}
