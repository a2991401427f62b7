//! The data of a figure as CSV.

use apportion::report::csv::{Csv, Field};
use apportion::report::document::Value;

/// Columns of numbers under names with units.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    names: Vec<String>,
    columns: Vec<Vec<Value>>,
}

impl Table {
    /// Adds a column of numbers; an empty cell for one that is not finite.
    pub fn with(mut self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.names.push(name.to_owned());
        self.columns.push(values.into_iter().map(Value::Number).collect());
        self
    }

    /// Adds a column of words.
    pub fn with_words<'a>(mut self, name: &str, words: impl IntoIterator<Item = &'a str>) -> Self {
        self.names.push(name.to_owned());
        self.columns.push(words.into_iter().map(Value::from).collect());
        self
    }

    /// A header, then as many lines as the longest column; shorter ones end in empty cells.
    pub fn csv(&self) -> String {
        let rows = self.columns.iter().map(Vec::len).max().unwrap_or(0);
        let mut csv = Csv::new(self.names.iter().map(Field::new));
        for row in 0..rows {
            csv.row(self.columns.iter().map(|column| column.get(row).cloned().unwrap_or(Value::Empty)));
        }
        csv.text()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits_and_gaps_are_empty() {
        let table =
            Table::default().with("x_um", [0.1, 1e-300]).with("y_nN", [f64::NAN]).with_words("mode", ["a", "b"]);
        assert_eq!(table.csv(), format!("x_um,y_nN,mode\n0.1,,a\n{},,b\n", 1e-300));
    }
}
