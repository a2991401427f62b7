//! The points and outputs of a finished run as a file of rows.

use std::io::Write;

use apportion::design::Design;
use apportion::run::Store;
use apportion::study::Study;

use super::design_rows::{DesignRows, columns};
use super::rows::{Format, row_writer};

/// Writes the rows of `design` with their outputs in `store`: the factors of `study`, then its outputs, each in its
/// unit, in the order of [`Design::locate`]. A failed output is an empty cell (CSV) or NaN (NPY). Uses constant
///
/// # Errors
/// An error of the operating system, or rows that are missing in the store.
pub fn save_outputs(
    study: &Study,
    design: &Design,
    store: &Store,
    format: Format,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let (space, model) = (study.space(), study.model());
    let outputs = model.outputs();
    let mut writer = row_writer(format, out, columns(space.factors(), outputs), design.rows())?;
    let mut rows = DesignRows::new(space, design);
    let mut points = vec![Vec::new(); design.factors()];
    let mut answers = vec![Vec::new(); outputs.len()];
    while let Some(block) = rows.next_block(&mut points) {
        let range = block.first..block.first + block.rows as u64;
        let piece = store.piece(block.replicate, range);
        let piece = piece.ok_or_else(|| std::io::Error::other("outputs of the design are missing"))?;
        for (number, (column, output)) in answers.iter_mut().zip(outputs).enumerate() {
            let of_output = piece.values.iter().skip(number).step_by(outputs.len());
            column.clear();
            column.extend(of_output.map(|si| output.unit.from_si(*si)));
        }
        let slices: Vec<&[f64]> = points.iter().chain(&answers).map(Vec::as_slice).collect();
        writer.write(&slices)?;
    }
    writer.finish()
}
