//! Points from a table: columns named after factors, values in the factors' units.

use thiserror::Error;

use super::design_rows::factor_column;
use super::rows::{ColumnKind, RowReader, RowsError};
use crate::space::{Factor, Space};
use crate::study::{did_you_mean, nearest};

/// What is wrong with a file of points.
#[derive(Debug, Error)]
pub enum PointsError {
    /// The file.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// A file without names of columns, and nobody has given them.
    #[error("its {width} columns have no names: name the factors in their order (--names), out of {known}")]
    Unnamed {
        /// Number of columns.
        width: usize,
        /// The factors of the study.
        known: String,
    },
    /// A column that is no factor.
    #[error("column {column}: `{name}` is no factor of the study{}; its factors are {known}", did_you_mean(.nearest))]
    UnknownColumn {
        /// Number of the column, from 1.
        column: usize,
        /// Its header.
        name: String,
        /// The nearest factor.
        nearest: Option<String>,
        /// The factors of the study.
        known: String,
    },
    /// A cell that is no value of its factor.
    #[error("{place}: column {column} (`{name}`): expected {expected}, not {found}")]
    WrongCell {
        /// Line of the file, or row of the table, in words.
        place: String,
        /// Number of the column, from 1.
        column: usize,
        /// Its header.
        name: String,
        /// What would be right.
        expected: String,
        /// What stands there, in words.
        found: String,
    },
}

/// Reads points block by block.
pub struct PointsReader<'a> {
    rows: &'a mut dyn RowReader,
    /// For each column that is read: its place in the file with what it holds, and the number of its factor.
    wanted: Vec<(usize, ColumnKind)>,
    factors: Vec<usize>,
    skipped: Vec<String>,
    cells: Vec<Vec<f64>>,
    /// Rows read.
    read: u64,
}

impl<'a> PointsReader<'a> {
    /// Checks the columns of `rows` against `space`. Columns of text that are no factors are skipped.
    ///
    /// # Errors
    /// [`PointsError`] if there are no names, or one of them is unknown.
    pub fn new(rows: &'a mut dyn RowReader, space: &Space) -> Result<Self, PointsError> {
        let known = || space.factors().iter().map(|factor| factor.name.as_str());
        let known_text = || known().collect::<Vec<_>>().join(", ");
        let Some(names) = rows.names().map(<[String]>::to_vec) else {
            return Err(PointsError::Unnamed { width: rows.width(), known: known_text() });
        };
        let (mut wanted, mut factors, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
        for (place, name) in names.into_iter().enumerate() {
            if let Some(factor) = known().position(|factor| factor == name) {
                wanted.push((place, factor_column(&space.factors()[factor])));
                factors.push(factor);
            } else if rows.text_columns()?.contains(&place) {
                skipped.push(name);
            } else {
                let (column, nearest) = (place + 1, nearest(&name, known()));
                return Err(PointsError::UnknownColumn { column, name, nearest, known: known_text() });
            }
        }
        let cells = vec![Vec::new(); wanted.len()];
        Ok(Self { rows, wanted, factors, skipped, cells, read: 0 })
    }

    /// The names of the columns of text that are not read.
    pub fn skipped(&self) -> &[String] {
        &self.skipped
    }

    /// Those of the first `factors` factors that have no column.
    pub fn missing(&self, factors: usize) -> Vec<usize> {
        (0..factors).filter(|factor| !self.factors.contains(factor)).collect()
    }

    /// Whether the file, read to its end, lacks the end of its last line.
    pub fn is_unended(&self) -> bool {
        self.rows.is_unended()
    }

    /// Reads up to `rows` points into `columns` (one per factor of the space, in its unit) and returns how many there
    /// were; 0 at the end of the file. A factor without a column stands at its nominal value.
    ///
    /// # Errors
    /// [`PointsError`] with the place of the first cell that is not a finite number.
    pub fn read(&mut self, factors: &[Factor], rows: usize, columns: &mut [Vec<f64>]) -> Result<usize, PointsError> {
        let count = self.rows.read(&self.wanted, rows, &mut self.cells).map_err(|error| match error {
            RowsError::WrongCell { row, line, column, found, .. } => {
                let factor = self.wanted.iter().position(|(place, _)| place + 1 == column).map(|k| self.factors[k]);
                let place = in_words(line, row);
                let found = format!("{found:?}");
                factor.map_or(PointsError::Rows(RowsError::Empty), |k| wrong_cell(&factors[k], place, column, found))
            }
            error => error.into(),
        })?;
        for (column, factor) in columns.iter_mut().zip(factors) {
            column.clear();
            column.resize(count, factor.nominal);
        }
        for ((cells, (place, _)), factor) in self.cells.iter().zip(&self.wanted).zip(&self.factors) {
            if let Some(row) = cells.iter().position(|value| !value.is_finite()) {
                let found = if cells[row].is_nan() { "nothing".to_owned() } else { cells[row].to_string() };
                let at = in_words(self.rows.line(row), self.read + row as u64 + 1);
                return Err(wrong_cell(&factors[*factor], at, place + 1, found));
            }
            columns[*factor].copy_from_slice(cells);
        }
        self.read += count as u64;
        Ok(count)
    }
}

/// Where a cell stands: a line of the file where it has lines, else a row of the table.
pub(super) fn in_words(line: Option<u64>, row: u64) -> String {
    line.map_or_else(|| format!("row {row}"), |line| format!("line {line}"))
}

fn wrong_cell(factor: &Factor, place: String, column: usize, found: String) -> PointsError {
    let name = factor.name.clone();
    let expected = match factor.distribution().labels() {
        Some(labels) => format!("one of {}", labels.join(", ")),
        None => format!("a finite number in {}", factor.unit()),
    };
    PointsError::WrongCell { place, column, name, expected, found }
}
