//! A study's design as rows of numbers in the units of the study, and as a file, with the outputs of a run or without.

use std::io::Write;
use std::ops::Range;
use std::path::Path;

use apportion::design::Design;
use apportion::model::Output;
use apportion::run::{RowValues, Store};
use apportion::screening::{self, ScreeningError, ScreeningSettings};
use apportion::space::{Factor, Space};
use apportion::study::Study;
use apportion_base::digest::Sha256;
use apportion_base::quantity::Unit;

use super::manifest::Manifest;
use super::rows::{ColumnKind, Format, RowWriter};

/// Approximate number of rows of a block.
const BLOCK: u64 = 1 << 13;

/// The rows of a file of points.
pub enum Points<'a> {
    /// Those of a design.
    Design(&'a Design),
    /// Those of a screening with these settings: for each factor a column of SI values.
    Screening(ScreeningSettings, Vec<Vec<f64>>),
}

impl<'a> Points<'a> {
    /// Returns those of a screening of `study`, or else of its design.
    ///
    /// # Errors
    /// [`ScreeningError`] if the settings are invalid or the factors depend on each other.
    pub fn from_study(study: &'a Study, screening: Option<ScreeningSettings>) -> Result<Self, ScreeningError> {
        let Some(settings) = screening else { return Ok(Self::Design(study.design())) };
        Ok(Self::Screening(settings, screening::points(study, settings)?))
    }

    /// Returns their number.
    pub fn rows(&self) -> u64 {
        match self {
            Self::Design(design) => design.rows(),
            Self::Screening(_, columns) => columns.first().map_or(0, Vec::len) as u64,
        }
    }
}

/// Computes the rows of `points`, whose factors are those of `space`, in the order of [`Design::locate`], and passes
/// them to `see` block by block: the replicate, the rows in it, and a column for each factor in its own unit. Only one
/// block is in memory.
pub(super) fn each_block<E>(
    space: &Space,
    points: &Points<'_>,
    mut see: impl FnMut(u64, Range<u64>, &mut [Vec<f64>]) -> Result<(), E>,
) -> Result<(), E> {
    let design = match points {
        Points::Design(design) => design,
        Points::Screening(_, columns) => {
            let columns = columns.iter().zip(space.factors());
            let in_units = columns.map(|(si, factor)| si.iter().map(|si| at_the_edge(factor.unit(), *si)).collect());
            return see(0, 0..points.rows(), &mut in_units.collect::<Vec<_>>());
        }
    };
    let (runs, points) = (design.rows_per_point(), design.points_per_replicate());
    let step = (BLOCK / runs).max(1);
    let (mut row_values, mut columns) = (RowValues::default(), vec![Vec::new(); design.factors()]);
    for replicate in 0..design.settings().replicates {
        for point in (0..points).step_by(step as usize) {
            let rows = point * runs..(point + step).min(points) * runs;
            let values = row_values.values(space, design, replicate, rows.clone());
            for ((column, values), factor) in columns.iter_mut().zip(values).zip(space.factors()) {
                column.clear();
                column.extend(values.iter().map(|value| at_the_edge(factor.unit(), *value)));
            }
            see(replicate, rows, &mut columns)?;
        }
    }
    Ok(())
}

/// Returns the SI value `si` in `unit`: of the neighbouring numbers the one that converts back to `si`, if any.
fn at_the_edge(unit: &Unit, si: f64) -> f64 {
    let value = unit.from_si(si);
    let near = [value, value.next_up(), value.next_down()];
    near.into_iter().find(|near| unit.to_si(*near) == si).unwrap_or(value)
}

/// Returns the column of a factor in files of rows.
pub fn factor_column(factor: &Factor) -> ColumnKind {
    let law = factor.distribution();
    let labels = law.labels().unwrap_or_default().iter();
    let labels = labels.filter_map(|label| Some((label.clone(), law.value_of(label)?))).collect();
    ColumnKind { labels, whole: law.is_whole(), ..ColumnKind::numbers(&factor.name) }
}

/// Returns the columns of files with points and outputs.
pub(super) fn columns(factors: &[Factor], outputs: &[Output]) -> Vec<ColumnKind> {
    factors.iter().map(factor_column).chain(outputs.iter().map(|output| ColumnKind::numbers(&output.name))).collect()
}

/// Adds the rows of these columns to a digest, row by row, each number as the eight bytes of a little-endian double.
pub(super) fn add_rows(digest: &mut Sha256, columns: &[Vec<f64>]) {
    let rows = columns.first().map_or(0, Vec::len);
    let mut bytes = Vec::with_capacity(rows * columns.len() * size_of::<f64>());
    for row in 0..rows {
        bytes.extend(columns.iter().flat_map(|column| column[row].to_le_bytes()));
    }
    digest.update(&bytes);
}

/// Writes these points of `study` (read from `study_file`) to `out`, a column for each factor in its unit,
/// and returns the manifest to be written next to it. Those of a design use constant memory.
///
/// # Errors
/// Any error of the file system.
pub fn sample(
    study: &Study,
    study_file: &Path,
    points: &Points<'_>,
    format: Format,
    out: &mut dyn Write,
) -> std::io::Result<Manifest> {
    let screening = if let Points::Screening(settings, _) = points { Some(*settings) } else { None };
    let digest = write_rows(study, points, None, format, out)?;
    Ok(Manifest::new(study, study_file, screening, digest))
}

/// Writes the rows of `points`, a column for each factor of `study` in its unit, and returns the SHA-256 of their
/// numbers.
///
/// With a store, each row is followed by its outputs in their units; a failed output is an empty cell (CSV) or NaN
/// (NPY). Uses constant memory in addition to the store.
///
/// # Errors
/// An error of the operating system, or rows that are missing in the store.
pub fn write_rows(
    study: &Study,
    points: &Points<'_>,
    store: Option<&Store>,
    format: Format,
    out: &mut dyn Write,
) -> std::io::Result<String> {
    let (space, model) = (study.space(), study.model());
    let outputs = if store.is_some() { model.outputs() } else { &[] };
    let mut writer = RowWriter::new(format, out, columns(space.factors(), outputs), points.rows())?;
    let mut answers = vec![Vec::new(); outputs.len()];
    let mut digest = Sha256::default();
    each_block(space, points, |replicate, rows, points| {
        add_rows(&mut digest, points);
        if let Some(store) = store {
            let block = store.block(replicate, rows);
            let block = block.ok_or_else(|| std::io::Error::other("outputs of the design are missing"))?;
            for (number, (column, output)) in answers.iter_mut().zip(outputs).enumerate() {
                let of_output = block.values.iter().skip(number).step_by(outputs.len());
                *column = of_output.map(|si| output.unit.from_si(*si)).collect();
            }
        }
        let slices: Vec<&[f64]> = points.iter().chain(&answers).map(Vec::as_slice).collect();
        writer.write(&slices)
    })?;
    writer.finish()?;
    Ok(digest.finish())
}
