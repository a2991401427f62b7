//! The outputs of a design from a file, checked against the points that they belong to.

use thiserror::Error;

use super::design_rows::{DesignRows, RowBlock, RowsDigest, factor_column};
use super::manifest::{Manifest, ManifestError};
use super::rows::{ColumnKind, RowReader, RowsError};
use crate::model::{Model, Output, RowFailure};
use crate::quantity::{Unit, is_same};
use crate::run::{Piece, Store};
use crate::study::{ExternalSubject, Study, Subject, nearest};

/// Rows counted at a time.
const COUNTED: usize = 1 << 13;

/// What becomes of a row without a finite output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MissingOutputs {
    /// The file is refused.
    #[default]
    Refuse,
    /// The row counts as a run that failed.
    Failed,
}

/// What is read from a file of outputs.
#[derive(Debug, Clone, Copy)]
pub struct AnswersRequest<'a> {
    /// Whose outputs they are.
    pub manifest: &'a Manifest,
    /// Columns that are outputs; none for the study's own if they are there, or else for all that are no factors.
    pub outputs: &'a [String],
    /// Units of outputs, by column; others are in the unit that the study says, or in none.
    pub units: &'a [(String, Unit)],
    /// What becomes of rows without an output.
    pub missing: MissingOutputs,
}

