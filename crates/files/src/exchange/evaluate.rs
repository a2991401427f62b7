//! Evaluation of a study's model at the points of a table, whose columns are named after factors.

use std::collections::BTreeMap;
use std::io::Write;

use apportion::model::{Batch, Output, RowFailure};
use apportion::run::{RunError, TableRun};
use apportion::space::{Factor, Space};
use apportion_base::names::{did_you_mean, nearest};
use thiserror::Error;

use super::design_rows::factor_column;
use super::error::{TableError, place_in_words, refused};
use super::rows::{ColumnKind, Format, RowReader, RowWriter};

/// Why points could not be evaluated.
#[derive(Debug, Error)]
pub enum EvaluateError {
    /// The points are wrong.
    #[error(transparent)]
    Points(#[from] TableError),
    /// The outputs cannot be written.
    #[error("cannot write the outputs: {0}")]
    Output(#[from] std::io::Error),
    /// The run failed.
    #[error("{0}")]
    Run(#[from] RunError),
}

/// The result of an evaluation.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Evaluated {
    /// Number of points.
    pub points: u64,
    /// For each output that failed and each reason: how often, and the first point, counted from 1.
    pub failures: BTreeMap<(String, RowFailure), (u64, u64)>,
    /// Names of the text columns that are not factors, and were not read.
    pub skipped: Vec<String>,
    /// The factors without a column, by number, which are at their nominal values.
    pub nominal: Vec<usize>,
    /// Whether the last line of the text has no end: it may have been cut short, even within a number.
    pub unended: bool,
}

/// Evaluates the model of `run` at the points of a table, whose columns are named after factors of `space`, and writes its
/// outputs as CSV: a header of output names, one line per point, in the outputs' units. A failed output is an empty
/// cell.
///
/// Uses constant memory, and as many workers as the model [asks for](apportion::model::Model::concurrency); the outputs
/// are in the order of the points. Numbers are written with as many digits as it takes to read the same bits back.
///
/// If `with_points`, the points are before their outputs in every line: a column for each factor, in its unit.
///
/// # Errors
/// [`EvaluateError`] if the points are wrong, the outputs cannot be written, the model gives up, or the run is stopped.
pub fn evaluate(
    run: &TableRun<'_>,
    space: &Space,
    points: &mut dyn RowReader,
    outputs: &mut dyn Write,
    with_points: bool,
) -> Result<Evaluated, EvaluateError> {
    let mut reader = PointsReader::new(points, space)?;
    let (model, factors, max_rows) = (run.model(), space.factors(), run.rows_at_once());
    let mut batch = Batch::new(model);
    let mut columns = vec![Vec::with_capacity(max_rows); factors.len()];
    let mut evaluated = Evaluated {
        skipped: reader.skipped.clone(),
        nominal: (0..factors.len()).filter(|factor| !reader.factors.contains(factor)).collect(),
        ..Evaluated::default()
    };
    let copied: &[Factor] = if with_points { factors } else { &[] };
    let mut writer = RowWriter::new(Format::Csv, outputs, super::design_rows::columns(copied, model.outputs()), 0)?;
    loop {
        let rows = reader.read(factors, max_rows, &mut columns)?;
        if rows == 0 {
            break;
        }
        let typed = if with_points { columns.clone() } else { Vec::new() };
        for (column, factor) in columns.iter_mut().zip(factors) {
            for value in column {
                *value = factor.unit().to_si(*value);
            }
        }
        batch.reset(rows);
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        run.run(&inputs, &mut batch)?;
        evaluated.count(model.outputs(), &batch);
        let answers: Vec<Vec<f64>> =
            model.outputs().iter().enumerate().map(|(k, output)| in_unit(output, batch.column(k))).collect();
        let all: Vec<&[f64]> = typed.iter().chain(&answers).map(Vec::as_slice).collect();
        writer.write(&all)?;
    }
    writer.finish()?;
    evaluated.unended = reader.rows.is_unended();
    Ok(evaluated)
}

/// Returns values of an output in its unit; NaN for a missing one.
fn in_unit(output: &Output, values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| if value.is_finite() { output.unit.from_si(*value) } else { f64::NAN }).collect()
}

impl Evaluated {
    fn count(&mut self, outputs: &[Output], batch: &Batch) {
        for (output, row, failure) in batch.failures() {
            let point = self.points + *row as u64 + 1;
            let key = (outputs[*output].name.to_string(), failure.clone());
            self.failures.entry(key).and_modify(|(count, _)| *count += 1).or_insert((1, point));
        }
        self.points += batch.rows() as u64;
    }
}

/// Reads points block by block.
pub(super) struct PointsReader<'a> {
    pub rows: &'a mut dyn RowReader,
    /// For each column that is read: its position in the file with its content, and the number of its factor.
    wanted: Vec<(usize, ColumnKind)>,
    pub factors: Vec<usize>,
    /// The names of the text columns that are not read.
    pub skipped: Vec<String>,
    cells: Vec<Vec<f64>>,
    /// Number of rows read.
    read: u64,
}

