//! The tables `[[dependence]]`: factors that depend on each other.

use apportion::space::{CorrelationMeasure, Dependence, Space};

use super::analysis::factor_index;
use super::at::At;
use super::context::{Context, Fault, choice, wrong};
use super::measured::read_measured;
use super::reading::Reading;
use super::sections::{Correlation, DependenceSection};

/// Returns the dependences of `file`.
pub(super) fn dependences(Reading { context, file, .. }: &Reading, space: &Space) -> Result<Vec<Dependence>, Fault> {
    file.dependence.iter().map(|section| dependence(context, section, space)).collect()
}

fn dependence(context: &Context, section: &At<DependenceSection>, space: &Space) -> Result<Dependence, Fault> {
    let DependenceSection { factors, correlation, measure, .. } = section.get_ref();
    let mut names = Vec::new();
    for name in factors.get_ref() {
        factor_index(context, name, space)?;
        names.push(name.get_ref().as_str());
    }
    let measured = measured_columns(context, section.get_ref())?;
    let measure = match measure {
        None => CorrelationMeasure::default(),
        Some(measure) if measured.is_some() => {
            let expected = "\"normal\" with joint measurements: their correlations are those of normal scores";
            return context.refuse(measure, "measure", expected, format!("{:?}", measure.get_ref()));
        }
        Some(name) => choice(context, name, "measure of correlation")?,
    };
    match (correlation, measured) {
        (Some(correlation), None) => {
            let matrix = match correlation.get_ref() {
                Correlation::Matrix(matrix) => matrix.clone(),
                Correlation::Pairs(r) => {
                    let mut matrix = vec![vec![*r; names.len()]; names.len()];
                    for (i, row) in matrix.iter_mut().enumerate() {
                        row[i] = 1.0;
                    }
                    matrix
                }
            };
            Ok(Dependence::new(&names, matrix).measure(measure))
        }
        (None, Some(columns)) => Ok(Dependence::from_measurements(&names, &columns)),
        (_, measured) => {
            let expected = "a table with `factors` and exactly one of `correlation` (as in correlation = 0.6), `file` and `measurements`";
            let keys = if measured.is_some() { "one with both" } else { "one with neither" };
            context.refuse(section, "dependence", expected, keys)
        }
    }
}

/// Returns the joint measurements of a dependence, a column for each of its factors; `None` if it has none.
fn measured_columns(context: &Context, section: &DependenceSection) -> Result<Option<Vec<Vec<f64>>>, Fault> {
    let names = section.factors.get_ref();
    let mut columns = Vec::with_capacity(names.len());
    let span = match (&section.file, &section.measurements) {
        (Some(file), None) => {
            for name in names {
                columns.push(read_measured(context, file, Some(name))?.0);
            }
            file.span()
        }
        (None, Some(rows)) => {
            if rows.get_ref().iter().any(|row| row.len() != names.len() || row.iter().any(|x| !x.is_finite())) {
                let expected = "lists of one finite number for each of `factors`";
                return context.refuse(rows, "measurements", expected, "others among them");
            }
            columns.extend((0..names.len()).map(|place| rows.get_ref().iter().map(|row| row[place]).collect()));
            rows.span()
        }
        (Some(_), Some(rows)) => {
            let expected = "either `file` or `measurements`";
            return context.refuse(rows, "measurements", expected, "both");
        }
        (None, None) => return Ok(None),
    };
    let count = columns.iter().map(Vec::len).min().unwrap_or(0);
    if count < MIN_MEASUREMENTS {
        let expected = format!("at least {MIN_MEASUREMENTS} joint measurements");
        return Err(context.fault(span, wrong("measurements", &expected, count)));
    }
    Ok(Some(columns))
}

/// Minimum number of joint measurements: fewer say nothing of a correlation.
const MIN_MEASUREMENTS: usize = 4;
