//! The tables `[[dependence]]`: factors that depend on each other.

use apportion::space::{CorrelationMeasure, Dependence, Space};

use super::analysis::place;
use super::context::{Context, Fault, choice, wrong};
use super::measured;
use super::sections::{At, Correlation, DependenceSection, NameList, StudyFile};

/// Returns the dependences of `file`.
pub(super) fn dependences(context: &Context<'_>, file: &StudyFile, space: &Space) -> Result<Vec<Dependence>, Fault> {
    file.dependence.iter().map(|section| dependence(context, section, space)).collect()
}

fn dependence(context: &Context<'_>, section: &At<DependenceSection>, space: &Space) -> Result<Dependence, Fault> {
    let DependenceSection { factors, correlation, measure, .. } = section.get_ref();
    let names = factor_names(context, factors, space)?;
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
                    let row = |i: usize| (0..names.len()).map(|j| if i == j { 1.0 } else { *r }).collect();
                    (0..names.len()).map(row).collect()
                }
            };
            Ok(Dependence::new(&names, matrix).measure(measure))
        }
        (None, Some(columns)) => Ok(Dependence::from_measurements(&names, &columns)),
        (_, measured) => {
            let expected = "a table with `factors` and exactly one of `correlation` (as in correlation = 0.6), `file` and `measurements`";
            let found = if measured.is_some() { "one with both" } else { "one with neither" };
            context.refuse(section, "dependence", expected, found.to_owned())
        }
    }
}

/// Returns the joint measurements of a dependence, a column for each of its factors; `None` if it has none.
fn measured_columns(context: &Context<'_>, section: &DependenceSection) -> Result<Option<Vec<Vec<f64>>>, Fault> {
    let names = section.factors.get_ref();
    let (columns, span) = match (&section.file, &section.measurements) {
        (Some(file), None) => {
            let column = |name: &At<String>| Ok(measured::read(context, file, Some(name))?.0);
            (names.iter().map(column).collect::<Result<Vec<Vec<f64>>, Fault>>()?, file.span())
        }
        (None, Some(rows)) => {
            if rows.get_ref().iter().any(|row| row.len() != names.len() || row.iter().any(|x| !x.is_finite())) {
                let expected = "lists of one finite number for each of `factors`";
                return context.refuse(rows, "measurements", expected, "others among them".to_owned());
            }
            let column = |place: usize| rows.get_ref().iter().map(|row| row[place]).collect();
            ((0..names.len()).map(column).collect(), rows.span())
        }
        (Some(_), Some(rows)) => {
            let expected = "either `file` or `measurements`";
            return context.refuse(rows, "measurements", expected, "both".to_owned());
        }
        (None, None) => return Ok(None),
    };
    let fewest = columns.iter().map(Vec::len).min().unwrap_or(0);
    if fewest < MIN_MEASUREMENTS {
        let expected = format!("at least {MIN_MEASUREMENTS} joint measurements");
        return Err(context.fault(span, wrong("measurements", &expected, fewest.to_string())));
    }
    Ok(Some(columns))
}

/// Minimum number of joint measurements: fewer say nothing of a correlation.
const MIN_MEASUREMENTS: usize = 4;

fn factor_names<'a>(context: &Context<'_>, names: &'a NameList, space: &Space) -> Result<Vec<&'a str>, Fault> {
    let name = |name: &'a At<String>| place(context, name, space).map(|_| name.get_ref().as_str());
    names.get_ref().iter().map(name).collect()
}
