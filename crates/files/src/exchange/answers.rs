//! The outputs of a design from a file, checked against their points, and the model they are the outputs of.

use std::sync::Arc;

use apportion::model::{Output, OutputSeries, RowFailure};
use apportion::run::{RowBlock, Store};
use apportion::space::{Factor, Space};
use apportion::study::{ExternalSubject, Study, Subject};
use apportion_base::digest::Sha256;
use apportion_base::names::{refused_output_name, shown};
use apportion_base::quantity::{Unit, is_same};

use super::design_rows::{add_rows, each_block, factor_column};
use super::error::{TableError, refused};
use super::manifest::Manifest;
use super::rows::{ColumnKind, RowReader};
use super::table::{Missing, column_of};

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
    let (space, design, model) = (study.space(), study.design(), study.model());
    let store = Store::new(model.as_ref());
    let wanted = columns.wanted(space);
    let (mut cells, mut digest, mut row) = (vec![Vec::new(); wanted.len()], Sha256::default(), 0);
    each_block(space, design, |replicate, rows, points| {
        add_rows(&mut digest, points);
        let expected = (rows.end - rows.start) as usize;
        let count = reader.read(&wanted, expected, &mut cells)?;
        let (answers, found) = cells.split_at(columns.outputs.len());
        let pairs = columns.factors.iter().zip(found);
        let pairs = pairs.map(|((_, factor), found)| (&space.factors()[*factor], &found[..count], &points[*factor]));
        compare(pairs.collect(), row)?;
        row += count as u64;
        if count < expected {
            return refused(format!("the file has {row} rows, but the design has {}", design.rows()));
        }
        let mut block = RowBlock { replicate, first: rows.start, ..RowBlock::default() };
        fill(&mut block, model.outputs(), answers, request.missing, row - count as u64)?;
        store.insert(&block);
        Ok(())
    })?;
    if reader.read(&wanted, 1, &mut cells)? > 0 {
        return refused(format!("the file has more rows than the design, which has {}", design.rows()));
    }
    // Values that agree to ten digits may still belong to another version: those of the study are used.
    request.manifest.check_points(&digest.finish())?;
    let compared = columns.factors.iter().map(|&(_, factor)| space.factors()[factor].name.clone()).collect();
    if model.flags().iter().any(|flag| !flag.warns) && !study.subject().is_external() {
        let note = "the file has no validity flags of the model: none are counted".to_owned();
        drop(model);
        study.note(note);
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
                    let what = match column[row] {
                        found if found.is_nan() => "the value is missing".to_owned(),
                        found => format!("{found} is not a finite number"),
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

/// Checks that the values found of some factors are those of the design, in a block that follows `before` rows.
fn compare(factors: Vec<(&Factor, &[f64], &Vec<f64>)>, before: u64) -> Result<(), TableError> {
    let rows = factors.first().map_or(0, |(_, found, _)| found.len());
    let differs = |row: usize| factors.iter().find(|(_, found, points)| !is_same(found[row], points[row]));
    let Some((row, (factor, found, points))) = (0..rows).find_map(|row| Some((row, differs(row)?))) else {
        return Ok(());
    };
    let words = |value: f64| match value.is_nan() {
        true => "an empty cell".to_owned(),
        false => factor.in_words(value, |number| number.to_string()),
    };
    let (found, expected) = (words(found[row]), words(points[row]));
    let (row, name) = (before + row as u64 + 1, &factor.name);
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
        let own: Vec<String> = study.model().outputs().iter().map(|output| output.name.to_string()).collect();
        let factors = study.space().factors();
        let Some(names) = reader.names() else {
            let outputs = if request.outputs.is_empty() { own } else { request.outputs.to_vec() };
            let first = first_output(reader.width(), factors.len(), outputs.len())?;
            let factors = (0..first).map(|place| (place, place)).collect();
            return Ok(Self { outputs: (first..).zip(outputs).collect(), factors });
        };
        let is_factor = |name: &str| factors.iter().position(|factor| factor.name == name);
        let own_are_there = own.iter().all(|name| names.contains(name) && is_factor(name).is_none());
        let asked = match request.outputs {
            [] if own_are_there || study.subject().is_external() => own,
            [] => names.iter().filter(|name| is_factor(name).is_none()).cloned().collect(),
            asked => asked.to_vec(),
        };
        let outputs = output_columns(names, &asked, &|name| is_factor(name).is_some())?;
        let factors = names.iter().enumerate().filter_map(|(place, name)| Some((place, is_factor(name)?))).collect();
        Ok(Self { outputs, factors })
    }

    /// Returns the columns to read.
    pub fn wanted(&self, space: &Space) -> Vec<(usize, ColumnKind)> {
        let outputs = self.outputs.iter().map(|(place, name)| (*place, ColumnKind::numbers(name)));
        let factors = self.factors.iter().map(|(place, factor)| (*place, factor_column(&space.factors()[*factor])));
        outputs.chain(factors).collect()
    }
}

/// Returns the columns of the outputs `asked`, none of which may be an input or repeated.
///
/// # Errors
/// [`TableError`] if there is none, or one is not among `names`.
pub fn output_columns(
    names: &[String],
    asked: &[String],
    is_input: &dyn Fn(&str) -> bool,
) -> Result<Vec<(usize, String)>, TableError> {
    if asked.is_empty() {
        let known = names.join(", ");
        return refused(format!("the file has no outputs: its columns are the factors {known}"));
    }
    let column = |(number, name): (usize, &String)| {
        if is_input(name) || asked[..number].contains(name) {
            let what = if is_input(name) { "is a factor, not an output" } else { "is listed twice as an output" };
            return refused(format!("`{name}` {what}"));
        }
        Ok((column_of(names, name)?, name.clone()))
    };
    asked.iter().enumerate().map(column).collect()
}

/// Returns the first column that is an output in a file without column names.
///
/// # Errors
/// [`TableError`] if it holds neither only the outputs nor the factors before them.
pub fn first_output(width: usize, factors: usize, outputs: usize) -> Result<usize, TableError> {
    match width.checked_sub(outputs) {
        Some(before) if outputs > 0 && (before == 0 || before == factors) => Ok(before),
        _ => refused(format!(
            "the file has {width} columns, without names: expected {outputs} (the outputs) or {} (the {factors} factors, then \
             the outputs)",
            factors + outputs
        )),
    }
}

/// Returns the study's own model if the outputs are its own, else an external model with these outputs.
fn subject(
    study: &Study,
    columns: &[(usize, String)],
    request: &AnswersRequest<'_>,
) -> Result<Arc<dyn Subject>, TableError> {
    let model = study.model();
    let own = model.outputs();
    if let Some((name, _)) = request.units.iter().find(|(name, _)| columns.iter().all(|(_, column)| column != name)) {
        let known = columns.iter().map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ");
        return refused(format!("a unit is given for `{name}`, which is not an output; the outputs are {known}"));
    }
    let wrong = |name: &String| Some((shown(name), refused_output_name(name)?));
    if let Some((name, expected)) = columns.iter().find_map(|(_, name)| wrong(name)) {
        return refused(format!("the name {name} of an output: expected {expected}"));
    }
    let names = columns.iter().map(|(_, name)| name);
    if request.units.is_empty() && names.clone().eq(own.iter().map(|output| &*output.name)) {
        return Ok(study.subject().clone());
    }
    for (name, unit) in request.units {
        let stated = own.iter().find(|output| output.name == *name).map(|output| &output.unit);
        if let Some(own) = stated.filter(|own| own.is_of_kind() && !own.compatible(unit)) {
            let kind = if unit.is_label() { "is unknown".to_owned() } else { format!("measures {}", unit.dimension()) };
            let own_kind = own.dimension();
            return refused(format!(
                "the unit `{unit}` is given for `{name}`, and {kind}: the study says `{own}`, so expected a unit of the same \
                 kind ({own_kind})"
            ));
        }
    }
    let output = |name: &String| {
        let stated = own.iter().find(|output| output.name == *name);
        let unit = request.units.iter().find(|(known, _)| known == name).map(|(_, unit)| unit.clone());
        let unit = unit.or_else(|| stated.map(|output| output.unit.clone())).unwrap_or_else(Unit::dimensionless);
        Output::new(name.clone(), unit, "read from a file")
    };
    // The study's series that are complete in the file stay series, even in other units.
    let place = |name: &String| own.iter().position(|output| output.name == *name).unwrap_or(usize::MAX);
    let places: Vec<usize> = names.clone().map(place).collect();
    let series = OutputSeries::chosen(model.series(), &places);
    Ok(Arc::new(ExternalSubject { outputs: names.map(output).collect(), series }))
}
