//! The outputs of a design from a file, checked against their points, and the model they are the outputs of.

use std::sync::Arc;

use apportion::model::{Output, OutputSeries, RowFailure};
use apportion::run::{RowBlock, Store};
use apportion::space::{Factor, Space};
use apportion::study::{ExternalSubject, Study, Subject};
use apportion_base::digest::Sha256;
use apportion_base::names::{refused_output_name, shown};
use apportion_base::quantity::{Unit, is_same};

use super::counter::{is_called_counter, read_numbered};
use super::design_rows::{Points, add_rows, each_block, factor_column};
use super::error::{TableError, refused};
use super::manifest::Manifest;
use super::rows::{ColumnKind, RowReader};
use super::table::{Missing, column_of};

/// The request for a file of outputs.
#[derive(Debug, Clone, Copy)]
pub struct AnswersRequest<'a> {
    /// The manifest of the design.
    pub manifest: &'a Manifest,
    /// Output columns; empty for those of the study if present, or else for all that are not factors.
    pub outputs: &'a [String],
    /// Units of outputs, by column; others have the study's unit, or none.
    pub units: &'a [(String, Unit)],
    /// How rows without a finite output are treated: those that are dropped count as runs that failed.
    pub missing: Missing,
}

/// The outputs of all rows of a design.
#[derive(Debug)]
pub struct Answers {
    /// The study: that of the manifest, with an external model unless the outputs are those of its model.
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
    let subject = subject(&study, &columns.outputs, request)?;
    study = study.with_subject(subject);
    let (space, model) = (study.space(), study.model());
    let points = Points::from_study(&study, request.manifest.screening());
    let points = points.map_err(|error| TableError::Refused(error.to_string()))?;
    let store = Store::new(model.as_ref());
    let wanted = columns.wanted(space);
    let total = points.rows();
    let numbered = read_numbered(reader, &wanted, total)?;
    let is_complete = numbered.as_ref().is_none_or(|rows| rows.missing == 0);
    let missing = if is_complete { request.missing } else { Missing::Drop };
    let (mut cells, mut digest, mut row) = (vec![Vec::new(); wanted.len()], Sha256::default(), 0);
    each_block(space, &points, |replicate, rows, points| {
        add_rows(&mut digest, points);
        let expected = (rows.end - rows.start) as usize;
        let count = match &numbered {
            None => reader.read(&wanted, expected, &mut cells)?,
            Some(all) => {
                let rows = row as usize..row as usize + expected;
                cells = all.columns.iter().map(|column| column[rows.clone()].to_vec()).collect();
                expected
            }
        };
        let (answers, points_in_file) = cells.split_at(columns.outputs.len());
        for place in 0..count {
            for ((_, factor), values) in columns.factors.iter().zip(points_in_file) {
                let is_there = is_complete || !values[place].is_nan();
                if is_there {
                    compare(&space.factors()[*factor], values[place], points[*factor][place], row + place as u64 + 1)?;
                }
            }
        }
        row += count as u64;
        if count < expected {
            return refused(format!("the file has {row} rows, but the design has {total}"));
        }
        let mut block = RowBlock { replicate, first: rows.start, ..RowBlock::default() };
        fill(&mut block, model.outputs(), answers, missing, row - count as u64)?;
        store.insert(block);
        Ok(())
    })?;
    if numbered.is_none() && reader.read(&wanted, 1, &mut cells)? > 0 {
        return refused(format!("the file has more rows than the design, which has {total}"));
    }
    // Values that agree to ten digits may still belong to another version: those of the study are used.
    request.manifest.check_points(&digest.finish())?;
    let compared = columns.factors.iter().map(|&(_, factor)| space.factors()[factor].name.clone()).collect();
    let flags = model.flags().iter().any(|flag| !flag.warns) && !study.subject().is_external();
    drop((model, points));
    if let Some(rows) = numbered {
        study.note(format!("the rows of the file are in the order of its column `{}`", rows.name));
        if rows.missing > 0 {
            study.note(format!(
                "{} rows of the design are not in the file: they count as runs that failed",
                rows.missing
            ));
        }
    }
    if flags {
        study.note("the file has no validity flags of the model: none are counted".to_owned());
    }
    Ok(Answers { study, store, compared })
}

