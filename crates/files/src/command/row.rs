//! A row of factor values as text, in the units of the study.

use std::fmt::Write;

use apportion::quantity::Unit;
use apportion::space::Factor;

use super::protocol::Protocol;
use crate::exchange::{ColumnKind, factor_column};

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
    let column = |factor: &Factor| {
        let mut kind = factor_column(factor);
        kind.name = quoted(&kind.name);
        // `true` and `false` are values in JSON.
        if factor.distribution().name() != "boolean" {
            kind.labels.iter_mut().for_each(|(label, _)| *label = quoted(label));
        }
        Column { kind, unit: factor.unit().clone() }
    };
    factors.iter().map(column).collect()
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
    let cell = |(column, values): (&Column, &&[f64])| {
        let mut cell = String::new();
        column.write(values[row], &mut cell);
        in_csv(&cell)
    };
    let cells: Vec<String> = columns.iter().zip(inputs).map(cell).collect();
    let names: Vec<String> = columns.iter().map(|column| in_csv(&column.kind.name)).collect();
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
