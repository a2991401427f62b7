//! Tables of points and outputs as files: what joins the steps of a study when other programs take part.
//!
//! [`sample()`] writes the points, any program computes the outputs, [`read_answers`] reads them back into a
//! [`Store`](crate::run::Store) for a [`Runner`](crate::Runner): `examples/three_steps.rs` goes this way.
//! [`evaluate()`] is the other direction: the model of a study at points from anywhere.

mod answers;
mod design_rows;
mod evaluate;
mod manifest;
mod points;
mod rows;
mod sample;
mod save;
mod table;

pub use answers::{Answers, AnswersError, AnswersRequest, MissingOutputs, read_answers};
pub use design_rows::{DesignRows, RowBlock};
pub use evaluate::{EvaluateError, Evaluated, evaluate, evaluate_in};
pub use manifest::{
    Manifest, ManifestDesign, ManifestError, ManifestFactor, ManifestRun, ManifestStudy, design_sha256,
};
pub use points::{PointsError, PointsReader};
pub use rows::{
    ColumnKind, Format, RowReader, RowWriter, RowsError, open_rows, open_table, row_writer, rows_of_bytes,
    table_of_bytes,
};
pub use sample::sample;
pub use save::{SaveError, save_outputs};
pub use table::{DroppedRows, Missing, Selection, Table, TableError, read_table};
