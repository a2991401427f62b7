//! The data of a figure as CSV.

/// Columns of numbers under names with units.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    names: Vec<String>,
    columns: Vec<Vec<String>>,
}

impl Table {
    /// Adds a column of numbers, written with as many digits as it takes to read the same bits back; an empty cell for
    /// one that is not finite.
    pub fn with(mut self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        self.names.push(name.to_owned());
        let cell = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
        self.columns.push(values.into_iter().map(cell).collect());
        self
    }

    /// Adds a column of words without commas.
    pub fn with_words<'a>(mut self, name: &str, words: impl IntoIterator<Item = &'a str>) -> Self {
        self.names.push(name.to_owned());
        self.columns.push(words.into_iter().map(str::to_owned).collect());
        self
    }

    /// A header, then as many lines as the longest column; shorter ones end in empty cells.
    pub fn csv(&self) -> String {
        let rows = self.columns.iter().map(Vec::len).max().unwrap_or(0);
        let mut text = self.names.join(",") + "\n";
        for row in 0..rows {
            let cells: Vec<&str> =
                self.columns.iter().map(|column| column.get(row).map_or("", String::as_str)).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
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
