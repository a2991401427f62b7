//! Tables of numbers by rows, as CSV or NPY, behind one interface.
//!
//! Every cell is a number. A missing value is NaN; a label of a category is its number, by the labels that the caller
//! gives for the column. Readers and writers process blocks of rows, so that a file may be larger than memory.

mod csv_rows;
mod joined;
mod lines;
mod npy;

use apportion::model::OutputSeries;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, Cursor, Read, Seek, Write};
use std::path::Path;

use apportion_base::files::read_opened;
use apportion_base::names::{named, refused_name};
use flate2::read::MultiGzDecoder;

use super::error::{TableError, refused};

pub use joined::Joined;

named! {
    /// The format of a table, chosen by the extension of its file.
    pub enum Format {
        /// Text: a header of names, then one line per row.
        Csv = "csv",
        /// NumPy's array file: numbers in rows and columns, without names.
        Npy = "npy",
    }
}

impl Format {
    /// Returns the format of the extension of `path` in any case.
    ///
    /// ```
    /// use apportion_files::exchange::Format;
    ///
    /// assert_eq!(Format::from_path("runs/design.CSV".as_ref())?, Format::Csv);
    /// assert!(Format::from_path("design.xlsx".as_ref()).is_err());
    /// # Ok::<(), apportion_files::exchange::TableError>(())
    /// ```
    ///
    /// # Errors
    /// [`TableError`] for any other.
    pub fn from_path(path: &Path) -> Result<Self, TableError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        if let Some(format) = Self::ALL.into_iter().find(|format| ending.as_deref() == Some(format.name())) {
            return Ok(format);
        }
        let ending = ending.map_or_else(String::new, |ending| format!(", not .{ending}"));
        refused(format!("the ending of the name gives the format: expected .csv or .npy{ending}"))
    }
}

/// Options for a table, which its file does not contain.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Names of the columns of a table without names.
    pub names: Vec<String>,
    /// Whether the first line of a text is a row, even if it does not look like one.
    pub no_header: bool,
    /// Numbers that mean a missing value.
    pub missing: Vec<f64>,
}

/// A column to be written or read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnKind {
    /// Its name.
    pub name: String,
    /// The labels of a column of categories, each with its number; empty for a column of numbers.
    pub labels: Vec<(String, f64)>,
    /// Whether all values are whole numbers, which are written in text without a decimal point.
    pub whole: bool,
}

impl ColumnKind {
    /// Creates a column of numbers.
    pub fn numbers(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    pub(crate) fn label(&self, value: f64) -> Option<&str> {
        self.labels.iter().find(|(_, number)| *number == value).map(|(label, _)| label.as_str())
    }

    fn value_of(&self, text: &str) -> Option<f64> {
        let label = self.labels.iter().find(|(label, _)| {
            // Python and spreadsheets write the labels of a boolean in capitals.
            label == text || matches!(&label[..], "true" | "false") && label.eq_ignore_ascii_case(text)
        });
        label.map(|(_, value)| *value)
    }

    /// Returns the number in a cell of text: of a label, or of its number; for a column of numbers any number,
    /// infinities too, and 1 and 0 for `true` and `false`, `yes` and `no`, `valid` and `invalid`. `None` if it is neither; NaN
    /// if the value is missing.
    fn value(&self, cell: &str) -> Option<f64> {
        const MISSING: [&str; 9] = ["", "nan", "-nan", "na", "n/a", "null", "none", "-", "."];
        if let Some(value) = self.value_of(cell) {
            return Some(value);
        }
        if MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) || is_error_word(cell) || is_printed_nan(cell) {
            return Some(f64::NAN);
        }
        if !self.labels.is_empty() {
            return number(cell).filter(|value| self.label(*value).is_some());
        }
        number(cell).or_else(|| match &*cell.to_ascii_lowercase() {
            "true" | "yes" | "valid" => Some(1.0),
            "false" | "no" | "invalid" => Some(0.0),
            _ => None,
        })
    }

