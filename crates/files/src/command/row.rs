//! A row of factor values as text, in the units of the study.

use std::fmt::Write;

use apportion::quantity::Unit;
use apportion::space::{Distribution, Factor};

use super::protocol::Protocol;

/// Writes rows as a program reads them. Numbers have the fewest digits that are read as the same `f64`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowWriter {
    protocol: Protocol,
    columns: Vec<Column>,
}

#[derive(Debug, Clone, PartialEq)]
struct Column {
    name: String,
    unit: Unit,
    cells: Cells,
}

#[derive(Debug, Clone, PartialEq)]
enum Cells {
    Numbers,
    WholeNumbers,
    /// Each value with the label that is written instead.
    Labels(Vec<(f64, String)>),
}

/// The name of the row number.
pub(super) const ROW_NUMBER: &str = "id";

impl RowWriter {
    pub(super) fn new(protocol: Protocol, factors: &[Factor]) -> Self {
        let quoted = |text: &str| match protocol {
            Protocol::Csv => in_csv(text),
            Protocol::JsonLines => in_json(text),
        };
        let columns = factors.iter().map(|factor| Column::new(factor, &quoted)).collect();
        Self { protocol, columns }
    }

    /// Returns the text before the first row.
    pub(super) fn header(&self) -> String {
        match self.protocol {
            Protocol::Csv => {
                let names = self.columns.iter().map(|column| column.name.as_str());
                let names: Vec<&str> = std::iter::once(ROW_NUMBER).chain(names).collect();
                names.join(",") + "\n"
            }
            Protocol::JsonLines => String::new(),
        }
    }

    /// Writes one row of SI values as a line that begins with its number.
    pub(super) fn write(&self, inputs: &[&[f64]], row: usize, number: u64, out: &mut String) {
        let (open, close) = if self.protocol == Protocol::JsonLines { ("{", "}\n") } else { ("", "\n") };
        out.push_str(open);
        // Writing to a string cannot fail.
        let _ = match self.protocol {
            Protocol::Csv => write!(out, "{number}"),
            Protocol::JsonLines => write!(out, "\"{ROW_NUMBER}\":{number}"),
        };
        for (column, values) in self.columns.iter().zip(inputs) {
            out.push(',');
            if self.protocol == Protocol::JsonLines {
                out.push_str(&column.name);
                out.push(':');
            }
            column.write(values[row], out);
        }
        out.push_str(close);
    }
}

/// Writes single values into texts, labels without quotes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValueWriter(Vec<Column>);

impl ValueWriter {
    pub(super) fn new(factors: &[Factor]) -> Self {
        Self(factors.iter().map(|factor| Column::new(factor, &str::to_owned)).collect())
    }

    /// Writes a row of SI values as a table of CSV with a header.
    pub(super) fn table(&self, inputs: &[&[f64]], row: usize) -> String {
        let values = self.0.iter().zip(inputs).map(|(column, values)| {
            let mut cell = String::new();
            column.write(values[row], &mut cell);
            in_csv(&cell)
        });
        let names = self.0.iter().map(|column| in_csv(&column.name));
        format!("{}\n{}\n", names.collect::<Vec<_>>().join(","), values.collect::<Vec<_>>().join(","))
    }

    /// Writes the SI value of the factor of that number.
    pub(super) fn write(&self, factor: usize, value: f64, out: &mut String) {
        self.0[factor].write(value, out);
    }
}

impl Column {
    fn new(factor: &Factor, quoted: &dyn Fn(&str) -> String) -> Self {
        let law = factor.distribution();
        let is_truth = law.name() == "boolean";
        let cells = match law {
            whole if whole.is_whole() => Cells::WholeNumbers,
            Distribution::Categorical(categories) => Cells::Labels(
                categories
                    .categories()
                    .map(|(label, value, _)| (value, if is_truth { label.to_owned() } else { quoted(label) }))
                    .collect(),
            ),
            _ => Cells::Numbers,
        };
        Self { name: quoted(&factor.name), unit: factor.unit().clone(), cells }
    }

    fn write(&self, si: f64, out: &mut String) {
        let value = self.unit.from_si(si);
        // Writing to a string cannot fail. `{:?}` uses an exponent if the number would be long without one.
        let _ = match &self.cells {
            Cells::WholeNumbers if value.fract() == 0.0 => write!(out, "{value:.0}"),
            Cells::Labels(labels) => match labels.iter().find(|(number, _)| *number == value) {
                Some((_, label)) => out.write_str(label),
                None => write!(out, "{value:?}"),
            },
            _ => write!(out, "{value:?}"),
        };
    }
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
        let (mut text, values) = (String::new(), ValueWriter::new(&factors()));
        values.write(2, 1.0, &mut text);
        assert_eq!(text, "glass, thin");
        let inputs: [&[f64]; 4] = [&[1e-13], &[4.0], &[1.0], &[0.0]];
        assert_eq!(values.table(&inputs, 0), "length,n,made of,wet\n1e-7,4,\"glass, thin\",false\n");
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
