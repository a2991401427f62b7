//! Results as documents: [`run_document`] and its relatives make them, [`Artefacts`] writes their files.

#[cfg(feature = "page")]
mod artefacts;
mod atomic_write;
#[doc(hidden)]
pub mod chart;
#[doc(hidden)]
pub mod comparison;
#[doc(hidden)]
pub mod csv;
#[doc(hidden)]
pub mod document;
mod factor_bars;
mod file_names;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
pub mod given;
mod histogram_chart;
mod interval_widths;
mod leading;
mod run_charts;
mod run_document;
#[doc(hidden)]
pub mod screening;
mod study_sections;
#[doc(hidden)]
pub mod sweep;
mod text_table;
mod validity;

#[cfg(feature = "page")]
pub use artefacts::{ArtefactError, Artefacts};
pub use atomic_write::{WriteError, write_atomically};
pub use chart::Chart;
pub use document::Document;
pub use factor_bars::{shares_chart, study_chart};
pub use file_names::ChartFormat;
pub use histogram_chart::histogram_chart;
pub use run_charts::{convergence_chart, distribution_chart, indices_chart, pairs_chart, scatter_chart};
pub use run_document::run_document;

pub(crate) use study_sections::inputs;

// Open to the program, which is a crate of its own.
#[cfg(feature = "page")]
#[doc(hidden)]
pub use artefacts::Written;
#[doc(hidden)]
pub use {
    crate::names::{file_part, refused_name},
    crate::text::{capitalised, listed},
    atomic_write::{prepare_file, prepare_folder, stream_atomically},
    factor_bars::SharesSeries,
    file_names::file_stems,
    format::{fixed, give_or_take, grouped, share, share_of_runs, significant, two_digits, with_unit},
    interval_widths::{indices_measured, widest_interval},
    run_document::{TRY, one_output},
    text_table::{TextTable, table},
};
