//! A study's design as rows of numbers in the units of the study, and as a file, with the outputs of a run or without.

use std::io::Write;
use std::path::Path;

use apportion::design::{Design, DesignError, DesignSettings, Rows, Sampler};
use apportion::digest::Sha256;
use apportion::model::Output;
use apportion::quantity::Unit;
use apportion::run::{RowValues, Store};
use apportion::space::{Factor, Space};
use apportion::study::Study;

use super::manifest::Manifest;
use super::rows::{ColumnKind, Format, row_writer};

/// Approximate number of rows of a block.
const BLOCK: u64 = 1 << 13;

/// The position of a block of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowBlock {
    /// The replicate.
    pub replicate: u64,
    /// Number of its first row in the replicate.
    pub first: u64,
    /// Number of rows.
    pub rows: usize,
}

/// The rows of a design in the order of [`Design::locate`], each factor in its own unit, with only one block of them in
/// memory.
pub struct DesignRows<'a> {
    space: &'a Space,
    design: &'a Design,
    replicate: u64,
    /// The next base sample of the replicate.
    point: u64,
    values: RowValues,
}

impl<'a> DesignRows<'a> {
    /// Iterates over all rows of `design`, whose factors are those of `space`.
    pub fn new(space: &'a Space, design: &'a Design) -> Self {
        Self { space, design, replicate: 0, point: 0, values: RowValues::default() }
    }

    /// Computes the next block, with one vector for each factor; returns `None` after the last row.
    pub fn next_block(&mut self, into: &mut [Vec<f64>]) -> Option<RowBlock> {
        let design = self.design;
        if self.point == design.points_per_replicate() {
            (self.replicate, self.point) = (self.replicate + 1, 0);
        }
        if self.replicate == design.settings().replicates {
            return None;
        }
        let runs = design.rows_per_point();
        let points = (BLOCK / runs).max(1).min(design.points_per_replicate() - self.point);
        let (replicate, first, rows) = (self.replicate, self.point * runs, points * runs);
        let values = self.values.values(self.space, design, replicate, first..first + rows);
        for ((column, values), factor) in into.iter_mut().zip(values).zip(self.space.factors()) {
            column.clear();
            column.extend(values.iter().map(|value| at_the_edge(factor.unit(), *value)));
        }
        self.point += points;
        Some(RowBlock { replicate, first, rows: rows as usize })
    }
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

/// SHA-256 of the numbers of rows, row by row, each as the eight bytes of a little-endian double.
#[derive(Default)]
pub(super) struct RowsDigest(Sha256);

impl RowsDigest {
    /// Adds the rows of these columns.
    pub fn add(&mut self, columns: &[Vec<f64>]) {
        let rows = columns.first().map_or(0, Vec::len);
        let mut bytes = Vec::with_capacity(rows * columns.len() * size_of::<f64>());
        for row in 0..rows {
            bytes.extend(columns.iter().flat_map(|column| column[row].to_le_bytes()));
        }
        self.0.update(&bytes);
    }

    /// Returns the digest in hexadecimal.
    pub fn finish(self) -> String {
        self.0.finish()
    }
}

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