/// Fills in the outputs of a block, which follows `before` rows.
fn fill(
    block: &mut RowBlock,
    outputs: &[Output],
    answers: &[Vec<f64>],
    missing: Missing,
    before: u64,
) -> Result<(), TableError> {
    let reason = RowFailure::new("the file of outputs has no finite number for it");
    for row in 0..answers.first().map_or(0, Vec::len) {
        for (number, (column, output)) in answers.iter().zip(outputs).enumerate() {
            let si = output.unit.to_si(column[row]);
            if !si.is_finite() {
                if missing == Missing::Refuse {
                    let what = match column[row].is_nan() {
                        true => "the value is missing".to_owned(),
                        false => format!("{} is not a finite number", column[row]),
                    };
                    let (row, name) = (before + row as u64 + 1, &output.name);
                    return refused(format!(
                        "row {row}, column `{name}`: {what}; --missing-as-failed counts such rows as runs that failed"
                    ));
                }
                block.failures.push((row as u32, number as u32, reason.clone()));
            }
            block.values.push(if si.is_finite() { si } else { f64::NAN });
        }
    }
    Ok(())
}

/// Checks that the value of a factor in a row of the file is that of the design.
fn compare(factor: &Factor, value: f64, expected: f64, row: u64) -> Result<(), TableError> {
    if is_same(value, expected) {
        return Ok(());
    }
    let [found, expected] = [value, expected].map(|value| match value.is_nan() {
        true => "an empty cell".to_owned(),
        false => factor.in_words(value, |number| number.to_string()),
    });
    let name = &factor.name;
    refused(format!(
        "row {row}, column `{name}`: found {found}, but the design has {expected}: rows are missing, repeated or in another \
         order, or the points were changed, were printed with less than ten digits, or belong to another design"
    ))
}

/// The roles of the columns of the file.
struct Columns {
    /// Outputs: the column and its name.
    pub outputs: Vec<(usize, String)>,
    /// Factors: the column and the number of the factor.
    pub factors: Vec<(usize, usize)>,
}

impl Columns {
    pub fn find(reader: &dyn RowReader, study: &Study, request: &AnswersRequest<'_>) -> Result<Self, TableError> {
        let stated: Vec<String> = study.model().outputs().iter().map(|output| output.name.to_string()).collect();
        let factors = study.space().factors();
        let Some(names) = reader.names() else {
            let outputs = if request.outputs.is_empty() { stated } else { request.outputs.to_vec() };
            let first = first_output(reader.width(), factors.len(), outputs.len())?;
            let factors = (0..first).map(|place| (place, place)).collect();
            return Ok(Self { outputs: (first..).zip(outputs).collect(), factors });
        };
        let (mut columns, mut others) = (Vec::new(), Vec::new());
        for (place, name) in names.iter().enumerate() {
            match factors.iter().position(|factor| factor.name == *name) {
                Some(factor) => columns.push((place, factor)),
                None => others.push(name.clone()),
            }
        }
        let outputs = match request.outputs {
            [] if study.subject().is_external() || stated.iter().all(|name| others.contains(name)) => stated,
            [] => others.into_iter().filter(|name| !is_called_counter(name)).collect(),
            outputs => outputs.to_vec(),
        };
        let outputs = output_columns(names, &outputs, &|name| factors.iter().any(|factor| factor.name == name))?;
        Ok(Self { outputs, factors: columns })
    }

