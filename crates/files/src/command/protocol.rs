//! The protocol between the engine and a program that is kept alive: lines of text, described in
//! `docs/reference/worker-protocol.md`; and rows of factor values as text, in the units of the study.

use std::fmt::Write;

use apportion::space::Factor;
use apportion_base::names::named;
use apportion_base::quantity::Unit;
use apportion_base::text::{cut, masked};
use serde_json::Value;

use super::json_answer::{Answer, failed, json, json_answer, keys_in_words, number_of_invalid};
use crate::exchange::{ColumnKind, factor_column};

named! {
    /// How rows and replies are written; the default first.
    pub enum Protocol {
        /// A header with the names of the factors, then a line of cells for each row; the reply is a line of numbers.
        Csv = "csv",
        /// A JSON object for each row, and one as the reply.
        JsonLines = "json-lines",
    }
}

/// Reads the line with which a program replies to a row: the number of the row, the first cell in CSV and the key `id`
/// of a JSON object; and one value for each of `outputs` (the number, NaN for an empty cell, `nan` or null, or an
/// infinity), or why the row has none.
///
/// ```
/// use apportion_files::parse_answer;
/// use apportion_files::Protocol;
///
/// let outputs = ["force".to_owned()];
/// assert_eq!(parse_answer(Protocol::Csv, &outputs, b"100003,1.5"), Ok((100_003, Ok(vec![1.5]))));
/// let json = br#"{"id": 100003, "error": "no root"}"#;
/// let json = parse_answer(Protocol::JsonLines, &outputs, json);
/// assert_eq!(json, Ok((100_003, Err("no root".to_owned()))));
/// let stray = parse_answer(Protocol::Csv, &outputs, b"1.5");
/// assert_eq!(stray.unwrap_err(), "expected the row's number and a number, separated by a comma, found `1.5`");
/// ```
///
/// # Errors
/// The expected and the found text, if the line has no row number.
pub fn parse_answer(protocol: Protocol, outputs: &[String], line: &[u8]) -> Result<(u64, Answer), String> {
    let text = match std::str::from_utf8(line).map(str::trim) {
        Ok("") => return Err(unexpected(protocol, outputs, "an empty line")),
        Ok(text) => text,
        Err(_) => return Err(unexpected(protocol, outputs, "a line that is not text in UTF-8")),
    };
    let numbered = match protocol {
        Protocol::Csv => text.split_once(',').and_then(|(number, rest)| {
            Some((row_number(number.trim().trim_matches('"'))?, csv_answer(outputs, rest.trim())))
        }),
        Protocol::JsonLines => {
            let parsed = json(text);
            let number = match parsed.as_ref().map(|parsed| parsed.get("id")) {
                Ok(Some(Value::Number(number))) => row_number(&number.to_string()),
                Ok(Some(Value::String(text))) => row_number(text),
                Ok(_) => None,
                // Such as 1e400, half of a surrogate pair, and too many levels.
                Err(_) => number_of_invalid(text).and_then(row_number),
            };
            number.map(|number| (number, parsed.and_then(|parsed| json_answer(outputs, &parsed))))
        }
    };
    let Some((number, answer)) = numbered else {
        return Err(unexpected(protocol, outputs, &format!("`{}`", cut(text, MAX_LETTERS))));
    };
    let answer =
        answer.unwrap_or_else(|words| Err(format!("not an answer: {}", unexpected(protocol, outputs, &words))));
    Ok((number, answer))
}

/// Returns whether a line would be the reply to a row if it had a row number.
pub(super) fn is_answer_without_number(protocol: Protocol, outputs: &[String], line: &[u8]) -> bool {
    let text = String::from_utf8_lossy(line);
    let text = text.trim();
    let answer = match protocol {
        _ if text.is_empty() => return false,
        Protocol::Csv => csv_answer(outputs, text),
        Protocol::JsonLines => json(text).and_then(|parsed| json_answer(outputs, &parsed)),
    };
    answer.is_ok()
}

/// Maximum number of characters of a line that are shown.
const MAX_LETTERS: usize = 100;

/// Parses a row number as languages write it: `711953`, and also `711953.0` and `7.11953e5`.
fn row_number(text: &str) -> Option<u64> {
    let value: f64 = text.parse().ok()?;
    ((0.0..1e15).contains(&value) && value.fract() == 0.0).then_some(value as u64)
}

/// Describes the expected and the found text of a line.
fn unexpected(protocol: Protocol, outputs: &[String], found: &str) -> String {
    let expected = match (protocol, outputs) {
        (Protocol::Csv, [_]) => "the row's number and a number, separated by a comma".to_owned(),
        (Protocol::Csv, _) => format!("the row's number and {} numbers, separated by commas", outputs.len()),
        (Protocol::JsonLines, _) => format!("a JSON object with id (the row's number), {}", keys_in_words(outputs)),
    };
    format!("expected {expected}, found {found}")
}

