//! Analysis of a finished run: indices with intervals, counts, reasons and warnings from the merged sums.

mod aggregate;
mod finished_run;
mod first_rows;
mod indices;
mod measures;
mod output;
mod output_indices;
mod plain;
mod rare_levels;
mod result;
mod scatter;
mod series;
mod setup;
mod stages;
mod surrogates;
mod unlikely;
mod warnings;

pub(crate) use finished_run::{FinishedRun, LowFidelityTotals, named_inputs, outputs_kept};
pub(crate) use output_indices::{IntervalOptions, output_indices};
pub(crate) use plain::PlainOutputs;
pub(crate) use rare_levels::{enough_base_samples, rare_levels};
pub(crate) use result::result;
pub(crate) use surrogates::{interval_options, surrogates};
pub(crate) use warnings::is_doubted;
