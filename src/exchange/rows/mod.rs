//! Tables of numbers by rows, in three formats behind one interface: CSV, Parquet and NPY.
//!
//! Every cell is a number. A value that is missing is NaN; a label of a category is the number that stands for it, by
//! the labels that the caller knows of the column. Readers and writers take blocks of rows, so that a file may be
//! larger than memory.

mod csv_rows;
mod error;
mod npy;
#[cfg(feature = "parquet")]
mod parquet_pages;
#[cfg(feature = "parquet")]
mod parquet_rows;
mod plain_lines;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Cursor, Read, Seek, Write};
use std::path::Path;

pub use error::RowsError;

use crate::files::read_opened;
use crate::model::items_of_header;
use crate::names::refused_name;

/// How a table is written down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Text: a header of names, then one line per row.
    Csv,
    /// Apache Parquet: columns by name.
    Parquet,
    /// NumPy's array file: numbers in rows and columns, without names.
    Npy,
}

impl Format {
    /// All formats, each known by the ending of a file's name.
    pub const ALL: [Self; 3] = [Self::Csv, Self::Parquet, Self::Npy];

    /// The ending of file names, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
            Self::Npy => "npy",
        }
    }

    /// The format that the ending of `path` says, in capitals or not.
    ///
    /// ```
    /// use apportion::exchange::Format;
    ///
    /// assert_eq!(Format::of("runs/design.CSV".as_ref())?, Format::Csv);
    /// assert!(Format::of("design.xlsx".as_ref()).is_err());
    /// # Ok::<(), apportion::exchange::RowsError>(())
    /// ```
    ///
    /// # Errors
    /// [`RowsError::UnknownEnding`] for any other.
    pub fn of(path: &Path) -> Result<Self, RowsError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let known = |format: &Self| ending.as_deref() == Some(format.ending());
        Self::ALL.into_iter().find(known).ok_or_else(|| RowsError::UnknownEnding { path: path.to_owned() })
    }

    /// The format of a file that begins with these bytes: that of text, if it is no other.
    fn of_beginning(bytes: &[u8]) -> Self {
        match bytes {
            [b'P', b'A', b'R', b'1', ..] => Self::Parquet,
            [b'\x93', b'N', b'U', b'M', b'P', b'Y', ..] => Self::Npy,
            _ => Self::Csv,
        }
    }
}

/// A column to be written or read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnKind {
    /// Its name.
    pub name: String,
    /// The labels of a column of categories, each with the number that stands for it; none for a column of numbers.
    pub labels: Vec<(String, f64)>,
    /// Whether values may be missing (NaN).
    pub optional: bool,
    /// Whether all values are whole numbers, which text has without a decimal point.
    pub whole: bool,
}

impl ColumnKind {
    /// A column of numbers, none of which is missing.
    pub fn numbers(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    fn label(&self, value: f64) -> Option<&str> {
        self.labels.iter().find(|(_, number)| *number == value).map(|(label, _)| label.as_str())
    }

    fn value_of(&self, label: &str) -> Option<f64> {
        self.labels.iter().find(|(known, _)| known == label).map(|(_, value)| *value)
    }

    /// The number in a cell of text: that of a label, or of a label's number; of a column of numbers any number,
    /// infinities too. `None` if it is neither; NaN if the value is missing.
    fn value(&self, cell: &str) -> Option<f64> {
        const MISSING: [&str; 8] = ["", "nan", "-nan", "na", "n/a", "null", "none", "-"];
        if let Some(value) = self.value_of(cell) {
            return Some(value);
        }
        if MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) {
            return Some(f64::NAN);
        }
        cell.parse().ok().filter(|value| self.labels.is_empty() || self.label(*value).is_some())
    }

    fn expected(&self) -> String {
        if self.labels.is_empty() {
            return "a number".to_owned();
        }
        let labels: Vec<&str> = self.labels.iter().map(|(label, _)| label.as_str()).collect();
        format!("one of {}", labels.join(", "))
    }
}

/// Reads a table block by block.
pub trait RowReader {
    /// Names of all columns, in order; `None` for a format without names.
    fn names(&self) -> Option<&[String]>;

    /// Number of all columns.
    fn width(&self) -> usize;

