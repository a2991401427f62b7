//! Tables of numbers by rows, as CSV.
//!
//! Every cell is a number. A value that is missing is NaN; a label of a category is the number that stands for it, by
//! the labels that the caller knows of the column. Readers and writers take blocks of rows, so that a file may be
//! larger than memory.

mod csv_rows;
mod lines;
#[cfg(test)]
mod tests;

pub use csv_rows::{RowReader, RowWriter};

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::error::{TableError, refused};
use crate::model::items_of_header;
use crate::names::refused_name;

/// Refuses a name for a table to be written that has another ending than `.csv`, in capitals or not.
///
/// ```
/// use apportion::exchange::check_ending;
///
/// assert!(check_ending("runs/design.CSV".as_ref()).is_ok());
/// assert!(check_ending("design.xlsx".as_ref()).is_err());
/// ```
///
/// # Errors
/// [`TableError`], with what makes a file of another format of one of CSV.
pub fn check_ending(path: &Path) -> Result<(), TableError> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let others = match ending.as_deref() {
        Some("csv") => return Ok(()),
        Some("npy") => ": `numpy.loadtxt(\"FILE.csv\", delimiter=\",\", skiprows=1)` reads CSV as an array",
        Some("parquet") => {
            ": `pandas.read_csv(\"FILE.csv\").to_parquet(\"FILE.parquet\")` makes a Parquet file of one of CSV"
        }
        _ => "",
    };
    let found = ending.map_or_else(String::new, |ending| format!(", not .{ending}"));
    refused(format!("tables are written as CSV: expected the ending .csv{found}{others}"))
}

/// What the file of a table does not say itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Names of the columns of a table that has none.
    pub names: Vec<String>,
    /// Whether the first line of a text is a row, even if it does not look like one.
    pub no_header: bool,
    /// Numbers that stand for a missing value.
    pub missing: Vec<f64>,
}

/// A column to be written or read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnKind {
    /// Its name.
    pub name: String,
    /// The labels of a column of categories, each with the number that stands for it; none for a column of numbers.
    pub labels: Vec<(String, f64)>,
    /// Whether all values are whole numbers, which text has without a decimal point.
    pub whole: bool,
}

impl ColumnKind {
    /// A column of numbers.
    pub fn numbers(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    fn label(&self, value: f64) -> Option<&str> {
        self.labels.iter().find(|(_, number)| *number == value).map(|(label, _)| label.as_str())
    }

    fn value_of(&self, label: &str) -> Option<f64> {
        // Python and spreadsheets write the labels of a boolean in capitals.
        let is_it =
            |known: &str| known == label || matches!(known, "true" | "false") && known.eq_ignore_ascii_case(label);
        self.labels.iter().find(|(known, _)| is_it(known)).map(|(_, value)| *value)
    }

    /// The number in a cell of text: that of a label, or of a label's number; of a column of numbers any number,
    /// infinities too, and 1 and 0 for `true` and `false`. `None` if it is neither; NaN if the value is missing.
    fn value(&self, cell: &str) -> Option<f64> {
        const MISSING: [&str; 9] = ["", "nan", "-nan", "na", "n/a", "null", "none", "-", "."];
        if let Some(value) = self.value_of(cell) {
            return Some(value);
        }
        if MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) || is_error_word(cell) {
            return Some(f64::NAN);
        }
        match cell {
            "true" | "True" | "TRUE" if self.labels.is_empty() => Some(1.0),
            "false" | "False" | "FALSE" if self.labels.is_empty() => Some(0.0),
            cell => number(cell).filter(|value| self.labels.is_empty() || self.label(*value).is_some()),
        }
    }

    fn expected(&self) -> String {
        if self.labels.is_empty() {
            return "a number".to_owned();
        }
        let labels: Vec<&str> = self.labels.iter().map(|(label, _)| label.as_str()).collect();
        format!("one of {}", labels.join(", "))
    }
}

/// A number as programs print it, that of Fortran with `D` before the exponent too.
fn number(cell: &str) -> Option<f64> {
    let of_fortran = || {
        let is_plain = cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.dD".contains(&byte));
        if is_plain { cell.replace(['d', 'D'], "e").parse().ok() } else { None }
    };
    cell.parse().ok().or_else(of_fortran)
}

