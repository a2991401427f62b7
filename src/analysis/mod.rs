//! Analysis of a finished run: indices with intervals, counts, reasons and warnings from the merged sums.

mod aggregate;
mod finished_run;
mod first_rows;
mod indices;
mod measures;
mod output;
mod output_indices;
mod rare_levels;
mod result;
mod scatter;
mod series;
mod setup;
mod stages;
mod surrogates;
mod unlikely;
mod warnings;

pub use finished_run::inputs_in_words;
pub(crate) use finished_run::{FinishedRun, LowFidelityTotals, named_inputs, outputs_kept};
pub(crate) use output_indices::{IntervalOptions, output_indices};
pub(crate) use rare_levels::{enough_base_samples, rare_levels};
pub(crate) use result::result;
pub use setup::{study_setup, validity};
pub(crate) use surrogates::{interval_options, surrogates};
pub use unlikely::unlikely_outputs;

/// Minimum number of outputs that have indices over all together, and an overview instead of pages for each.
pub const MIN_OUTPUTS_TOGETHER: usize = 12;
