//! The columns of a file of outputs, and the model they are the outputs of.

use std::sync::Arc;

use apportion::model::{Output, OutputSeries};
use apportion::names::{refused_output_name, shown};
use apportion::quantity::Unit;
use apportion::space::Space;
use apportion::study::{ExternalSubject, Study, Subject};

use super::AnswersRequest;
use crate::exchange::design_rows::factor_column;
use crate::exchange::error::{TableError, refused};
use crate::exchange::table::column_of;
use crate::exchange::{ColumnKind, RowReader};

/// The roles of the columns of the file.
pub(super) struct Columns {
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
pub(super) fn subject(
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
