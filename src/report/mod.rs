//! Exporters turn a result into bytes; one writer puts them on disk.

mod asked;
mod build;
mod build_output;
pub mod chart;
pub mod comparison;
pub mod distribution;
pub mod given;
mod leading;
pub mod page;
mod read;
mod result;
mod run_charts;
mod run_page;
pub mod salib;
pub mod scatter;
mod schema;
pub mod screening;
mod shares_chart;
pub mod sweep;
mod tables;
mod trend;
mod write;

pub use crate::names::{file_part, file_stems, refused_name};
pub use crate::words::{capitalised, listed};
pub use asked::{AskedFactor, AskedRecord, Drawing};
pub use build::{RunFacts, result_json};
pub use build_output::inputs_in_words;
pub use read::{ReadError, ReadProblem, parse_result, read_result};
pub use result::*;
pub use run_charts::{convergence_chart, distribution_chart, indices_chart, interactions_chart, scatter_chart};
pub use run_page::{RUN_CHARTS, run_page};
pub use schema::result_schema;
pub use shares_chart::{SharesSeries, SharesWords, friction_role, shares_chart, study_chart};
pub use tables::{
    TextTable, convergence_csv, estimate, estimators_csv, fixed, indices_csv, second_order_csv, share, share_of_runs,
    significant, summary, table, two_digits, with_unit, wrapped,
};
pub(crate) use tables::{csv_field, plain_field};
pub use trend::{widest_interval, width_after_doubling};
pub use write::{
    WriteError, prepare_file, prepare_folder, prepare_in, remove_unfinished, stream_atomically, write_atomically,
    write_in,
};