    /// The columns that hold text, by their type, or by the first values in them.
    ///
    /// # Errors
    /// [`RowsError`] if the file cannot be read.
    fn text_columns(&mut self) -> Result<Vec<usize>, RowsError> {
        Ok(Vec::new())
    }

    /// The first cell of a column of text that is no number, where the cells were looked at to tell.
    fn text_example(&self, _place: usize) -> Option<String> {
        None
    }

    /// The line of the file, from 1, on which row number `row` of the last block ends; `None` in a format without lines.
    fn line(&self, _row: usize) -> Option<u64> {
        None
    }

    /// Whether the file, read to its end, is a text whose last line has no end: it may have been cut short, within a number
    /// too.
    fn is_unended(&self) -> bool {
        false
    }

    /// Reads the next rows, at most `rows`, of some columns into `into`, one vector for each of `wanted` (number of the
    /// column below [`width`](Self::width), what it holds; the
    /// same ones in every call), and returns how many there were; 0 at the end.
    ///
    /// # Errors
    /// [`RowsError`] with the place of the first fault.
    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError>;
}

/// Opens the table in `path`, in the format that its ending says.
///
/// # Errors
/// [`RowsError`] if the ending is unknown, or the file cannot be read or is not of that format.
pub fn open_rows(path: &Path) -> Result<Box<dyn RowReader>, RowsError> {
    let format = Format::of(path)?;
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory).into());
    }
    Ok(match format {
        Format::Csv => Box::new(csv_rows::CsvRows::new(file, &[])?),
        Format::Parquet => parquet_reader(file)?,
        Format::Npy => Box::new(npy::NpyRows::new(file)?),
    })
}

/// Opens the table in `path`, whatever its name, in the format that its first bytes say. `names` are those of its columns,
/// if it has none itself; a text is then one without a header.
///
/// # Errors
/// [`RowsError`] if the file cannot be read or is not of that format, or names do not fit.
pub fn open_table(path: &Path, names: &[String]) -> Result<Box<dyn RowReader>, RowsError> {
    let mut file = File::open(path)?;
    let about = file.metadata()?;
    if about.is_dir() {
        return Err(std::io::Error::from(std::io::ErrorKind::IsADirectory).into());
    }
    let mut begin = Vec::new();
    (&mut file).take(8).read_to_end(&mut begin)?;
    match Format::of_beginning(&begin) {
        // In constant memory, from a pipe too.
        Format::Csv => Ok(Box::new(csv_rows::CsvRows::new(Cursor::new(begin).chain(file), names)?)),
        Format::Npy if about.is_file() => {
            file.rewind()?;
            named(Box::new(npy::NpyRows::new(file)?), names)
        }
        Format::Parquet if about.is_file() => {
            file.rewind()?;
            named(parquet_reader(file)?, names)
        }
        _ => {
            begin.extend(read_opened(&mut file)?);
            table_of_bytes(begin, names)
        }
    }
}

/// The table in `bytes`, as [`open_table`] reads it.
///
/// # Errors
/// As for [`open_table`].
pub fn table_of_bytes(bytes: Vec<u8>, names: &[String]) -> Result<Box<dyn RowReader>, RowsError> {
    match Format::of_beginning(&bytes) {
        Format::Csv => Ok(Box::new(csv_rows::CsvRows::new(Cursor::new(bytes), names)?)),
        format => named(rows_of_bytes(format, bytes)?, names),
    }
}

/// The table in `bytes`.
///
/// # Errors
/// [`RowsError`] if they are not of that format.
pub fn rows_of_bytes(format: Format, bytes: Vec<u8>) -> Result<Box<dyn RowReader>, RowsError> {
    Ok(match format {
        Format::Csv => Box::new(csv_rows::CsvRows::new(Cursor::new(bytes), &[])?),
        Format::Parquet => parquet_of_bytes(bytes)?,
        Format::Npy => Box::new(npy::NpyRows::new(Cursor::new(bytes))?),
    })
}

#[cfg(feature = "parquet")]
fn parquet_reader(file: File) -> Result<Box<dyn RowReader>, RowsError> {
    Ok(Box::new(parquet_rows::ParquetRows::new(file)?))
}

