//! What can be wrong with a file of outputs.

use thiserror::Error;

use crate::exchange::{ManifestError, RowsError};
use crate::study::did_you_mean;

/// What is wrong with a file of outputs.
#[derive(Debug, Error)]
pub enum AnswersError {
    /// The manifest.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// The file.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// An output that is no column.
    #[error("no column is called `{name}`{}; the columns are {known}", did_you_mean(.nearest))]
    UnknownOutput {
        /// The output.
        name: String,
        /// The nearest column.
        nearest: Option<String>,
        /// All columns.
        known: String,
    },
    /// A factor asked for as an output, or an output twice.
    #[error("`{name}` is asked for as an output{}", if *.factor { ", but is a factor" } else { " twice" })]
    NoOutput {
        /// The column.
        name: String,
        /// Whether it is a factor.
        factor: bool,
    },
    /// An output after which no file can be named, or which no table has room for.
    #[error("the name {name} of an output: expected {expected}")]
    OutputName {
        /// The name, or its beginning.
        name: String,
        /// What would be right.
        expected: String,
    },
    /// All columns are factors.
    #[error("the file holds no outputs: its columns are the factors {known}")]
    FactorsOnly {
        /// All columns.
        known: String,
    },
    /// A unit for something that is no output.
    #[error("a unit is given for `{name}`, which is no output; the outputs are {known}")]
    UnitOfNone {
        /// The name.
        name: String,
        /// The outputs.
        known: String,
    },
    /// A unit of another kind than the one that the study says.
    #[error(
        "the unit `{unit}` is given for `{name}`, and {kind}: the study says `{own}`, so expected a unit of the same kind ({own_kind})"
    )]
    OtherUnit {
        /// The output.
        name: String,
        /// The unit given.
        unit: String,
        /// What it measures, in words.
        kind: String,
        /// The unit of the study.
        own: String,
        /// What that measures.
        own_kind: String,
    },
    /// A file without names of another width.
    #[error(
        "the file has {width} columns, without names: expected {outputs} (the outputs) or {} (the {factors} factors, then \
         the outputs)",
        .factors + .outputs
    )]
    WrongWidth {
        /// Columns of the file.
        width: usize,
        /// Factors of the study.
        factors: usize,
        /// Outputs expected.
        outputs: usize,
    },
    /// A row with another value than that of the design.
    #[error(
        "row {row}, column `{name}`: {found} stands where the design has {expected}: rows are missing, repeated or in another \
         order, or the points have been changed, printed with less than ten digits, or belong to another design"
    )]
    OtherRow {
        /// Row of the file, from 1.
        row: u64,
        /// The factor.
        name: String,
        /// In the file.
        found: String,
        /// In the design.
        expected: String,
    },
    /// More or fewer rows than the design has.
    #[error("the file has {found} rows, and the design {expected}")]
    RowCount {
        /// Rows of the file.
        found: u64,
        /// Rows of the design.
        expected: u64,
    },
    /// A row without an output.
    #[error(
        "row {row}, column `{name}`: {}; --missing-as-failed counts such rows as runs that failed",
        if .found.is_nan() { "the value is missing".to_owned() } else { format!("{found} is no finite number") }
    )]
    MissingOutput {
        /// Row of the file, from 1.
        row: u64,
        /// The output.
        name: String,
        /// What stands there.
        found: f64,
    },
}
