//! The points and outputs of a finished run as a file of rows.

use std::io::Write;

use thiserror::Error;

use super::design_rows::{DesignRows, factor_column};
use super::rows::{ColumnKind, Format, row_writer};
use crate::design::Design;
use crate::run::Store;
use crate::study::Study;

/// Why outputs could not be saved.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The file.
    #[error(transparent)]
    File(#[from] std::io::Error),
    /// A row whose outputs are not there.
    #[error("the outputs of row {row} of the design were not kept")]
    NotKept {
        /// The row, from 1.
        row: u64,
    },
}

impl From<SaveError> for std::io::Error {
    fn from(error: SaveError) -> Self {
        match error {
            SaveError::File(error) => error,
            SaveError::NotKept { .. } => Self::other(error),
        }
    }
}

/// Writes the rows of `design` with the outputs that `store` has of them: the factors of `study`, then its outputs, each
/// in its unit, in the order of [`Design::locate`]. An output that failed is an empty cell (CSV) or NaN (NPY). Runs in constant memory beside the store.
///
/// # Errors
/// [`SaveError`] if the file cannot be written, or rows are missing in the store.
pub fn save_outputs(
    study: &Study,
    design: &Design,
    store: &Store,
    format: Format,
    out: &mut dyn Write,
) -> Result<(), SaveError> {
    let (space, model) = (&study.space, study.model());
    let outputs = model.outputs();
    let kinds = space.factors().iter().map(factor_column);
    let kinds = kinds.chain(outputs.iter().map(|output| ColumnKind::numbers(&output.name))).collect();
    let mut writer = row_writer(format, out, kinds, design.rows())?;
    let mut rows = DesignRows::new(space, design);
    let mut points = vec![Vec::new(); design.factors()];
    let mut answers = vec![Vec::new(); outputs.len()];
    let mut before = 0;
    while let Some(block) = rows.next_block(&mut points) {
        let range = block.first..block.first + block.rows as u64;
        let piece = store.piece(block.replicate, range).ok_or(SaveError::NotKept { row: before + 1 })?;
        for (number, (column, output)) in answers.iter_mut().zip(outputs).enumerate() {
            let of_output = piece.values.iter().skip(number).step_by(outputs.len());
            column.clear();
            column.extend(of_output.map(|si| output.unit.from_si(*si)));
        }
        let slices: Vec<&[f64]> = points.iter().chain(&answers).map(Vec::as_slice).collect();
        writer.write(&slices)?;
        before += block.rows as u64;
    }
    Ok(writer.finish()?)
}