impl<'a> PointsReader<'a> {
    /// Checks the columns of `rows` against `space`. Text columns that are not factors are skipped.
    ///
    /// # Errors
    /// [`TableError`] if there are no names, or one of them is unknown.
    pub fn new(rows: &'a mut dyn RowReader, space: &Space) -> Result<Self, TableError> {
        let valid: Vec<&str> = space.factors().iter().map(|factor| factor.name.as_str()).collect();
        let Some(names) = rows.names().map(<[String]>::to_vec) else {
            return refused(format!(
                "its {} columns have no names: name the factors in their order (--names), out of {}",
                rows.width(),
                valid.join(", ")
            ));
        };
        let (mut wanted, mut factors, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
        for (place, name) in names.into_iter().enumerate() {
            if let Some(factor) = valid.iter().position(|factor| *factor == name) {
                wanted.push((place, factor_column(&space.factors()[factor])));
                factors.push(factor);
            } else if rows.text_columns()?.iter().any(|(text, _)| *text == place) {
                skipped.push(name);
            } else {
                let (column, hint) = (place + 1, did_you_mean(&nearest(&name, valid.iter().copied())));
                return refused(format!(
                    "column {column}: `{name}` is not a factor of the study{hint}; its factors are {}",
                    valid.join(", ")
                ));
            }
        }
        let cells = vec![Vec::new(); wanted.len()];
        Ok(Self { rows, wanted, factors, skipped, cells, read: 0 })
    }

    /// Reads up to `rows` points into `columns` (one per factor of the space, in its unit) and returns how many there
    /// were; 0 at the end of the file. A factor without a column is at its nominal value.
    ///
    /// # Errors
    /// [`TableError`] with the place of the first cell that is not a finite number.
    pub fn read(&mut self, factors: &[Factor], rows: usize, columns: &mut [Vec<f64>]) -> Result<usize, TableError> {
        let count = self.rows.read(&self.wanted, rows, &mut self.cells)?;
        for (column, factor) in columns.iter_mut().zip(factors) {
            column.clear();
            column.resize(count, factor.nominal);
        }
        for ((cells, (place, _)), factor) in self.cells.iter().zip(&self.wanted).zip(&self.factors) {
            if let Some(row) = cells.iter().position(|value| !value.is_finite()) {
                let cell = if cells[row].is_nan() { "an empty cell".to_owned() } else { cells[row].to_string() };
                let at = place_in_words(self.rows.line(row), self.read + row as u64 + 1);
                let (column, factor) = (place + 1, &factors[*factor]);
                let expected = match factor.distribution().labels() {
                    Some(labels) => format!("one of {}", labels.join(", ")),
                    None => format!("a finite number in {}", factor.unit()),
                };
                let name = &factor.name;
                return refused(format!("{at}: column {column} (`{name}`): expected {expected}, not {cell}"));
            }
            columns[*factor].copy_from_slice(cells);
        }
        self.read += count as u64;
        Ok(count)
    }
}
