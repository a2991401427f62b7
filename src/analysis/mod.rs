//! The result of a run as the engine knows it: from merged sums to indices with intervals, counts and reasons.

mod estimate;
mod result;
mod warnings;

pub(crate) use estimate::{FinishedRun, analysis, interval_options};
#[cfg(feature = "charts")]
pub(crate) use estimate::{names_of_swaps, row_inputs};
pub use result::{
    Aggregate, Analysis, FailureCount, LookupError, MixedModels, NoIndices, OutputAnalysis, StopReason, Stopped,
};
