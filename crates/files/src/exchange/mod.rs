//! Tables of points and outputs as files: they join the steps of a study when other programs take part.
//!
//! [`sample()`] writes the points, any program computes the outputs, [`read_answers`] reads them back into a
//! [`Store`](apportion::run::Store) for a [`Runner`](apportion::Runner): see `examples/three_steps.rs`. [`evaluate()`]
//! is the other direction: it evaluates the model of a study at given points.

mod answers;
mod design_rows;
mod error;
mod evaluate;
mod manifest;
mod rows;
mod table;

pub use answers::{AnswersRequest, read_answers};
pub use design_rows::{random_design, sample, write_rows};
pub use error::TableError;
pub use evaluate::{EvaluateError, Evaluated, evaluate};
pub use manifest::Manifest;
pub(crate) use rows::number;
pub use rows::{Format, ReadOptions, RowReader, open_table};
pub use table::{Missing, Selection, Table, read_table};
// Other items that the program and the tests use.
pub use {
    answers::{Answers, first_output, output_columns},
    design_rows::factor_column,
    manifest::{ManifestDesign, ManifestFactor, ManifestRun, ManifestStudy},
    rows::{ColumnKind, RowWriter, table_of_bytes},
    table::DroppedRows,
};
