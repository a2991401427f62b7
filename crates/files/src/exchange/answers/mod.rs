//! The outputs of a design from a file, checked against their points.

mod columns;

use apportion::model::{Model, RowFailure};
use apportion::quantity::{Unit, is_same};
use apportion::run::{Piece, Store};
use apportion::study::Study;
use columns::{Columns, subject};
pub use columns::{first_output, output_columns};

use super::design_rows::{DesignRows, RowBlock, RowsDigest};
use super::error::{TableError, refused};
use super::manifest::Manifest;
use super::rows::{ColumnKind, RowReader};
use super::table::Missing;

/// The request for a file of outputs.
#[derive(Debug, Clone, Copy)]
pub struct AnswersRequest<'a> {
    /// The manifest of the design.
    pub manifest: &'a Manifest,
    /// Output columns; empty for the study's own if present, or else for all that are not factors.
    pub outputs: &'a [String],
    /// Units of outputs, by column; others have the study's unit, or none.
    pub units: &'a [(String, Unit)],
    /// How rows without a finite output are treated: those that are dropped count as runs that failed.
    pub missing: Missing,
}

/// The outputs of all rows of a design.
#[derive(Debug)]
pub struct Answers {
    /// The study: that of the manifest, with an external model unless the outputs are those of its own model.
    pub study: Study,
    /// The outputs.
    pub store: Store,
    /// Names of the factors whose values in the file were compared with the design.
    pub compared: Vec<String>,
}

/// Reads the outputs of the design that the manifest of `request` describes. If the file also has columns of factors,
/// their values are compared with the design ([`is_same`]: they may have been printed by another program).
///
/// # Errors
/// [`TableError`] if manifest and file do not match, with the first mismatch; if an output is missing and such rows are
/// refused.
pub fn read_answers(reader: &mut dyn RowReader, request: &AnswersRequest<'_>) -> Result<Answers, TableError> {
    let mut study = request.manifest.study()?;
    let columns = Columns::find(reader, &study, request)?;
    let own = subject(&study, &columns.outputs, request)?;
    study = study.with_subject(own);
    let model = study.model();
    let store = Store::new(model.as_ref());
    let wanted = columns.wanted(study.space());
    let mut reading = Reading { reader, study: &study, model: model.as_ref(), columns: &columns, wanted, row: 0 };
    let sha256 = reading.all(&store, request.missing)?;
    // Values that agree to ten digits may still belong to another version: those of the study are used.
    request.manifest.check_points(&sha256)?;
    if model.flags().iter().any(|flag| !flag.warns) && !study.subject().is_external() {
        let note = "the file has no validity flags of the model: none are counted".to_owned();
        study.note(note);
    }
    drop(model);
    let compared = columns.factors.iter().map(|&(_, factor)| study.space().factors()[factor].name.clone()).collect();
    Ok(Answers { study, store, compared })
}

/// A file that is read into a store.
struct Reading<'a> {
    reader: &'a mut dyn RowReader,
    study: &'a Study,
    model: &'a dyn Model,
    columns: &'a Columns,
    /// The outputs, then the factors.
    wanted: Vec<(usize, ColumnKind)>,
    /// Number of rows read and checked.
    row: u64,
}

impl Reading<'_> {
    /// Reads all rows and returns the SHA-256 of the design's numbers.
    fn all(&mut self, store: &Store, missing: Missing) -> Result<String, TableError> {
        let design = &self.study.design();
        let mut cells = vec![Vec::new(); self.wanted.len()];
        let mut points = vec![Vec::new(); design.factors()];
        let (mut rows, mut digest) = (DesignRows::new(self.study.space(), design), RowsDigest::default());
        while let Some(block) = rows.next_block(&mut points) {
            digest.add(&points);
            let count = self.reader.read(&self.wanted, block.rows, &mut cells)?;
            let (answers, found) = cells.split_at(self.columns.outputs.len());
            self.compare(&points, found, count)?;
            if count < block.rows {
                let found = self.row + count as u64;
                return refused(format!("the file has {found} rows, but the design has {}", design.rows()));
            }
            store.insert(&self.piece(block, answers, missing)?);
            self.row += count as u64;
        }
        if self.reader.read(&self.wanted, 1, &mut cells)? > 0 {
            return refused(format!("the file has more rows than the design, which has {}", design.rows()));
        }
        Ok(digest.finish())
    }

    /// Returns the outputs of a block.
    fn piece(&self, block: RowBlock, answers: &[Vec<f64>], missing: Missing) -> Result<Piece, TableError> {
        let outputs = self.model.outputs();
        let reason = RowFailure::new("the file of outputs has no finite number for it");
        let mut piece = Piece { replicate: block.replicate, first: block.first, ..Piece::default() };
        piece.values.reserve(block.rows * outputs.len());
        for row in 0..block.rows {
            for (number, (column, output)) in answers.iter().zip(outputs).enumerate() {
                let si = output.unit.to_si(column[row]);
                if !si.is_finite() {
                    if missing == Missing::Refuse {
                        let what = match column[row] {
                            found if found.is_nan() => "the value is missing".to_owned(),
                            found => format!("{found} is not a finite number"),
                        };
                        let (row, name) = (self.row + row as u64 + 1, &output.name);
                        return refused(format!(
                            "row {row}, column `{name}`: {what}; --missing-as-failed counts such rows as runs that failed"
                        ));
                    }
                    piece.failures.push((row as u32, number as u32, reason.clone()));
                }
                piece.values.push(if si.is_finite() { si } else { f64::NAN });
            }
        }
        Ok(piece)
    }

    /// Checks that the first `count` rows found are those of the design.
    fn compare(&self, points: &[Vec<f64>], found: &[Vec<f64>], count: usize) -> Result<(), TableError> {
        let differs = |row: usize| {
            let pairs = self.columns.factors.iter().zip(found);
            pairs.into_iter().find(|((_, factor), column)| !is_same(column[row], points[*factor][row]))
        };
        let Some((row, ((_, factor), column))) = (0..count).find_map(|row| Some((row, differs(row)?))) else {
            return Ok(());
        };
        let number = *factor;
        let factor = &self.study.space().factors()[number];
        let words = |value: f64| match value.is_nan() {
            true => "an empty cell".to_owned(),
            false => factor.in_words(value, |number| number.to_string()),
        };
        let (found, expected) = (words(column[row]), words(points[number][row]));
        let (row, name) = (self.row + row as u64 + 1, &factor.name);
        refused(format!(
            "row {row}, column `{name}`: found {found}, but the design has {expected}: rows are missing, repeated or in another \
             order, or the points were changed, were printed with less than ten digits, or belong to another design"
        ))
    }
}