/// Parses `text` as a reply; the error describes it if it is not one.
fn csv_answer(outputs: &[String], text: &str) -> Result<Answer, String> {
    if let Some(reason) = text.strip_prefix("error:") {
        return Ok(failed(reason));
    }
    let cells = text.split(',').map(str::trim);
    let values: Option<Vec<f64>> =
        cells.map(|cell| if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() }).collect();
    match values {
        Some(values) if values.len() == outputs.len() => Ok(Ok(values)),
        Some(values) => {
            let (cells, s) = (values.len(), if values.len() == 1 { "" } else { "s" });
            Err(format!("{cells} cell{s}: `{}`", masked(text)))
        }
        None => Err(format!("`{}`", masked(text))),
    }
}

/// The name of the row number.
const ROW_NUMBER: &str = "id";

/// Writes rows as a program reads them. Numbers have the fewest digits that are read as the same `f64`.
pub(super) struct RowWriter {
    protocol: Protocol,
    columns: Vec<Column>,
}

impl RowWriter {
    pub(super) fn new(protocol: Protocol, factors: &[Factor]) -> Self {
        let quoted = match protocol {
            Protocol::Csv => in_csv,
            Protocol::JsonLines => in_json,
        };
        Self { protocol, columns: columns(factors, &quoted) }
    }

    /// Returns the text before the first row.
    pub(super) fn header(&self) -> String {
        match self.protocol {
            Protocol::Csv => format!(
                "{ROW_NUMBER},{}\n",
                self.columns.iter().map(|column| column.kind.name.as_str()).collect::<Vec<_>>().join(",")
            ),
            Protocol::JsonLines => String::new(),
        }
    }

    /// Writes one row of SI values as a line that begins with its number.
    pub(super) fn write(&self, inputs: &[&[f64]], row: usize, number: u64, out: &mut String) {
        let is_json = self.protocol == Protocol::JsonLines;
        out.push_str(&if is_json { format!("{{\"{ROW_NUMBER}\":{number}") } else { number.to_string() });
        for (column, values) in self.columns.iter().zip(inputs) {
            out.push(',');
            if is_json {
                out.push_str(&column.kind.name);
                out.push(':');
            }
            column.write(values[row], out);
        }
        out.push_str(if is_json { "}\n" } else { "\n" });
    }
}

/// A factor as text; its name and its labels are quoted.
pub(super) struct Column {
    kind: ColumnKind,
    unit: Unit,
}

/// Returns the columns of `factors`, with texts as `quoted` writes them.
pub(super) fn columns(factors: &[Factor], quoted: &dyn Fn(&str) -> String) -> Vec<Column> {
    let mut columns = Vec::with_capacity(factors.len());
    for factor in factors {
        let mut kind = factor_column(factor);
        kind.name = quoted(&kind.name);
        // `true` and `false` are values in JSON.
        if factor.distribution().name() != "boolean" {
            for (label, _) in &mut kind.labels {
                *label = quoted(label);
            }
        }
        columns.push(Column { kind, unit: factor.unit().clone() });
    }
    columns
}

impl Column {
    /// Writes an SI value in the unit of the factor.
    pub(super) fn write(&self, si: f64, out: &mut String) {
        let value = self.unit.from_si(si);
        // Writing to a string cannot fail. `{:?}` uses an exponent if the number would be long without one.
        let _ = match self.kind.label(value) {
            Some(label) => out.write_str(label),
            None if self.kind.whole && value.fract() == 0.0 => write!(out, "{value:.0}"),
            None => write!(out, "{value:?}"),
        };
    }
}

/// Formats a row of SI values of `columns` without quotes as a table of CSV with a header.
pub(super) fn table(columns: &[Column], inputs: &[&[f64]], row: usize) -> String {
    let (mut names, mut cells) = (Vec::new(), Vec::new());
    for (column, values) in columns.iter().zip(inputs) {
        let mut cell = String::new();
        column.write(values[row], &mut cell);
        names.push(in_csv(&column.kind.name));
        cells.push(in_csv(&cell));
    }
    format!("{}\n{}\n", names.join(","), cells.join(","))
}

/// Formats a cell of CSV, in quotes if it needs them.
fn in_csv(text: &str) -> String {
    let bare = !text.contains([',', '"', '\n', '\r']) && text.trim() == text && !text.is_empty();
    if bare { text.to_owned() } else { format!("\"{}\"", text.replace('"', "\"\"")) }
}

fn in_json(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
