//! Parquet files: the panics of its crate over damaged ones are errors.

use apportion::exchange::Format;

use super::rows::read;

/// A file is refused with a reason, or read to its end.
pub fn run(bytes: &[u8]) {
    read(Format::Parquet, bytes);
}
