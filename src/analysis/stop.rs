//! Why a run that grows ended.

use thiserror::Error;

/// Why a growing run ended, and whether it met its target.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stopped {
    /// Why.
    pub reason: StopReason,
    /// Whether every index met the target; `None` if there was none.
    pub target_met: Option<bool>,
}

/// Why a growing run was not doubled once more.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub(crate) enum StopReason {
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