/// The outputs of all rows of a design.
#[derive(Debug)]
pub struct Answers {
    /// The study: that of the manifest, of a model outside unless the outputs are the ones of its own model.
    pub study: Study,
    /// The outputs.
    pub store: Store,
    /// Names of the factors whose values in the file were compared with the design.
    pub compared: Vec<String>,
}

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
    #[error("no column is called `{name}`{}; the columns are {known}", hint(.nearest))]
    UnknownOutput {
        /// The output.
        name: String,
        /// The nearest column.
        nearest: Option<String>,
        /// All columns.
        known: String,
    },
    /// A factor asked for as an output, or an output twice.
    #[error("`{name}` is asked for as an output{}", if *.factor { ", but is a factor of the study" } else { " twice" })]
    NoOutput {
        /// The column.
        name: String,
        /// Whether it is a factor.
        factor: bool,
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
    /// A value that is not the one of the design.
    #[error(
        "row {row}, column `{name}`: {found} stands where the design has {expected}: the points have been changed, or \
         belong to another design"
    )]
    ChangedValue {
        /// Row of the file, from 1.
        row: u64,
        /// The factor.
        name: String,
        /// In the file.
        found: String,
        /// In the design.
        expected: String,
    },
    /// As many rows as the design has, in another order.
    #[error("the rows are in another order than those of the design: row {row} of the file is row {is} of the design")]
    Reordered {
        /// Row of the file, from 1.
        row: u64,
        /// Row of the design, from 1.
        is: u64,
    },
    /// Fewer rows than the design has.
    #[error("{} of the {expected} rows of the design {} missing: the file has {found}{place}", .expected - .found,
        if .expected - .found == 1 { "is" } else { "are" })]
    MissingRows {
        /// Rows of the file.
        found: u64,
        /// Rows of the design.
        expected: u64,
        /// Where the first one is missing, in words.
        place: String,
    },
    /// More rows than the design has.
    #[error("the file has {} row{} more than the {expected} of the design: {place}", .found - .expected,
        if .found - .expected == 1 { "" } else { "s" })]
    ExtraRows {
        /// Rows of the file.
        found: u64,
        /// Rows of the design.
        expected: u64,
        /// Which the first one is, in words.
        place: String,
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

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

/// Reads the outputs of the design that the manifest of `request` describes. Where the file holds columns of factors too,
/// their values are compared with the design ([`is_same`]: they may have been printed by another program).
///
/// # Errors
/// [`AnswersError`] if manifest and file do not belong together, with the first place where that shows; if an output is
/// missing and such rows are refused.
pub fn read_answers(reader: &mut dyn RowReader, request: &AnswersRequest<'_>) -> Result<Answers, AnswersError> {
    let mut study = request.manifest.study()?;
    let columns = Columns::of(reader, &study, request)?;
    study.subject = subject(&study, &columns.outputs, request)?;
    let model = study.model();
    let store = Store::new(&study.design, model.as_ref());
    let mut reading = Reading { reader, study: &study, model: model.as_ref(), columns: &columns, row: 0 };
    let sha256 = reading.all(&store, request.missing)?;
    // Values that agree to ten digits may still be another version's: those of the study are the ones in force.
    request.manifest.check_points(&sha256)?;
    if !model.flags().is_empty() && !matches!(study.subject, Subject::External(_)) {
        let note = "the file holds no validity flags of the model: none are counted".to_owned();
        study.notes.push(note);
    }
    drop(model);
    let compared = columns.factors.iter().map(|&(_, factor)| study.space.factors()[factor].name.clone()).collect();
    Ok(Answers { study, store, compared })
}

/// Which columns of the file are what.
struct Columns {
    /// Outputs: the column and its name.
    outputs: Vec<(usize, String)>,
    /// Factors: the column and the number of the factor.
    factors: Vec<(usize, usize)>,
}

impl Columns {
    fn of(reader: &dyn RowReader, study: &Study, request: &AnswersRequest<'_>) -> Result<Self, AnswersError> {
        let own: Vec<String> = study.model().outputs().iter().map(|output| output.name.to_string()).collect();
        let factors = study.space.factors();
        let Some(names) = reader.names() else {
            let outputs = if request.outputs.is_empty() { own } else { request.outputs.to_vec() };
            let (width, count) = (reader.width(), factors.len());
            let first = match width.checked_sub(outputs.len()) {
                Some(0) => 0,
                Some(before) if before == count => count,
                _ => return Err(AnswersError::WrongWidth { width, factors: count, outputs: outputs.len() }),
            };
            let factors = (0..first).map(|place| (place, place)).collect();
            return Ok(Self { outputs: (first..).zip(outputs).collect(), factors });
        };
        let is_factor = |name: &str| factors.iter().position(|factor| factor.name == name);
        let place = |name: &String| {
            names.iter().position(|known| known == name).ok_or_else(|| AnswersError::UnknownOutput {
                name: name.clone(),
                nearest: nearest(name, names.iter().map(String::as_str)),
                known: names.join(", "),
            })
        };
        let own_are_there = own.iter().all(|name| names.contains(name) && is_factor(name).is_none());
        let asked = match request.outputs {
            [] if own_are_there || matches!(study.subject, Subject::External(_)) => own,
            [] => names.iter().filter(|name| is_factor(name).is_none()).cloned().collect(),
            asked => asked.to_vec(),
        };
        if asked.is_empty() {
            return Err(AnswersError::FactorsOnly { known: names.join(", ") });
        }
        for (number, name) in asked.iter().enumerate() {
            if is_factor(name).is_some() || asked[..number].contains(name) {
                return Err(AnswersError::NoOutput { name: name.clone(), factor: is_factor(name).is_some() });
            }
        }
        let outputs = asked.into_iter().map(|name| Ok((place(&name)?, name))).collect::<Result<_, AnswersError>>()?;
        let factors = names.iter().enumerate().filter_map(|(place, name)| Some((place, is_factor(name)?))).collect();
        Ok(Self { outputs, factors })
    }
}

/// The study's own model if the outputs are its own, else a model outside with these outputs.
fn subject(study: &Study, columns: &[(usize, String)], request: &AnswersRequest<'_>) -> Result<Subject, AnswersError> {
    let model = study.model();
    let own = model.outputs();
    if let Some((name, _)) = request.units.iter().find(|(name, _)| columns.iter().all(|(_, column)| column != name)) {
        let known = columns.iter().map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ");
        return Err(AnswersError::UnitOfNone { name: name.clone(), known });
    }
    let names = columns.iter().map(|(_, name)| name);
    if request.units.is_empty() && names.clone().eq(own.iter().map(|output| &*output.name)) {
        return Ok(study.subject.clone());
    }
    let output = |name: &String| {
        let stated = own.iter().find(|output| output.name == *name);
        let unit = request.units.iter().find(|(known, _)| known == name).map(|(_, unit)| unit.clone());
        let unit = unit.or_else(|| stated.map(|output| output.unit.clone())).unwrap_or_else(Unit::dimensionless);
        Output::new(name.clone(), unit, "read from a file")
    };
    Ok(Subject::External(ExternalSubject { outputs: names.map(output).collect() }))
}

/// A file on its way into a store.
struct Reading<'a> {
    reader: &'a mut dyn RowReader,
    study: &'a Study,
    model: &'a dyn Model,
    columns: &'a Columns,
    /// Rows read and found right.
    row: u64,
}

