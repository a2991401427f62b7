//! What is wrong with a file of rows.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// What is wrong with a file of rows.
#[derive(Debug, Error)]
pub enum RowsError {
    /// The name does not say the format.
    #[error("the ending of the name tells the format: expected .csv or .npy{}", ending(path))]
    UnknownEnding {
        /// The file.
        path: PathBuf,
    },
    /// The operating system cannot read it.
    #[error("cannot read the file: {0}")]
    Unreadable(#[from] std::io::Error),
    /// There is not even a header.
    #[error("the file is empty: expected a header of column names, then one line per row")]
    Empty,
    /// Text that is no CSV in UTF-8.
    #[error("line {line}: {source}")]
    NoCsv {
        /// Line of the file, from 1.
        line: u64,
        /// What the reader said.
        source: Box<dyn std::error::Error + Send + Sync>,
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
    /// A column without a name.
    #[error(
        "column {column} has no name{}",
        if *column == 1 { ": if it is the index that pandas writes, leave it out (index=False)" } else { "" }
    )]
    Nameless {
        /// Number of the column, from 1.
        column: usize,
    },
    /// A column whose name no table or chart has room for, or with marks in it that are not seen.
    #[error("the name of column {column}: expected {expected}")]
    WrongName {
        /// Number of the column, from 1.
        column: usize,
        /// What would be right.
        expected: String,
    },
    /// More or fewer names given than there are columns.
    #[error("{names} names are given, but it has {width} columns")]
    OtherWidth {
        /// Number of columns.
        width: usize,
        /// Number of names.
        names: usize,
    },
    /// Names given for columns that have some.
    #[error("it names its columns itself ({known}): leave --names out, or add --no-header if the first line is a row")]
    HasNames {
        /// The names.
        known: String,
    },
    /// Two columns of one name.
    #[error("column {column}: `{name}` is also the name of column {first}")]
    RepeatedColumn {
        /// Number of the column, from 1.
        column: usize,
        /// The name.
        name: String,
        /// Number of the first column of that name.
        first: usize,
    },
    /// A cell that is neither a number nor a label known of its column.
    #[error("row {row}: column `{name}`: expected {expected}, not {found:?}")]
    WrongCell {
        /// Row of the table, from 1, the header not counted.
        row: u64,
        /// Line of the file, from 1, if it has lines.
        line: Option<u64>,
        /// Number of the column, from 1.
        column: usize,
        /// The column.
        name: String,
        /// What would be right.
        expected: String,
        /// The cell.
        found: String,
    },
    /// A first line of numbers.
    #[error(
        "line {line} holds numbers where the names of the columns are expected: if the file has no header, add --no-header (and \
         --names for the names of the columns in their order)"
    )]
    NumbersForNames {
        /// Line of the file, from 1.
        line: u64,
    },
    /// A Parquet file.
    #[error(
        "it is a Parquet file: write it as CSV, in Python with `pandas.read_parquet(\"FILE.parquet\").to_csv(\"FILE.csv\", \
         index=False)`"
    )]
    Parquet,
    /// A workbook of a spreadsheet, or an archive.
    #[error("it is a workbook or an archive (.xlsx, .xls, .ods, .zip, .npz): save the table as CSV")]
    Spreadsheet,
    /// A file that is no NPY, or holds something else than a table of numbers.
    #[error("not an NPY file that can be read: {0}")]
    NoNpy(String),
}

fn ending(path: &Path) -> String {
    match path.extension().map(|ending| ending.to_string_lossy()) {
        None => String::new(),
        Some(ending) if ending.eq_ignore_ascii_case("parquet") => {
            ", not .parquet: in Python `pandas.read_csv(\"FILE.csv\").to_parquet(\"FILE.parquet\")` makes one of a CSV file"
                .to_owned()
        }
        Some(ending) => format!(", not .{ending}"),
    }
}
