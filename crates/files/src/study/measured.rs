//! `file = "measured.csv"`: the measured values of a factor.

use apportion::digest::sha256;
use apportion::files::read_whole;
use apportion::space::distribution::MeasuredFile;

use super::at::At;
use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::paths::{Reach, resolve};

/// Reads one column of numbers from a CSV file, whose path is relative to the study file: the column of that name, or
/// the only one. A file whose first line is a number has no header. Empty lines are skipped.
pub(super) fn read(
    context: &Context<'_>,
    file: &At<String>,
    column: Option<&At<String>>,
) -> Result<(Vec<f64>, MeasuredFile), Fault> {
    let path = resolve(context, file, Reach::Anywhere)?;
    let wrong = |line: Option<usize>, reason: String| {
        let place = line.map_or_else(|| path.display().to_string(), |line| format!("{}:{line}", path.display()));
        let help = "the file must be a CSV table, or have one number per line; its path is relative to the study";
        context.fault(file.span(), Problem::with_help(format!("{place}: {reason}"), help))
    };
    let bytes = read_whole(&path).map_err(|error| wrong(None, format!("cannot read the measured values: {error}")))?;
    let text = std::str::from_utf8(&bytes).map_err(|_| wrong(None, "the file is not text in UTF-8".to_owned()))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    let Some((first, header)) = lines.peek().map(|(number, line)| (number + 1, cells(line))) else {
        return Err(wrong(None, "the file is empty".to_owned()));
    };
    let is_bare = header.len() == 1 && number(&header[0]).is_some();
    let place = match column {
        Some(column) => header.iter().position(|name| name == column.get_ref()).ok_or_else(|| {
            let names = header.iter().map(String::as_str);
            context.fault(column.span(), unknown_name("column", column.get_ref(), names))
        })?,
        None if header.len() > 1 => {
            let reason = format!("there are several columns: name one, as in column = \"{}\"", header[0]);
            return Err(wrong(Some(first), reason));
        }
        None => 0,
    };
    if column.is_some() || !is_bare {
        lines.next();
    }
    let mut values = Vec::new();
    for (index, line) in lines {
        let cells = cells(line);
        let expected = format!("expected {} cells as in the first line, not {}", header.len(), cells.len());
        let cell = cells.get(place).filter(|_| cells.len() == header.len());
        let cell = cell.ok_or_else(|| wrong(Some(index + 1), expected))?;
        let value = number(cell);
        values.push(value.ok_or_else(|| wrong(Some(index + 1), format!("expected a finite number, not {cell:?}")))?);
    }
    if values.is_empty() {
        return Err(wrong(Some(first), "there are no values after the header".to_owned()));
    }
    let sha256 = sha256(&bytes);
    let source = MeasuredFile { file: file.get_ref().clone(), column: column.map(|c| c.get_ref().clone()), sha256 };
    Ok((values, source))
}

/// Splits one line of CSV into cells.
fn cells(line: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .buffer_capacity(line.len() + 2)
        .from_reader(line.as_bytes());
    let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
    record.iter().map(str::to_owned).collect()
}

fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|value: &f64| value.is_finite())
}