/// Whether a spreadsheet has written that the cell has no value, as `#N/A` and `#DIV/0!` say.
fn is_error_word(cell: &str) -> bool {
    const WORDS: [&str; 7] = ["#N/A", "#DIV/0!", "#VALUE!", "#REF!", "#NUM!", "#NAME?", "#NULL!"];
    WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Opens the table in `path`, CSV whatever its name, which may be compressed by gzip. Text is read in constant memory, from a
/// pipe too.
///
/// # Errors
/// [`TableError`] if the file cannot be read or is of another format, or names do not fit.
pub fn open_table(path: &Path, options: &ReadOptions) -> Result<RowReader, TableError> {
    let file = File::open(path)?;
    match file.metadata()?.is_dir() {
        true => Err(std::io::Error::from(std::io::ErrorKind::IsADirectory).into()),
        false => table_of(Box::new(file), options),
    }
}

/// The table in `bytes`, as [`open_table`] reads it.
///
/// # Errors
/// As for [`open_table`].
pub fn table_of_bytes(bytes: Vec<u8>, options: &ReadOptions) -> Result<RowReader, TableError> {
    table_of(Box::new(Cursor::new(bytes)), options)
}

fn table_of(mut all: Box<dyn Read>, options: &ReadOptions) -> Result<RowReader, TableError> {
    let mut begin = Vec::new();
    (&mut all).take(8).read_to_end(&mut begin)?;
    let is_compressed = begin.starts_with(b"\x1f\x8b");
    match begin[..] {
        [b'P', b'A', b'R', b'1', ..] => {
            return refused(
                "it is a Parquet file: write it as CSV, in Python with `pandas.read_parquet(\"FILE.parquet\").to_csv(\"FILE.csv\", \
                 index=False)`",
            );
        }
        [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => {
            return refused(
                "it is an NPY file: write it as CSV, in Python with `numpy.savetxt(\"FILE.csv\", numpy.load(\"FILE.npy\"), \
                 delimiter=\",\")`",
            );
        }
        [b'P', b'K', 3 | 5, 4 | 6, ..] | [0xd0, 0xcf, 0x11, 0xe0, ..] => {
            return refused("it is a workbook or an archive (.xlsx, .xls, .ods, .zip, .npz): save the table as CSV");
        }
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => return refused("it is text in UTF-16: save it as UTF-8"),
        _ => (),
    }
    let all: Box<dyn Read> = Box::new(Cursor::new(begin).chain(all));
    RowReader::new(if is_compressed { Box::new(MultiGzDecoder::new(all)) } else { all }, options)
}

/// Names of all columns: `y[0..3]` stands for the columns `y[0]`, `y[1]` and `y[2]`.
fn expanded(names: &[String]) -> Vec<String> {
    let mut all = Vec::new();
    for name in names {
        match items_of_header(name) {
            Some(items) => all.extend(items),
            None => all.push(name.clone()),
        }
    }
    all
}

/// The names of `width` columns, if there are any.
fn names_of_columns(names: Vec<String>, width: usize) -> Result<Option<Vec<String>>, TableError> {
    if names.is_empty() {
        return Ok(None);
    }
    if names.len() != width {
        return refused(format!("{} names are given, but it has {width} columns", names.len()));
    }
    check_names(&names)?;
    Ok(Some(names))
}

/// Names that are all there and all different.
fn check_names(names: &[String]) -> Result<(), TableError> {
    if names.iter().all(String::is_empty) {
        return refused("the file is empty: expected a header of column names, then one line per row");
    }
    let mut places = BTreeMap::new();
    for (place, name) in names.iter().enumerate() {
        let column = place + 1;
        if name.is_empty() {
            let index = "if it is the index that pandas writes, leave it out (index=False)";
            let advice = if column == 1 { format!(": {index}") } else { String::new() };
            return refused(format!("column {column} has no name{advice}"));
        }
        if let Some(expected) = refused_name(name) {
            return refused(format!("the name of column {column}: expected {expected}"));
        }
        if let Some(first) = places.insert(name, place) {
            return refused(format!("column {column}: `{name}` is also the name of column {}", first + 1));
        }
    }
    Ok(())
}
