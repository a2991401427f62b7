//! The result of a run as the engine knows it: from merged sums to indices with intervals, counts and reasons.

mod estimate;
mod finished_run;
mod result;
mod warnings;

pub(crate) use estimate::{analysis, interval_options, surrogate};
pub(crate) use finished_run::FinishedRun;
#[cfg(feature = "charts")]
pub(crate) use finished_run::{names_of_swaps, row_inputs};
pub use result::{
    Aggregate, Analysis, FailureCount, LookupError, MixedModels, NoIndices, OutputAnalysis, StopReason, Stopped,
};