    /// Returns the columns to read.
    pub fn wanted(&self, space: &Space) -> Vec<(usize, ColumnKind)> {
        let outputs = self.outputs.iter().map(|(place, name)| (*place, ColumnKind::numbers(name)));
        let factors = self.factors.iter().map(|(place, factor)| (*place, factor_column(&space.factors()[*factor])));
        outputs.chain(factors).collect()
    }
}

/// Returns the columns of `outputs`, none of which may be an input or repeated.
///
/// # Errors
/// [`TableError`] if there is none, or one is not among `names`.
fn output_columns(
    names: &[String],
    outputs: &[String],
    is_input: &dyn Fn(&str) -> bool,
) -> Result<Vec<(usize, String)>, TableError> {
    if outputs.is_empty() {
        return refused(format!("the file has no outputs: its columns are the factors {}", names.join(", ")));
    }
    let mut columns: Vec<(usize, String)> = Vec::with_capacity(outputs.len());
    for name in outputs {
        if is_input(name) {
            return refused(format!("`{name}` is a factor, not an output"));
        }
        if columns.iter().any(|(_, other)| other == name) {
            return refused(format!("`{name}` is listed twice as an output"));
        }
        columns.push((column_of(names, name)?, name.clone()));
    }
    Ok(columns)
}

/// Returns the first column that is an output in a file without column names.
///
/// # Errors
/// [`TableError`] if it holds neither only the outputs nor the factors before them.
fn first_output(width: usize, factors: usize, outputs: usize) -> Result<usize, TableError> {
    match width.checked_sub(outputs) {
        Some(before) if outputs > 0 && (before == 0 || before == factors) => Ok(before),
        _ => refused(format!(
            "the file has {width} columns, without names: expected {outputs} (the outputs) or {} (the {factors} factors, then \
             the outputs)",
            factors + outputs
        )),
    }
}

/// Returns the study's model if the outputs are its outputs, else an external model with these outputs.
fn subject(
    study: &Study,
    columns: &[(usize, String)],
    request: &AnswersRequest<'_>,
) -> Result<Arc<dyn Subject>, TableError> {
    let model = study.model();
    let stated = model.outputs();
    let names: Vec<&str> = columns.iter().map(|(_, name)| name.as_str()).collect();
    if let Some((name, _)) = request.units.iter().find(|(name, _)| !names.contains(&name.as_str())) {
        let outputs = names.join(", ");
        return refused(format!("a unit is given for `{name}`, which is not an output; the outputs are {outputs}"));
    }
    for name in &names {
        if let Some(expected) = refused_output_name(name) {
            return refused(format!("the name {} of an output: expected {expected}", shown(name)));
        }
    }
    if request.units.is_empty() && stated.iter().map(|output| &*output.name).eq(names.iter().copied()) {
        return Ok(study.subject().clone());
    }
    let (mut outputs, mut places) = (Vec::new(), Vec::new());
    for name in names {
        let place = stated.iter().position(|output| *output.name == *name);
        let stated = place.map(|place| &stated[place].unit);
        let unit = request.units.iter().find(|(output, _)| output == name).map(|(_, unit)| unit);
        if let (Some(unit), Some(stated)) = (unit, stated)
            && stated.is_of_kind()
            && !stated.compatible(unit)
        {
            let kind = if unit.is_label() { "is unknown".to_owned() } else { format!("measures {}", unit.dimension()) };
            return refused(format!(
                "the unit `{unit}` is given for `{name}`, and {kind}: the study says `{stated}`, so expected a unit of the \
                 same kind ({})",
                stated.dimension()
            ));
        }
        let unit = unit.or(stated).cloned().unwrap_or_else(Unit::dimensionless);
        outputs.push(Output::new(name.to_owned(), unit, "read from a file"));
        places.push(place.unwrap_or(usize::MAX));
    }
    // The study's series that are complete in the file stay series, even in other units.
    let series = OutputSeries::chosen(model.series(), &places);
    Ok(Arc::new(ExternalSubject { outputs, series }))
}
