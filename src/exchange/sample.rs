//! A study's design as a file of rows.

use std::io::Write;
use std::path::Path;

use super::design_rows::{DesignRows, RowsDigest, factor_column};
use super::manifest::Manifest;
use super::rows::{Format, row_writer};
use crate::study::Study;

/// Writes the rows of the design of `study` (read from `study_file`) to `out`, a column for each factor in its unit, and
/// returns the manifest that belongs beside it. Runs in constant memory.
///
/// # Errors
/// Whatever the file's system says.
pub fn sample(
    study: &Study,
    study_file: &Path,
    format: Format,
    out: &mut (dyn Write + Send),
) -> std::io::Result<Manifest> {
    let (space, design) = (&study.space, &study.design);
    let kinds = space.factors().iter().map(factor_column).collect();
    let mut writer = row_writer(format, out, kinds, design.rows())?;
    let mut rows = DesignRows::new(space, design);
    let mut columns = vec![Vec::new(); design.factors()];
    let mut digest = RowsDigest::default();
    while rows.next_block(&mut columns).is_some() {
        digest.add(&columns);
        let slices: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        writer.write(&slices)?;
    }
    writer.finish()?;
    Ok(Manifest::new(study, study_file, digest.finish()))
}
