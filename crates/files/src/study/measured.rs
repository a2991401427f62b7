//! Files of measured values.

use std::fmt::Display;
use std::path::Path;

use apportion::space::distribution::MeasuredFile;
use apportion_base::digest::sha256;
use apportion_base::files::read_whole;

use super::at::At;
use super::context::{Context, Fault, PathScope, resolve, unknown_name};
use super::error::Problem;
use crate::exchange::{ColumnKind, ReadOptions, number, table_of_bytes};

/// Reads one column of numbers from a table, whose path is relative to the study file: the column of that name, or the
/// only one. A text whose first line is a number has no header.
pub(super) fn read_measured(
    context: &Context,
    file: &At<String>,
    column: Option<&At<String>>,
) -> Result<(Vec<f64>, MeasuredFile), Fault> {
    let path = resolve(context, file, PathScope::Anywhere)?;
    let bytes = read_whole(&path)
        .map_err(|error| unusable(context, file, &path, &format!("cannot read the measured values: {error}")))?;
    context.measured.borrow_mut().push(path.clone());
    let sha256 = sha256(&bytes);
    let options = ReadOptions { no_header: begins_with_number(&bytes), ..ReadOptions::default() };
    let mut reader = table_of_bytes(bytes, &options).map_err(|error| unusable(context, file, &path, &error))?;
    let names = reader.names().map(<[String]>::to_vec).unwrap_or_default();
    let place = match (column, &names[..]) {
        (Some(column), names) => {
            let place = names
                .iter()
                .position(|name| name == column.get_ref())
                .ok_or_else(|| unknown_name("column", column.get_ref(), names.iter().map(String::as_str)));
            context.at(column, place)?
        }
        (None, [first, _, ..]) => {
            let reason = format!("there are several columns: name one, as in column = \"{first}\"");
            return Err(unusable(context, file, &path, &reason));
        }
        (None, _) => 0,
    };
    let wanted = [(place, ColumnKind::numbers(names.get(place).map_or("", String::as_str)))];
    let (mut values, mut cells) = (Vec::new(), [Vec::new()]);
    while reader.read(&wanted, BLOCK, &mut cells).map_err(|error| unusable(context, file, &path, &error))? > 0 {
        if let Some(row) = cells[0].iter().position(|value| !value.is_finite()) {
            let line = reader.line(row).unwrap_or_default();
            let reason = format!("line {line}: expected a finite number, not {}", cells[0][row]);
            return Err(unusable(context, file, &path, &reason));
        }
        values.append(&mut cells[0]);
    }
    if values.is_empty() {
        return Err(unusable(context, file, &path, &"there are no values after the header"));
    }
    let source = MeasuredFile { file: file.get_ref().clone(), column: column.map(|c| c.get_ref().clone()), sha256 };
    Ok((values, source))
}

fn unusable(context: &Context, file: &At<String>, path: &Path, reason: &dyn Display) -> Fault {
    let help = "the file must be a CSV table, or have one number per line; its path is relative to the study";
    context.fault(file.span(), Problem::with_help(format!("{}: {reason}", path.display()), help))
}

/// Returns whether the first line of a text is a number.
fn begins_with_number(bytes: &[u8]) -> bool {
    let text = std::str::from_utf8(bytes).unwrap_or_default().trim_start_matches('\u{feff}').trim_start();
    text.lines().next().is_some_and(|line| number(line.trim()).is_some())
}

/// Rows read at a time.
const BLOCK: usize = 1 << 12;
