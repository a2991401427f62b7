//! What is wrong with a table.

use thiserror::Error;

/// What is wrong with a table, or with the manifest beside it: its place, and what would be right.
#[derive(Debug, Error)]
pub enum TableError {
    /// The operating system cannot read it.
    #[error("cannot read the file: {0}")]
    Unreadable(#[from] std::io::Error),
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
    /// Anything else, in words.
    #[error("{0}")]
    Refused(String),
}

/// Refuses a table for this reason.
pub(super) fn refused<T>(reason: impl Into<String>) -> Result<T, TableError> {
    Err(TableError::Refused(reason.into()))
}

/// Where a cell stands: a line of the file where it has lines, else a row of the table.
pub(super) fn place_in_words(line: Option<u64>, row: u64) -> String {
    line.map_or_else(|| format!("row {row}"), |line| format!("line {line}"))
}
