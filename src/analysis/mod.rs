//! The result of a run as the engine knows it: from merged sums to indices with intervals, counts and reasons.

mod estimate;
mod finished_run;
mod first_rows;
mod measures;
mod output;
mod rare_levels;
mod result;
mod series;
mod unlikely;
mod warning;
mod warnings;

pub(crate) use estimate::{analysis, interval_options, surrogates};
pub(crate) use finished_run::{FinishedRun, LowTotals, named_inputs, outputs_kept};
pub use measures::{MOST_ROWS_OF_MEASURES, RunMeasures};
pub use output::{FailureCount, LookupError, NoIndices, OutputAnalysis, SurrogateTrial};
pub use rare_levels::RareLevel;
pub(crate) use rare_levels::{enough_base_samples, rare_levels};
pub use result::{Aggregate, Analysis, LowRuns, Spending, StopReason, Stopped};
pub use series::SeriesAnalysis;
pub use unlikely::unlikely_outputs;
pub use warning::Warning;
#[cfg(feature = "charts")]
pub(crate) use {
    finished_run::{names_of_swaps, row_inputs},
    first_rows::FirstRows,
};