impl Reading<'_> {
    /// Reads all rows; the SHA-256 of the design's numbers.
    fn all(&mut self, store: &Store, missing: MissingOutputs) -> Result<String, AnswersError> {
        let (space, design) = (&self.study.space, &self.study.design);
        let outputs = self.columns.outputs.iter().map(|(place, name)| (*place, ColumnKind::numbers(name)));
        let factors =
            self.columns.factors.iter().map(|(place, factor)| (*place, factor_column(&space.factors()[*factor])));
        let wanted: Vec<_> = outputs.chain(factors).collect();
        let mut cells = vec![Vec::new(); wanted.len()];
        let mut points = vec![Vec::new(); design.factors()];
        let (mut rows, mut digest) = (DesignRows::new(space, design), RowsDigest::default());
        while let Some(block) = rows.next_block(&mut points) {
            digest.add(&points);
            let count = self.reader.read(&wanted, block.rows, &mut cells)?;
            let (answers, found) = cells.split_at(self.columns.outputs.len());
            self.compare(&points, found, count)?;
            if count < block.rows {
                let (found, place) = (self.row + count as u64, String::new());
                return Err(AnswersError::MissingRows { found, expected: design.rows(), place });
            }
            store.insert(&self.piece(block, answers, missing)?);
            self.row += count as u64;
        }
        let more = self.count_rest();
        if more > 0 {
            let (found, expected) = (self.row + more, design.rows());
            let place = format!("row {} is the first of them", expected + 1);
            return Err(AnswersError::ExtraRows { found, expected, place });
        }
        Ok(digest.finish())
    }

    /// The outputs of a block.
    fn piece(&self, block: RowBlock, answers: &[Vec<f64>], missing: MissingOutputs) -> Result<Piece, AnswersError> {
        let outputs = self.model.outputs();
        let reason = RowFailure::new("the file of outputs has no finite number for it");
        let mut piece = Piece { replicate: block.replicate, first: block.first, ..Piece::default() };
        piece.values.reserve(block.rows * outputs.len());
        for row in 0..block.rows {
            for (number, (column, output)) in answers.iter().zip(outputs).enumerate() {
                let si = output.unit.to_si(column[row]);
                if !si.is_finite() {
                    if missing == MissingOutputs::Refuse {
                        let (row, found) = (self.row + row as u64 + 1, column[row]);
                        return Err(AnswersError::MissingOutput { row, name: output.name.to_string(), found });
                    }
                    piece.failures.push((row as u32, number as u32, reason.clone()));
                }
                piece.values.push(if si.is_finite() { si } else { f64::NAN });
            }
        }
        Ok(piece)
    }

    /// Whether the first `count` rows found are those of the design.
    fn compare(&mut self, points: &[Vec<f64>], found: &[Vec<f64>], count: usize) -> Result<(), AnswersError> {
        let differs = |row: usize| {
            let pairs = self.columns.factors.iter().zip(found);
            pairs.into_iter().find(|((_, factor), column)| !is_same(column[row], points[*factor][row]))
        };
        let Some((row, ((_, factor), column))) = (0..count).find_map(|row| Some((row, differs(row)?))) else {
            return Ok(());
        };
        let number = *factor;
        let factor = &self.study.space.factors()[number];
        let words = |value: f64| match value.is_nan() {
            true => "nothing".to_owned(),
            false => factor.in_words(value, |number| number.to_string()),
        };
        let changed = AnswersError::ChangedValue {
            row: self.row + row as u64 + 1,
            name: factor.name.clone(),
            found: words(column[row]),
            expected: words(points[number][row]),
        };
        let there: Vec<f64> = found.iter().map(|column| column[row]).collect();
        let Some(is) = self.find(&there) else { return Err(changed) };
        let (row, is) = (self.row + row as u64 + 1, is + 1);
        let (total, expected) = (self.row + count as u64 + self.count_rest(), self.study.design.rows());
        let words = format!("row {row} of the file is row {is} of the design");
        Err(match total.cmp(&expected) {
            std::cmp::Ordering::Less if is > row => AnswersError::MissingRows {
                found: total,
                expected,
                place: format!("; the first is row {row}: {words}"),
            },
            std::cmp::Ordering::Greater if is < row => {
                AnswersError::ExtraRows { found: total, expected, place: format!("{words} again") }
            }
            _ => AnswersError::Reordered { row, is },
        })
    }

    /// The row of the design with these values of the factors in the file, from 0.
    fn find(&self, there: &[f64]) -> Option<u64> {
        let mut rows = DesignRows::new(&self.study.space, &self.study.design);
        let mut points = vec![Vec::new(); self.study.design.factors()];
        let mut before = 0;
        while let Some(block) = rows.next_block(&mut points) {
            let is_it = |row: &usize| {
                self.columns
                    .factors
                    .iter()
                    .zip(there)
                    .all(|((_, factor), value)| is_same(*value, points[*factor][*row]))
            };
            if let Some(row) = (0..block.rows).find(is_it) {
                return Some(before + row as u64);
            }
            before += block.rows as u64;
        }
        None
    }

    /// Rows of the file that have not been read, as far as they can be.
    fn count_rest(&mut self) -> u64 {
        let mut rest = 0;
        while let Ok(rows @ 1..) = self.reader.read(&[], COUNTED, &mut []) {
            rest += rows as u64;
        }
        rest
    }
}
