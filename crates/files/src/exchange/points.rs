//! Points from a table: columns named after factors, values in the factors' units.

use apportion::space::{Factor, Space};
use apportion::study::{did_you_mean, nearest};

use super::design_rows::factor_column;
use super::error::{TableError, place_in_words, refused};
use super::rows::{ColumnKind, RowReader};

/// Reads points block by block.
pub(super) struct PointsReader<'a> {
    pub rows: &'a mut dyn RowReader,
    /// For each column that is read: its position in the file with its content, and the number of its factor.
    wanted: Vec<(usize, ColumnKind)>,
    pub factors: Vec<usize>,
    /// The names of the text columns that are not read.
    pub skipped: Vec<String>,
    cells: Vec<Vec<f64>>,
    /// Number of rows read.
    read: u64,
}

impl<'a> PointsReader<'a> {
    /// Checks the columns of `rows` against `space`. Text columns that are not factors are skipped.
    ///
    /// # Errors
    /// [`TableError`] if there are no names, or one of them is unknown.
    pub fn new(rows: &'a mut dyn RowReader, space: &Space) -> Result<Self, TableError> {
        let known = || space.factors().iter().map(|factor| factor.name.as_str());
        let known_text = || known().collect::<Vec<_>>().join(", ");
        let Some(names) = rows.names().map(<[String]>::to_vec) else {
            return refused(format!(
                "its {} columns have no names: name the factors in their order (--names), out of {}",
                rows.width(),
                known_text()
            ));
        };
        let (mut wanted, mut factors, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
        for (place, name) in names.into_iter().enumerate() {
            if let Some(factor) = known().position(|factor| factor == name) {
                wanted.push((place, factor_column(&space.factors()[factor])));
                factors.push(factor);
            } else if rows.text_columns()?.contains(&place) {
                skipped.push(name);
            } else {
                let (column, hint) = (place + 1, did_you_mean(&nearest(&name, known())));
                return refused(format!(
                    "column {column}: `{name}` is not a factor of the study{hint}; its factors are {}",
                    known_text()
                ));
            }
        }
        let cells = vec![Vec::new(); wanted.len()];
        Ok(Self { rows, wanted, factors, skipped, cells, read: 0 })
    }

    /// Reads up to `rows` points into `columns` (one per factor of the space, in its unit) and returns how many there
    /// were; 0 at the end of the file. A factor without a column is at its nominal value.
    ///
    /// # Errors
    /// [`TableError`] with the place of the first cell that is not a finite number.
    pub fn read(&mut self, factors: &[Factor], rows: usize, columns: &mut [Vec<f64>]) -> Result<usize, TableError> {
        let count = self.rows.read(&self.wanted, rows, &mut self.cells)?;
        for (column, factor) in columns.iter_mut().zip(factors) {
            column.clear();
            column.resize(count, factor.nominal);
        }
        for ((cells, (place, _)), factor) in self.cells.iter().zip(&self.wanted).zip(&self.factors) {
            if let Some(row) = cells.iter().position(|value| !value.is_finite()) {
                let found = if cells[row].is_nan() { "an empty cell".to_owned() } else { cells[row].to_string() };
                let at = place_in_words(self.rows.line(row), self.read + row as u64 + 1);
                let (column, factor) = (place + 1, &factors[*factor]);
                let expected = match factor.distribution().labels() {
                    Some(labels) => format!("one of {}", labels.join(", ")),
                    None => format!("a finite number in {}", factor.unit()),
                };
                let name = &factor.name;
                return refused(format!("{at}: column {column} (`{name}`): expected {expected}, not {found}"));
            }
            columns[*factor].copy_from_slice(cells);
        }
        self.read += count as u64;
        Ok(count)
    }
}
