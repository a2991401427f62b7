//! Results as documents: [`run_document`] and its relatives make them, [`Artefacts`] writes their files.

#[cfg(feature = "page")]
mod artefacts;
mod atomic_write;
mod build;
mod build_output;
pub mod chart;
pub mod comparison;
pub mod csv;
pub mod distribution;
pub mod document;
mod factor_bars;
mod file_names;
pub mod format;
pub mod given;
mod interval_widths;
mod leading;
mod read;
mod records;
mod result;
mod run_charts;
mod run_document;
pub mod salib;
pub mod scatter;
mod schema;
pub mod screening;
mod study_sections;
pub mod sweep;
mod text_table;

pub use crate::names::{file_part, refused_name};
pub use crate::words::{capitalised, listed};
#[cfg(feature = "page")]
pub use artefacts::{ArtefactError, Artefacts, Written};
pub use atomic_write::{
    WriteError, prepare_file, prepare_folder, remove_unfinished, stream_atomically, write_atomically,
};
pub use build::{RunFacts, result_json};
pub use build_output::inputs_in_words;
pub use factor_bars::{SharesSeries, shares_chart, study_chart};
pub use file_names::{ChartFormat, FileNames, file_stems};
pub use format::{estimate, fixed, share, share_of_runs, significant, two_digits, with_unit};
pub use interval_widths::{widest_interval, width_after_doubling};
pub use read::{ReadError, ReadProblem, parse_result, read_result};
pub use records::{Drawing, FactorSetup, StudySetup};
pub use result::*;
pub use run_charts::{convergence_chart, distribution_chart, indices_chart, interactions_chart, scatter_chart};
pub use run_document::{run_document, run_file_names};
pub use schema::result_schema;
pub use text_table::{TextTable, table, wrapped};
