//! The recorded runs of a journal.

use crate::run::Store;
use crate::run::journal::Contents;
use crate::study::Study;

/// Returns a store of the runs of `study` in a journal; of duplicates, the later one counts.
pub(in crate::runner) fn recorded(study: &Study, contents: &Contents) -> Store {
    let store = Store::new(study.model().as_ref());
    let outputs = store.outputs();
    for piece in &contents.pieces {
        let rows = piece.rows(outputs);
        let mut failures = piece.failures.iter();
        let fits = failures.all(|(row, output, _)| u64::from(*row) < rows && (*output as usize) < outputs);
        let is_whole = rows as usize * outputs == piece.values.len();
        if piece.replicate < study.design.settings().replicates && fits && is_whole {
            store.insert(piece);
        }
    }
    store
}

/// Counts the rows of the design that are in `store`.
pub(in crate::runner) fn rows_on_record(study: &Study, store: &Store) -> u64 {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    (0..study.design.settings().replicates).map(|replicate| store.count(replicate, 0..rows).0).sum()
}
