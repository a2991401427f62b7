//! CSV: numbers with as many digits as it takes to read the same bits back, an empty cell where there is none.

use crate::text::inert;
use crate::uncertainty::Estimate;

/// A value of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    /// What is printed.
    #[default]
    Printed,
    /// Nothing.
    Empty,
    /// A text.
    Text(String),
    /// A number, written so that the same bits are read back; one that is not finite is left empty.
    Number(f64),
    /// A whole number.
    Count(u64),
    /// Yes or no.
    Flag(bool),
    /// An estimate and the bounds of its interval, in three columns.
    Estimate(Option<Estimate>),
}

/// The name of a column, or of the three columns of an estimate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    name: String,
    is_estimate: bool,
}

impl Field {
    /// A column.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_estimate: false }
    }

    /// The columns `name`, `name_low` and `name_high`.
    pub fn estimate(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_estimate: true }
    }
}

/// Columns of these names, of which the last `estimates` are estimates with their bounds.
pub fn fields(names: &[&str], estimates: &[&str]) -> Vec<Field> {
    let plain = names.iter().map(|name| Field::new(*name));
    plain.chain(estimates.iter().map(|name| Field::estimate(*name))).collect()
}

/// Lines of CSV under a header.
pub struct Csv {
    writer: ::csv::Writer<Vec<u8>>,
    /// Cells of the header, and of the line so far.
    width: usize,
    cells: usize,
}

impl Csv {
    /// A table with a header alone.
    pub fn new(fields: impl IntoIterator<Item = Field>) -> Self {
        let mut csv = Self { writer: ::csv::Writer::from_writer(Vec::new()), width: 0, cells: 0 };
        for Field { name, is_estimate } in fields {
            csv.cell(&inert(name.clone()));
            if is_estimate {
                csv.cell(&inert(format!("{name}_low")));
                csv.cell(&inert(format!("{name}_high")));
            }
        }
        csv.width = csv.cells;
        csv.end();
        csv
    }

    /// Adds a line, which has at most as many cells as the header; those that lack are empty.
    pub fn row<V: Into<Value>>(&mut self, values: impl IntoIterator<Item = V>) {
        for value in values {
            match value.into() {
                Value::Printed | Value::Empty => self.cell(""),
                Value::Text(text) => self.cell(&inert(text)),
                Value::Number(number) => self.cell(&exact(Some(number))),
                Value::Count(count) => self.cell(&count.to_string()),
                Value::Flag(flag) => self.cell(if flag { "true" } else { "false" }),
                Value::Estimate(estimate) => {
                    let bounds = |Estimate { estimate, interval }: Estimate| {
                        [Some(estimate), interval.map(|i| i.low), interval.map(|i| i.high)]
                    };
                    estimate.map_or([None; 3], bounds).iter().for_each(|bound| self.cell(&exact(*bound)));
                }
            }
        }
        self.end();
    }

    /// The lines.
    pub fn text(self) -> String {
        String::from_utf8(self.writer.into_inner().expect("into memory")).expect("text in, text out")
    }

    fn cell(&mut self, text: &str) {
        self.writer.write_field(text).expect("into memory");
        self.cells += 1;
    }

    fn end(&mut self) {
        while self.cells < self.width {
            self.cell("");
        }
        self.cells = 0;
        self.writer.write_record(None::<&[u8]>).expect("no longer than the header, into memory");
    }
}

/// A number that reads back to the same bits; empty without one.
fn exact(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| value.to_string())
}

/// Declares what a value of each type is in a table.
macro_rules! values {
    ($($type:ty => $value:expr;)+) => {
        $(impl From<$type> for Value {
            fn from(of: $type) -> Self {
                $value(of)
            }
        })+
    };
}

values! {
    &str => |text: &str| Self::Text(text.to_owned());
    &String => |text: &String| Self::Text(text.clone());
    String => Self::Text;
    f64 => Self::Number;
    u64 => Self::Count;
    bool => Self::Flag;
    Estimate => |estimate| Self::Estimate(Some(estimate));
    Option<Estimate> => Self::Estimate;
    Option<f64> => |number: Option<f64>| number.map_or(Self::Empty, Self::Number);
    Option<&str> => |text: Option<&str>| text.map_or(Self::Empty, Self::from);
    Option<bool> => |flag: Option<bool>| flag.map_or(Self::Empty, Self::Flag);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::Interval;

    #[test]
    fn values_keep_their_bits_and_gaps_are_empty() {
        let mut csv = Csv::new(fields(&["a,b", "n"], &["S"]));
        let known = Estimate { estimate: 0.1, interval: Some(Interval { low: -0.5, high: 1e-300 }) };
        csv.row([Value::from("=1+1"), Value::from(7), known.into()]);
        csv.row([Value::Flag(true), Value::from(f64::NAN), Value::Estimate(None)]);
        csv.row([Value::Flag(false)]);
        assert_eq!(csv.text(), format!("\"a,b\",n,S,S_low,S_high\n'=1+1,7,0.1,-0.5,{}\ntrue,,,,\nfalse,,,,\n", 1e-300));
    }
}
