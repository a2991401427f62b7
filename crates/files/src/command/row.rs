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

#[cfg(test)]
mod tests {
    use apportion::space::Distribution;

    use super::*;

    fn factors() -> Vec<Factor> {
        let labels = ["steel", "glass, thin"];
        let factor = |name: &str, unit: &str, law: Result<Distribution, _>| {
            Factor::new(name, Unit::parse(unit).unwrap(), law.unwrap()).unwrap()
        };
        vec![
            factor("length", "um", Distribution::uniform(1.0, 300.0)),
            factor("n", "", Distribution::integer(1.0, 5.0)),
            factor("made of", "", Distribution::categorical(&labels, None, None)),
            factor("wet", "", Distribution::boolean(0.5)),
        ]
    }

    fn rows(protocol: Protocol) -> String {
        let writer = RowWriter::new(protocol, &factors());
        let mut text = writer.header();
        let inputs: [&[f64]; 4] = [&[225e-6, 1e-13], &[3.0, 4.0], &[0.0, 1.0], &[1.0, 0.0]];
        writer.write(&inputs, 0, 100_000, &mut text);
        writer.write(&inputs, 1, 100_001, &mut text);
        text
    }

    #[test]
    fn rows_are_in_the_units_of_the_study_with_labels() {
        assert_eq!(
            rows(Protocol::Csv),
            "id,length,n,made of,wet\n100000,225.0,3,steel,true\n100001,1e-7,4,\"glass, thin\",false\n"
        );
        assert_eq!(
            rows(Protocol::JsonLines),
            "{\"id\":100000,\"length\":225.0,\"n\":3,\"made of\":\"steel\",\"wet\":true}\n\
             {\"id\":100001,\"length\":1e-7,\"n\":4,\"made of\":\"glass, thin\",\"wet\":false}\n"
        );
        let (mut text, columns) = (String::new(), columns(&factors(), &str::to_owned));
        columns[2].write(1.0, &mut text);
        assert_eq!(text, "glass, thin");
        let inputs: [&[f64]; 4] = [&[1e-13], &[4.0], &[1.0], &[0.0]];
        assert_eq!(table(&columns, &inputs, 0), "length,n,made of,wet\n1e-7,4,\"glass, thin\",false\n");
    }

    proptest::proptest! {
        #[test]
        fn numbers_are_read_as_the_same(value in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL) {
            let factor = Factor::new("x", Unit::dimensionless(), Distribution::uniform(0.0, 1.0).unwrap()).unwrap();
            for protocol in Protocol::ALL {
                let mut text = String::new();
                RowWriter::new(protocol, std::slice::from_ref(&factor)).write(&[&[value]], 0, 0, &mut text);
                let number = text.trim().trim_start_matches("{\"id\":0,\"x\":").trim_start_matches("0,").trim_end_matches('}');
                proptest::prop_assert_eq!(number.parse::<f64>().unwrap().to_bits(), value.to_bits());
            }
        }
    }
}
