//! Tables of text for a terminal.

mod fit;

use std::fmt;

use comfy_table::{CellAlignment, ContentArrangement, ContentLineStyle, LineStyle, Table, TableStyle};
use unicode_width::UnicodeWidthStr;

pub use fit::wrapped;

/// Rules above, under the header and below; nothing between the rows.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::new('─', '─', '─', '─'))
    .header_lines(ContentLineStyle::new(' ', ' ', ' '))
    .header_separator(LineStyle::new('─', '─', '─', '─'))
    .content_lines(ContentLineStyle::new(' ', ' ', ' '))
    .bottom_border(LineStyle::new('─', '─', '─', '─'));

/// A table of text, as wide as the terminal allows where it is printed to one.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    text: Vec<usize>,
}

/// An empty table in the program's one style. Columns stand to the right, as numbers do, but for those whose places are in
/// `text`.
pub fn table(header: &[&str], text: &[usize]) -> TextTable {
    let header = header.iter().map(|name| (*name).to_owned()).collect();
    TextTable { rows: vec![header], text: text.to_vec() }
}

impl TextTable {
    /// Adds a row; cells that are left out are empty.
    pub fn add_row<T: ToString>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.rows.push(cells.into_iter().map(|cell| cell.to_string()).collect());
    }

    /// The table in no more than `width` columns, as far as that can be done; as wide as it is without one.
    fn drawn(&self, width: Option<usize>) -> Table {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        // A space between columns and at both ends, then what pads them.
        let rules = columns + 1;
        let widest = |column: usize| self.rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.width()).max();
        let content: usize = (0..columns).filter_map(widest).sum();
        let mut table = Table::new();
        table.load_style(STYLE).set_content_arrangement(ContentArrangement::Disabled);
        let (rows, padding) = match width {
            Some(width) if content + rules + 2 * columns > width => {
                (&fit::fitted(&self.rows, width.saturating_sub(rules)), (0, 0))
            }
            _ => (&self.rows, (1, 1)),
        };
        let mut rows = rows.iter();
        if let Some(header) = rows.next().filter(|header| header.iter().any(|heading| !heading.is_empty())) {
            table.set_header(header);
        }
        rows.for_each(|row| {
            table.add_row(row);
        });
        for (place, column) in table.column_iter_mut().enumerate() {
            column.set_padding(padding);
            if !self.text.contains(&place) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        table
    }
}

impl TextTable {
    /// The table, or where numbers would be broken its rows one below the other.
    fn text(&self, width: Option<usize>) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        match width {
            Some(width) if !fit::keeps_numbers(&self.rows, width.saturating_sub(columns + 1)) => self.stacked(width),
            _ => self.drawn(width).to_string(),
        }
    }

    /// Every row as a block: its first cell, and below it the others behind their headings.
    fn stacked(&self, width: usize) -> String {
        let rule = "─".repeat(width);
        let mut lines = vec![rule.clone()];
        let Some((header, rows)) = self.rows.split_first() else { return rule };
        for row in rows {
            let cells = row.iter().zip(header).enumerate().filter(|(place, (cell, _))| *place == 0 || !cell.is_empty());
            lines.extend(cells.map(|(place, (cell, heading))| {
                let margin = if place == 0 { "" } else { "  " };
                let heading = if place == 0 || heading.is_empty() { String::new() } else { format!("{heading}: ") };
                wrapped(&format!("{margin}{heading}{cell}"), width)
            }));
        }
        lines.push(rule);
        lines.join("\n")
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Terminals that nobody looks at, such as those of mpirun, have no columns.
        let width = Table::new().width().map(usize::from).filter(|width| *width > 0);
        f.write_str(&self.text(width))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seven columns as those of a result: a name of fifteen letters once was broken inside at 80 columns.
    #[test]
    fn a_result_fits_a_terminal_without_a_broken_word() {
        let header = ["factor", "first order S1", "total ST", "share S1 %", "share ST %", "P(first)", "P(ST > 0.01)"];
        let mut result = table(&header, &[0]);
        for name in ["static_friction", "contact_modulus", "velocity"] {
            result.add_row([name, "0.3374 ± 0.0024", "0.4374 ± 0.0124", "33.7 ± 0.2", "33.7 ± 0.2", "0.250", ">0.999"]);
        }
        result.add_row(["sum of factors", "0.9374 ± 0.0024"]);
        let wide = result.drawn(None).to_string();
        assert!(wide.contains("  static_friction   0.3374 ± 0.0024 "), "{wide}");
        let lines = |width| result.text(Some(width));
        for width in [30, 40, 64, 72, 80, 100] {
            let drawn = lines(width);
            assert!(drawn.lines().all(|line| line.width() <= width), "{width}:\n{drawn}");
            for word in ["static_friction", "contact_modulus", "0.3374", "0.4374", "± 0.0124", "P(first)", ">0.999"] {
                assert!(drawn.contains(word), "no {word} at {width}:\n{drawn}");
            }
        }
        assert_eq!(lines(200), wide);
        let narrow = lines(40);
        assert!(narrow.contains("\nstatic_friction\n  first order S1: 0.3374 ± 0.0024\n"), "{narrow}");
    }
}
