//! Tables of points and outputs as files: what joins the steps of a study when other programs take part.

mod evaluate;
mod points;
mod table;

pub use evaluate::{EvaluateError, Evaluated, evaluate};
pub use points::{PointsError, PointsReader};
pub use table::{DroppedRows, Missing, Selection, Table, TableError, read_table};
