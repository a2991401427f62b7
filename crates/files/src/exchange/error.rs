//! Errors of tables.

use thiserror::Error;

/// An error of a table, or of its manifest: its place, and what is expected.
#[derive(Debug, Error)]
pub enum TableError {
    /// The operating system cannot read it.
    #[error("cannot read the file: {0}")]
    Unreadable(#[from] std::io::Error),
    /// A cell that is neither a number nor a known label of its column.
    #[error("{place}: column {column} (`{name}`): expected {expected}, not {found:?}", place = place_in_words(*line, *row))]
    WrongCell {
        /// Row of the table, from 1, the header not counted.
        row: u64,
        /// Line of the file, from 1, if it has lines.
        line: Option<u64>,
        /// Number of the column, from 1.
        column: usize,
        /// The column.
        name: String,
        /// The expected content.
        expected: String,
        /// The cell.
        found: String,
    },
    /// Any other error, as a message.
    #[error("{0}")]
    Refused(String),
}

/// Refuses a table for this reason.
pub(super) fn refused<T>(reason: impl Into<String>) -> Result<T, TableError> {
    Err(TableError::Refused(reason.into()))
}

/// Describes the place of a cell: a line of the file if it has lines, else a row of the table.
pub(super) fn place_in_words(line: Option<u64>, row: u64) -> String {
    line.map_or_else(|| format!("row {row}"), |line| format!("line {line}"))
}
