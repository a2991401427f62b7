//! CSV: numbers with as many digits as it takes to read the same bits back, an empty cell for a missing value.

use apportion::text::inert;
use apportion::uncertainty::Estimate;

/// A value of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    /// The text that is printed.
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
    /// Creates a column.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_estimate: false }
    }

    /// Creates the columns `name`, `name_low` and `name_high`.
    pub fn estimate(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_estimate: true }
    }
}

impl Field {
    /// Returns the headers of its columns.
    pub(super) fn names(&self) -> Vec<String> {
        let suffixes = if self.is_estimate { &["", "_low", "_high"][..] } else { &[""] };
        suffixes.iter().map(|suffix| inert(format!("{}{suffix}", self.name))).collect()
    }
}

impl Value {
    /// Returns the cells of its columns, where `printed` is the printed text.
    pub(super) fn cells(&self, printed: &str) -> Vec<String> {
        vec![match self {
            Self::Printed => inert(printed.to_owned()),
            Self::Empty => String::new(),
            Self::Text(text) => inert(text.clone()),
            Self::Number(number) => exact(Some(*number)),
            Self::Count(count) => count.to_string(),
            Self::Flag(flag) => flag.to_string(),
            Self::Estimate(estimate) => {
                let interval = estimate.and_then(|estimate| estimate.interval);
                let bounds = [interval.map(|i| i.low), interval.map(|i| i.high)];
                return [estimate.map(|e| e.estimate)].into_iter().chain(bounds).map(exact).collect();
            }
        }]
    }
}

/// Formats lines of CSV.
pub(super) fn lines(lines: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut writer = ::csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
    lines.into_iter().for_each(|line| writer.write_record(line).expect("into memory"));
    String::from_utf8(writer.into_inner().expect("into memory")).expect("text in, text out")
}

/// Formats a number that reads back to the same bits; empty for `None`.
fn exact(value: Option<f64>) -> String {
    value.filter(|value| value.is_finite()).map_or_else(String::new, |value| value.to_string())
}

/// Declares how a value of each type is written in a table.
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
    use apportion::uncertainty::Interval;

    use super::*;
    use crate::document::Table;

    #[test]
    fn values_keep_their_bits_and_gaps_are_empty() {
        let known = Estimate { estimate: 0.1, interval: Some(Interval { low: -0.5, high: 1e-300 }) };
        let rows = [("=1+1", 7.0, Some(known)), ("", f64::NAN, None)];
        let table = Table::from_rows("", rows).file("a,b", |row| row.0).file("n", |row| row.1);
        let table = table.file_estimate("S", |row| row.2).file("flag", |_| true);
        let expected = format!("\"a,b\",n,S,S_low,S_high,flag\n'=1+1,7,0.1,-0.5,{},true\n,,,,,true\n", 1e-300);
        assert_eq!(table.csv(), expected);
    }
}
