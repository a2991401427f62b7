//! `file = "measured.csv"`: the measured values of a factor.

use apportion::digest::sha256;
use apportion::files::read_whole;
use apportion::space::distribution::MeasuredFile;

use super::at::At;
use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::paths::{Reach, resolve};
use crate::exchange::{ColumnKind, ReadOptions, number, table_of_bytes};

/// Reads one column of numbers from a table, whose path is relative to the study file: the column of that name, or the
/// only one. A text whose first line is a number has no header.
pub(super) fn read(
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
