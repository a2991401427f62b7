//! The tables `[[dependence]]`: factors that depend on each other; and files of measured values.

use apportion::space::distribution::MeasuredFile;
use apportion::space::{CorrelationMeasure, Dependence, Space};
use apportion_base::digest::sha256;
use apportion_base::files::read_whole;

use super::analysis::place;
use super::context::{Context, Fault, Reach, choice, resolve, unknown_name, wrong};
use super::error::Problem;
use super::sections::{At, Correlation, DependenceSection, NameList, StudyFile};
use crate::exchange::{ColumnKind, ReadOptions, number, table_of_bytes};

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
            let column = |name: &At<String>| Ok(read_measured(context, file, Some(name))?.0);
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

/// Reads one column of numbers from a table, whose path is relative to the study file: the column of that name, or the
/// only one. A text whose first line is a number has no header.
pub(super) fn read_measured(
    context: &Context<'_>,
    file: &At<String>,
    column: Option<&At<String>>,
) -> Result<(Vec<f64>, MeasuredFile), Fault> {
    let path = resolve(context, file, Reach::Anywhere)?;
    let wrong = |reason: &dyn std::fmt::Display| {
        let help = "the file must be a CSV table, or have one number per line; its path is relative to the study";
        context.fault(file.span(), Problem::with_help(format!("{}: {reason}", path.display()), help))
    };
    let bytes = read_whole(&path).map_err(|error| wrong(&format!("cannot read the measured values: {error}")))?;
    let sha256 = sha256(&bytes);
    let is_number = |text: &str| {
        text.trim_start_matches('\u{feff}').trim_start().lines().next().and_then(|line| number(line.trim())).is_some()
    };
    let no_header = std::str::from_utf8(&bytes).is_ok_and(is_number);
    let options = ReadOptions { no_header, ..ReadOptions::default() };
    let mut reader = table_of_bytes(bytes, &options).map_err(|error| wrong(&error))?;
    let names = reader.names().map(<[String]>::to_vec).unwrap_or_default();
    let place = match (column, &names[..]) {
        (Some(column), names) => names.iter().position(|name| name == column.get_ref()).ok_or_else(|| {
            let names = names.iter().map(String::as_str);
            context.fault(column.span(), unknown_name("column", column.get_ref(), names))
        })?,
        (None, [first, _, ..]) => {
            return Err(wrong(&format!("there are several columns: name one, as in column = \"{first}\"")));
        }
        (None, _) => 0,
    };
    let wanted = [(place, ColumnKind::numbers(names.get(place).map_or("", String::as_str)))];
    let (mut values, mut cells) = (Vec::new(), [Vec::new()]);
    while reader.read(&wanted, BLOCK, &mut cells).map_err(|error| wrong(&error))? > 0 {
        if let Some(row) = cells[0].iter().position(|value| !value.is_finite()) {
            let line = reader.line(row).unwrap_or_default();
            return Err(wrong(&format!("line {line}: expected a finite number, not {}", cells[0][row])));
        }
        values.append(&mut cells[0]);
    }
    if values.is_empty() {
        return Err(wrong(&"there are no values after the header"));
    }
    let source = MeasuredFile { file: file.get_ref().clone(), column: column.map(|c| c.get_ref().clone()), sha256 };
    Ok((values, source))
}

/// Rows read at a time.
const BLOCK: usize = 1 << 12;