    fn expected(&self) -> String {
        if self.labels.is_empty() {
            return "a number".to_owned();
        }
        let labels: Vec<&str> = self.labels.iter().map(|(label, _)| label.as_str()).collect();
        format!("one of {}", labels.join(", "))
    }
}

/// Parses a number as programs print it, including Fortran's `D` before the exponent.
pub(crate) fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().or_else(|| {
        let is_plain = cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.dD".contains(&byte));
        if is_plain { cell.replace(['d', 'D'], "e").parse().ok() } else { None }
    })
}

/// Returns whether the cell holds an error of a spreadsheet, such as `#N/A` and `#DIV/0!`.
fn is_error_word(cell: &str) -> bool {
    const WORDS: [&str; 7] = ["#N/A", "#DIV/0!", "#VALUE!", "#REF!", "#NUM!", "#NAME?", "#NULL!"];
    WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Returns whether a program of C, Fortran or Windows prints no number like this: `1.#QNAN`, `-1.#IND`, `nan(ind)`, `NaNQ`.
fn is_printed_nan(cell: &str) -> bool {
    let cell = cell.trim_start_matches(['+', '-']).to_ascii_lowercase();
    cell.starts_with("1.#") || cell.starts_with("nan(") || ["nanq", "nans", "nan0"].contains(&&*cell)
}

/// Reads a table block by block.
pub trait RowReader {
    /// Returns the names of all columns, in order; `None` for a format without names.
    fn names(&self) -> Option<&[String]>;

    /// Returns the number of all columns.
    fn width(&self) -> usize;

    /// Returns the columns that hold text, by their first values, each with a cell that is not a number.
    ///
    /// # Errors
    /// [`TableError`] if the file cannot be read.
    fn text_columns(&mut self) -> Result<Vec<(usize, String)>, TableError> {
        Ok(Vec::new())
    }

    /// Returns the line of the file, from 1, on which row number `row` of the last block ends; `None` without lines.
    fn line(&self, _row: usize) -> Option<u64> {
        None
    }

    /// Returns whether the file, read to its end, is a text whose last line has no end: it may have been cut short,
    /// even in a number.
    fn is_unended(&self) -> bool {
        false
    }

    /// Reads at most `rows` rows of some columns into `to`, one vector for each of `wanted` (number of the column
    /// below [`width`](Self::width), its content; the same ones in every call), and returns how many there were; 0 at
    /// the end.
    ///
    /// # Errors
    /// [`TableError`] with the place of the first error.
    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, to: &mut [Vec<f64>]) -> Result<usize, TableError>;
}

/// Opens the table in `path`, in the format of its first bytes, not of its name: NPY, or text as CSV, which may be
/// compressed by gzip. Text is read in constant memory, from a pipe too.
///
/// # Errors
/// [`TableError`] if the file cannot be read or is of another format, or names do not match.
pub fn open_table(path: &Path, options: &ReadOptions) -> Result<Box<dyn RowReader>, TableError> {
    let mut file = File::open(path)?;
    let about = file.metadata()?;
    let mut begin = Vec::new();
    (&mut file).take(8).read_to_end(&mut begin)?;
    if !begin.starts_with(npy::MAGIC) {
        return text(&begin.clone(), Box::new(Cursor::new(begin).chain(file)), options);
    }
    if about.is_file() {
        file.rewind()?;
        return Ok(Box::new(npy::NpyRows::new(file, options)?));
    }
    begin.extend(read_opened(&mut file)?);
    table_of_bytes(begin, options)
}

/// Opens the table in `bytes` like [`open_table`].
///
/// # Errors
/// As for [`open_table`].
pub fn table_of_bytes(bytes: Vec<u8>, options: &ReadOptions) -> Result<Box<dyn RowReader>, TableError> {
    if bytes.starts_with(npy::MAGIC) {
        return Ok(Box::new(npy::NpyRows::new(Cursor::new(bytes), options)?));
    }
    let begin: Vec<u8> = bytes.iter().take(8).copied().collect();
    text(&begin, Box::new(Cursor::new(bytes)), options)
}

