//! Results as documents: [`run_document`] and similar functions build them, [`Artefacts`] writes their files.

#![deny(clippy::disallowed_methods)]

mod artefacts;
mod atomic_write;
pub mod chart;
pub mod comparison;
pub mod csv;
pub mod document;
mod factor_bars;
mod file_names;
pub mod format;
pub mod given;
mod leading;
mod output_view;
mod outputs;
mod precision;
mod run_charts;
mod run_document;
pub mod screening;
mod study_sections;
pub mod sweep;
mod text_table;

pub use artefacts::{ArtefactError, Artefacts, Written};
pub use atomic_write::{WriteError, prepare_file, prepare_folder, stream_atomically, write_atomically};
pub use chart::Chart;
pub use document::Document;
pub use factor_bars::{SharesSeries, shapley_chart, shares_chart};
pub use file_names::{ChartFormat, file_stems};
pub use format::{fixed, give_or_take, grouped, share, share_of_runs, significant, two_digits, with_unit};
pub use output_view::Subject;
pub use outputs::{FileList, Refusal, prepare_outputs};
pub use run_charts::{convergence_chart, distribution_chart, indices_chart, pairs_chart, scatter_chart};
pub use run_document::{lines_to_repeat, output_document, run_document};
pub use study_sections::inputs;
pub use text_table::{TextTable, table};
