//! The rows of a design as numbers in the units of its study, block by block.

use apportion::design::Design;
use apportion::digest::Sha256;
use apportion::model::Output;
use apportion::quantity::Unit;
use apportion::run::RowValues;
use apportion::space::{Factor, Space};

use super::rows::ColumnKind;

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
