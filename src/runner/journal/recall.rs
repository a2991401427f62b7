//! What a journal holds of a study, by the files of the model that answered.

use std::path::Path;

use serde_json::Value;

use super::{Resume, refused};
use crate::run::journal::Contents;
use crate::run::{Piece, RunError, Store};
use crate::runner::model_files::{ModelFiles, differing};
use crate::study::Study;

/// Runs on record that were evaluated with other files of the model than those of now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::runner) struct Foreign {
    /// The names of the files that differ.
    pub names: String,
    pub rows: u64,
}

/// What is on record, by the model that answered.
pub(super) struct Recalled {
    /// Runs that were evaluated with the files of now.
    pub own: Store,
    /// These and all others, if there are others.
    pub all: Option<Store>,
    pub foreign: Option<Foreign>,
    /// Runs that failed, and are to be evaluated again.
    pub forgotten: u64,
}

/// What a journal holds of `study`, whose model has `files` now. Where a run is there twice, that of the files of now
/// counts, and else the later one.
pub(super) fn recall(study: &Study, contents: &Contents, files: &Value, resume: Resume) -> Recalled {
    let again = |store: &Store| if resume == Resume::RetryFailed { store.forget_failures() } else { 0 };
    let is_own = |now: &Value| differing(now, files).is_none();
    let mut names = None;
    for (_, before) in contents.pieces_with_files() {
        names = names.or_else(|| differing(before, files));
    }
    let empty = || Store::new(&study.design, study.model().as_ref());
    let own = empty();
    fill(&own, study, contents, &is_own);
    let Some(names) = names else {
        let forgotten = again(&own);
        return Recalled { own, all: None, foreign: None, forgotten };
    };
    let all = empty();
    fill(&all, study, contents, &|before| !is_own(before));
    fill(&all, study, contents, &is_own);
    let forgotten = again(&all);
    again(&own);
    let rows = all.rows().saturating_sub(own.rows());
    let foreign = (rows > 0).then_some(Foreign { names, rows });
    Recalled { own, all: Some(all), foreign, forgotten }
}

impl Recalled {
    /// Why nothing of it is of use, if runs are there, but all of another model.
    pub fn of_another_model(&self) -> Option<String> {
        let foreign = self.foreign.as_ref().filter(|_| self.own.rows() == 0)?;
        Some(format!("{} changed since the journal was written", foreign.names))
    }

    /// Refuses runs of another model, of which the user may not know.
    pub fn refuse(&self, path: &Path, resume: Resume) -> Result<(), RunError> {
        let Some(Foreign { names, rows }) = &self.foreign else { return Ok(()) };
        let option = resume.option();
        Err(refused(
            path,
            format!(
                "{names} changed since {rows} of the runs on record were evaluated: the result would mix two models. Undo \
             the change; or leave out {option}, and they are evaluated again; or add --mix-models, and they are used, which \
             the result then says"
            ),
        ))
    }
}

/// A store of what a journal of this study holds of the model as it is now.
pub(super) fn filled(study: &Study, contents: &Contents) -> Store {
    recall(study, contents, ModelFiles::new(study).begun(), Resume::IfThere).own
}

/// What a journal of a part holds, and the files that it was evaluated with.
///
/// # Errors
/// [`RunError::Refused`] if several models have answered.
pub(in crate::runner) fn part(study: &Study, path: &Path, contents: &Contents) -> Result<(Store, Value), RunError> {
    if contents.sums.is_some() {
        return Err(refused(
            path,
            "this journal holds the sums of a run, and not the outputs of a part of one".to_owned(),
        ));
    }
    let last = contents.pieces_with_files().last().map(|(_, files)| files);
    let files = last.or(contents.stretches.last().map(|stretch| &stretch.files)).unwrap_or(&Value::Null);
    let recalled = recall(study, contents, files, Resume::IfThere);
    match recalled.foreign {
        None => Ok((recalled.own, files.clone())),
        Some(Foreign { names, rows }) => {
            let what = "of its runs were evaluated with another";
            Err(refused(path, format!("{rows} {what} {names} than the others: evaluate this part again")))
        }
    }
}

/// Puts the pieces of a journal that were evaluated with `wanted` files in `store`.
fn fill(store: &Store, study: &Study, contents: &Contents, wanted: &dyn Fn(&Value) -> bool) {
    let outputs = store.outputs();
    let fits = |piece: &Piece| {
        let rows = piece.rows(outputs);
        let failures =
            piece.failures.iter().all(|(row, output, _)| u64::from(*row) < rows && (*output as usize) < outputs);
        piece.replicate < study.design.settings().replicates
            && failures
            && rows as usize * outputs == piece.values.len()
    };
    for (piece, files) in contents.pieces_with_files() {
        if wanted(files) && fits(piece) {
            store.insert(piece);
        }
    }
}

/// Rows of the design that are in `store`.
pub(super) fn rows_on_record(study: &Study, store: &Store) -> u64 {
    let rows = study.design.points_per_replicate() * study.design.rows_per_point();
    (0..study.design.settings().replicates).map(|replicate| store.count(replicate, 0..rows).0).sum()
}