/// Opens the table in a text with this beginning.
fn text(begin: &[u8], all: Box<dyn Read>, options: &ReadOptions) -> Result<Box<dyn RowReader>, TableError> {
    let all: Box<dyn Read> = match begin {
        [b'P', b'A', b'R', b'1', ..] => {
            return refused(
                "it is a Parquet file: write it as CSV, in Python with `pandas.read_parquet(\"FILE.parquet\").to_csv(\"FILE.csv\", \
                 index=False)`",
            );
        }
        [b'P', b'K', 3 | 5, 4 | 6, ..] | [0xd0, 0xcf, 0x11, 0xe0, ..] => {
            return refused("it is a workbook or an archive (.xlsx, .xls, .ods, .zip, .npz): save the table as CSV");
        }
        [b'M', b'A', b'T', b'L', b'A', b'B', ..] => {
            return refused("it is a file of MATLAB: save the table as CSV (`writematrix`)");
        }
        [0x1f, 0x8b, ..] => Box::new(MultiGzDecoder::new(all)),
        _ => all,
    };
    Ok(Box::new(csv_rows::CsvRows::new(all, options)?))
}

/// A table that is written row by row.
pub struct RowWriter<'a> {
    format: Format,
    out: BufWriter<&'a mut dyn Write>,
    columns: Vec<ColumnKind>,
}

impl<'a> RowWriter<'a> {
    /// Begins a table with these columns. NPY has the number of rows in its header.
    ///
    /// # Errors
    /// Any error of the file system.
    pub fn new(format: Format, out: &'a mut dyn Write, columns: Vec<ColumnKind>, rows: u64) -> std::io::Result<Self> {
        let mut out = BufWriter::new(out);
        match format {
            Format::Csv => csv_rows::write_header(&mut out, &columns)?,
            Format::Npy => npy::write_header(&mut out, rows, columns.len())?,
        }
        Ok(Self { format, out, columns })
    }

    /// Writes rows: one slice for each column, all of one length.
    ///
    /// # Errors
    /// Any error of the file system.
    pub fn write(&mut self, columns: &[&[f64]]) -> std::io::Result<()> {
        for row in 0..columns.first().map_or(0, |column| column.len()) {
            let values = columns.iter().map(|column| column[row]);
            match self.format {
                Format::Csv => csv_rows::write_row(&mut self.out, values.zip(&self.columns))?,
                Format::Npy => values.into_iter().try_for_each(|value| self.out.write_all(&value.to_le_bytes()))?,
            }
        }
        Ok(())
    }

    /// Writes the remaining data.
    ///
    /// # Errors
    /// Any error of the file system.
    pub fn finish(mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

/// Expands the names of columns: `y[0..3]` means the columns `y[0]`, `y[1]` and `y[2]`.
fn expanded(names: &[String]) -> Vec<String> {
    let mut all = Vec::new();
    for name in names {
        match OutputSeries::items_of_header(name) {
            Some(items) => all.extend(items),
            None => all.push(name.clone()),
        }
    }
    all
}

/// Returns the names of `width` columns, [expanded], if there are any.
fn names_of_columns(names: &[String], width: usize) -> Result<Option<Vec<String>>, TableError> {
    let names = expanded(names);
    if names.is_empty() {
        return Ok(None);
    }
    if names.len() != width {
        return refused(format!("{} names are given, but it has {width} columns", names.len()));
    }
    check_names(&names)?;
    Ok(Some(names))
}

/// Checks that no name is empty or repeated.
fn check_names(names: &[String]) -> Result<(), TableError> {
    if names.iter().all(String::is_empty) {
        return refused("the file is empty: expected a header of column names, then one line per row");
    }
    let mut places = BTreeMap::new();
    for (place, name) in names.iter().enumerate() {
        let column = place + 1;
        if name.is_empty() {
            return refused(format!("column {column} has no name"));
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
