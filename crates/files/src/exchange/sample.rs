//! A study's design as a file of rows.

use std::io::Write;
use std::path::Path;

use apportion::design::{Design, DesignError, DesignSettings, Rows, Sampler};
use apportion::study::Study;

use super::design_rows::{DesignRows, RowsDigest, columns};
use super::manifest::Manifest;
use super::rows::{Format, row_writer};

/// Writes the rows of the design of `study` (read from `study_file`) to `out`, a column for each factor in its unit,
/// and returns the manifest to be written next to it. Uses constant memory.
///
/// # Errors
/// Any error of the file system.
pub fn sample(study: &Study, study_file: &Path, format: Format, out: &mut dyn Write) -> std::io::Result<Manifest> {
    let digest = write_rows(study, study.design(), study.design().rows(), format, out)?;
    Ok(Manifest::new(study, study_file, digest))
}

/// Returns the design whose first `rows` rows are random points of the factors of `study`, independent of each other.
/// They are determined by the seed of the study.
///
/// # Errors
/// [`DesignError`] if `rows` is 0 or more than 2^33.
pub fn random_design(study: &Study, rows: u64) -> Result<Design, DesignError> {
    // Only the rows A and B of a design.
    let settings = DesignSettings {
        sampler: Sampler::Random,
        base_samples: rows.div_ceil(2).max(2),
        replicates: 1,
        seed: study.design().settings().seed,
    };
    let of_design = Rows { copula: study.design().asked().copula.clone(), ..Rows::default() };
    Design::new(settings, study.design().factors(), of_design)
}

/// Writes the first `most` rows of `design`, a column for each factor of `study` in its unit, and returns the SHA-256
/// of their numbers. Those of a [`random_design`] are a table for [`apportion::given`], not a design of the study.
///
/// # Errors
/// Any error of the file system.
pub fn write_rows(
    study: &Study,
    design: &Design,
    most: u64,
    format: Format,
    out: &mut dyn Write,
) -> std::io::Result<String> {
    let space = study.space();
    let mut writer = row_writer(format, out, columns(space.factors(), &[]), most)?;
    let mut rows = DesignRows::new(space, design);
    let mut points = vec![Vec::new(); design.factors()];
    let (mut digest, mut left) = (RowsDigest::default(), most);
    while let Some(block) = rows.next_block(&mut points) {
        if left < block.rows as u64 {
            points.iter_mut().for_each(|column| column.truncate(left as usize));
        }
        left = left.saturating_sub(block.rows as u64);
        digest.add(&points);
        let slices: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
        writer.write(&slices)?;
    }
    writer.finish()?;
    Ok(digest.finish())
}
