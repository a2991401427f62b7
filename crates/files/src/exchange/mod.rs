//! Tables of points and outputs as files: they join the steps of a study when other programs take part.
//!
//! [`sample()`] writes the points, any program computes the outputs, [`read_answers`] reads them back into a
//! [`Store`](apportion::run::Store) for a [`Runner`](apportion::Runner): see `examples/three_steps.rs`. [`evaluate()`]
//! is the other direction: it evaluates the model of a study at given points.

mod answers;
mod counter;
mod design_rows;
mod error;
mod evaluate;
mod manifest;
mod rows;
mod table;

pub use answers::{Answers, AnswersRequest, read_answers};
pub use design_rows::{Points, factor_column, sample, write_rows};
pub use error::TableError;
pub use evaluate::{EvaluateError, Evaluated, evaluate};
pub use manifest::Manifest;
pub(crate) use rows::number;
pub use rows::{ColumnKind, Format, Joined, ReadOptions, RowReader, RowWriter, open_table, table_of_bytes};
pub use table::{DroppedRows, Missing, Selection, Table, read_table};
