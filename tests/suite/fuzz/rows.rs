//! Files of points and outputs, and what stands beside them.

use apportion::exchange::{ColumnKind, Format, Manifest, rows_of_bytes};
use apportion::salib::SalibProblem;

/// Rows up to which a table is read.
const ROWS: usize = 1 << 16;

/// Each kind of file is refused with a reason, or read to its end. (Parquet has a target of its own.)
pub fn run(bytes: &[u8]) {
    read(Format::Csv, bytes);
    read(Format::Npy, bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        if let Ok(manifest) = Manifest::parse(text) {
            assert!(Manifest::parse(&manifest.json()).is_ok());
        }
        let _ = SalibProblem::parse(text);
    }
}

/// A Parquet file is refused with a reason, or read to its end; the panics of its crate over damaged ones are errors.
pub fn run_parquet(bytes: &[u8]) {
    read(Format::Parquet, bytes);
}

/// Reads some columns of a table to its end.
fn read(format: Format, bytes: &[u8]) {
    let Ok(mut rows) = rows_of_bytes(format, bytes.to_vec()) else { return };
    assert!(rows.names().is_none_or(|names| names.len() == rows.width()));
    let labels = vec![("steel".to_owned(), 1.0), ("brass".to_owned(), 2.0)];
    let kinds = [ColumnKind::numbers("a"), ColumnKind { name: "b".to_owned(), labels, optional: true, whole: false }];
    let wanted: Vec<(usize, ColumnKind)> = kinds.into_iter().enumerate().take(rows.width()).collect();
    let mut columns = vec![Vec::new(); wanted.len()];
    let mut all = 0;
    while all < ROWS {
        match rows.read(&wanted, 100, &mut columns) {
            Ok(0) | Err(_) => break,
            Ok(count) => {
                assert!(count <= 100 && columns.iter().all(|column| column.len() == count), "{count}");
                all += count;
            }
        }
    }
}