#[cfg(feature = "parquet")]
fn parquet_of_bytes(bytes: Vec<u8>) -> Result<Box<dyn RowReader>, RowsError> {
    Ok(Box::new(parquet_rows::ParquetRows::new(bytes::Bytes::from(bytes))?))
}

#[cfg(not(feature = "parquet"))]
fn parquet_reader(_file: File) -> Result<Box<dyn RowReader>, RowsError> {
    Err(RowsError::WithoutParquet)
}

#[cfg(not(feature = "parquet"))]
fn parquet_of_bytes(_bytes: Vec<u8>) -> Result<Box<dyn RowReader>, RowsError> {
    Err(RowsError::WithoutParquet)
}

/// `rows` with names given for its columns.
fn named(rows: Box<dyn RowReader>, names: &[String]) -> Result<Box<dyn RowReader>, RowsError> {
    if names.is_empty() {
        return Ok(rows);
    }
    if let Some(known) = rows.names() {
        return Err(RowsError::HasNames { known: known.join(", ") });
    }
    let names = expanded(names.iter().cloned());
    if rows.width() != names.len() {
        return Err(RowsError::OtherWidth { width: rows.width(), names: names.len() });
    }
    check_names(&names)?;
    Ok(Box::new(Named { rows, names }))
}

/// A table of a format without names, with names from elsewhere.
struct Named {
    rows: Box<dyn RowReader>,
    names: Vec<String>,
}

impl RowReader for Named {
    fn names(&self) -> Option<&[String]> {
        Some(&self.names)
    }

    fn width(&self) -> usize {
        self.rows.width()
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError> {
        self.rows.read(wanted, rows, into)
    }
}

/// Writes a table block by block.
pub trait RowWriter {
    /// Writes rows: one slice for each column, all of one length.
    ///
    /// # Errors
    /// Whatever the file's system says.
    fn write(&mut self, columns: &[&[f64]]) -> std::io::Result<()>;

    /// Writes what is left to be written.
    ///
    /// # Errors
    /// Whatever the file's system says; or if the rows are not as many as were announced.
    fn finish(self: Box<Self>) -> std::io::Result<()>;
}

/// A writer of `rows` rows of these columns to `out`. Numbers come back from reading as the same bits.
///
/// Labels are written as text in CSV and Parquet, as their numbers in NPY; a missing value is an empty cell, a null, or
/// NaN.
///
/// # Errors
/// Whatever the file's system says.
pub fn row_writer<'a>(
    format: Format,
    out: &'a mut (dyn Write + Send),
    columns: Vec<ColumnKind>,
    rows: u64,
) -> std::io::Result<Box<dyn RowWriter + 'a>> {
    Ok(match format {
        Format::Csv => Box::new(csv_rows::CsvWriter::new(out, columns)?),
        #[cfg(feature = "parquet")]
        Format::Parquet => Box::new(parquet_rows::ParquetWriter::new(out, columns)?),
        #[cfg(not(feature = "parquet"))]
        Format::Parquet => return Err(std::io::Error::other(RowsError::WithoutParquet)),
        Format::Npy => Box::new(npy::NpyWriter::new(out, (rows, columns.len()))?),
    })
}

/// Names of all columns: `y[0..3]` stands for the columns `y[0]`, `y[1]` and `y[2]`.
fn expanded(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut all = Vec::new();
    for name in names {
        match items_of_header(&name) {
            Some(items) => all.extend(items),
            None => all.push(name),
        }
    }
    all
}

/// Names that are all there and all different.
fn check_names(names: &[String]) -> Result<(), RowsError> {
    if names.iter().all(String::is_empty) {
        return Err(RowsError::Empty);
    }
    let mut places = BTreeMap::new();
    for (place, name) in names.iter().enumerate() {
        let column = place + 1;
        if name.is_empty() {
            return Err(RowsError::Nameless { column });
        }
        if let Some(expected) = refused_name(name) {
            return Err(RowsError::WrongName { column, expected });
        }
        if let Some(first) = places.insert(name, place) {
            return Err(RowsError::RepeatedColumn { column, name: name.clone(), first: first + 1 });
        }
    }
    Ok(())
}
