//! Points from a CSV file: a header of factor names, then values in the factors' units.

use std::io::Read;

use thiserror::Error;

use crate::space::{Factor, Space};
use crate::study::nearest;

/// What is wrong with a file of points.
#[derive(Debug, Error)]
pub enum PointsError {
    /// There is not even a header.
    #[error("line 1: the file is empty: expected a header of factor names ({known})")]
    Empty {
        /// The factors of the study.
        known: String,
    },
    /// A column that is no factor.
    #[error("line 1: column {column}: `{name}` is no factor of the study{}; its factors are {known}", hint(.nearest))]
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
    /// The same factor twice.
    #[error("line 1: column {column}: `{name}` stands here twice")]
    RepeatedColumn {
        /// Number of the column, from 1.
        column: usize,
        /// Its header.
        name: String,
    },
    /// A cell that is not a finite number.
    #[error("line {line}: column {column} (`{name}`): expected a finite number in {unit}, not {found:?}")]
    NotANumber {
        /// Line of the file, from 1.
        line: u64,
        /// Number of the column, from 1.
        column: usize,
        /// Its header.
        name: String,
        /// The unit the number would be in.
        unit: String,
        /// The cell.
        found: String,
    },
    /// A cell that is no category of its factor.
    #[error("line {line}: column {column} (`{name}`): expected one of {known}, not {found:?}")]
    NoCategory {
        /// Line of the file, from 1.
        line: u64,
        /// Number of the column, from 1.
        column: usize,
        /// Its header.
        name: String,
        /// The labels of the factor.
        known: String,
        /// The cell.
        found: String,
    },
    /// A line with too many or too few cells.
    #[error("line {line}: expected {expected} cells as in the header, not {found}")]
    WrongLength {
        /// Line of the file, from 1.
        line: u64,
        /// Cells in the header.
        expected: u64,
        /// Cells in this line.
        found: u64,
    },
    /// The file cannot be read, or is not text in UTF-8.
    #[error("{0}")]
    Unreadable(csv::Error),
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

/// Most bytes of a line of CSV.
const LONGEST_LINE: usize = 16 << 20;

/// A text with `\n` for every end of line, also after the last one: what it takes for the reader of CSV to know which
/// line it has come to.
/// A line may have [`LONGEST_LINE`] bytes, so that a file without ends of lines takes no memory without end.
pub(super) struct PlainLines<R: Read> {
    bytes: std::iter::Peekable<std::io::Bytes<std::io::BufReader<R>>>,
    last: u8,
    /// Bytes of the line so far.
    length: usize,
}

impl<R: Read> PlainLines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { bytes: std::io::BufReader::new(reader).bytes().peekable(), last: b'\n', length: 0 }
    }

    fn next(&mut self) -> Option<std::io::Result<u8>> {
        match self.bytes.next() {
            Some(Ok(b'\r')) if matches!(self.bytes.peek(), Some(Ok(b'\n'))) => self.bytes.next(),
            None if self.last != b'\n' => Some(Ok(b'\n')),
            next => next,
        }
    }
}

impl<R: Read> Read for PlainLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        for (filled, slot) in buffer.iter_mut().enumerate() {
            match self.next() {
                Some(byte) => {
                    *slot = byte?;
                    self.last = *slot;
                    self.length = if *slot == b'\n' { 0 } else { self.length + 1 };
                    if self.length > LONGEST_LINE {
                        let message = format!("a line of more than {} MiB", LONGEST_LINE >> 20);
                        return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, message));
                    }
                }
                None => return Ok(filled),
            }
        }
        Ok(buffer.len())
    }
}

/// Reads points block by block.
pub struct PointsReader<R: Read> {
    csv: csv::Reader<PlainLines<R>>,
    /// For each column of the file: the number of its factor.
    columns: Vec<usize>,
    record: csv::StringRecord,
}

impl<R: Read> PointsReader<R> {
    /// Reads the header and checks it against `space`. A byte-order mark and spaces around names are ignored.
    ///
    /// # Errors
    /// [`PointsError`] if there is no header, or a name in it is unknown or repeated.
    pub fn new(reader: R, space: &Space) -> Result<Self, PointsError> {
        let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(PlainLines::new(reader));
        let known = || space.factors().iter().map(|factor| factor.name.as_str());
        let known_text = || known().collect::<Vec<_>>().join(", ");
        let header = csv.headers().map_err(PointsError::Unreadable)?.clone();
        if header.is_empty() || header.iter().all(str::is_empty) {
            return Err(PointsError::Empty { known: known_text() });
        }
        let mut columns = Vec::with_capacity(header.len());
        for (number, name) in header.iter().enumerate() {
            let (column, name) = (number + 1, name.trim_start_matches('\u{feff}').to_owned());
            let Some(factor) = known().position(|factor| factor == name) else {
                let nearest = nearest(&name, known());
                return Err(PointsError::UnknownColumn { column, name, nearest, known: known_text() });
            };
            if columns.contains(&factor) {
                return Err(PointsError::RepeatedColumn { column, name });
            }
            columns.push(factor);
        }
        Ok(Self { csv, columns, record: csv::StringRecord::new() })
    }

    /// Reads up to `rows` points into `columns` (one per factor of the space, in its unit) and returns how many there
    /// were; 0 at the end of the file. A factor without a column stands at its nominal value.
    ///
    /// # Errors
    /// [`PointsError`] with the line of the first cell that is not a finite number.
    pub fn read(&mut self, factors: &[Factor], rows: usize, columns: &mut [Vec<f64>]) -> Result<usize, PointsError> {
        columns.iter_mut().for_each(Vec::clear);
        for row in 0..rows {
            let read = self.csv.read_record(&mut self.record);
            // The reader stands at the start of the next line.
            let line = self.csv.position().line() - 1;
            if !read.map_err(|error| wrong_record(error, line))? {
                return Ok(row);
            }
            for (column, factor) in columns.iter_mut().zip(factors) {
                column.push(factor.nominal);
            }
            for (number, (cell, &factor)) in self.record.iter().zip(&self.columns).enumerate() {
                columns[factor][row] = value_of(&factors[factor], cell).ok_or_else(|| {
                    let (column, name, found) = (number + 1, factors[factor].name.clone(), cell.to_owned());
                    match factors[factor].distribution().labels() {
                        Some(labels) => PointsError::NoCategory { line, column, name, known: labels.join(", "), found },
                        None => {
                            let unit = factors[factor].unit().to_string();
                            PointsError::NotANumber { line, column, name, unit, found }
                        }
                    }
                })?;
            }
        }
        Ok(rows)
    }
}

/// The finite number in `cell`; of a factor of categories, the number of the label there, or the number of a label.
fn value_of(factor: &Factor, cell: &str) -> Option<f64> {
    let law = factor.distribution();
    let number = || cell.parse().ok().filter(|value: &f64| value.is_finite());
    match law.labels() {
        Some(_) => law.value_of(cell).or_else(|| number().filter(|value| law.label(*value).is_some())),
        None => number(),
    }
}

fn wrong_record(error: csv::Error, line: u64) -> PointsError {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            PointsError::WrongLength { line, expected: *expected_len, found: *len }
        }
        _ => PointsError::Unreadable(error),
    }
}
