//! Files of points and outputs, and their manifests.

use apportion_files::exchange::{ColumnKind, Manifest, ReadOptions, table_of_bytes};

/// Rows up to which a table is read.
const ROWS: usize = 1 << 16;

/// Each kind of file is refused with a reason, or read to its end.
pub fn run(bytes: &[u8]) {
    read(bytes, &ReadOptions::default());
    read(bytes, &ReadOptions { no_header: true, missing: vec![-999.0], ..ReadOptions::default() });
    if let Some(manifest) = std::str::from_utf8(bytes).ok().and_then(|text| Manifest::parse(text).ok()) {
        assert!(Manifest::parse(&manifest.json()).is_ok());
    }
}

/// Reads some columns of a table to its end.
fn read(bytes: &[u8], options: &ReadOptions) {
    let Ok(mut rows) = table_of_bytes(bytes.to_vec(), options) else { return };
    assert!(rows.names().is_none_or(|names| names.len() == rows.width()));
    let labels = vec![("steel".to_owned(), 1.0), ("brass".to_owned(), 2.0)];
    let kinds = [ColumnKind::numbers("a"), ColumnKind { name: "b".to_owned(), labels, whole: false }];
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
