//! Tables of text for a terminal.

use std::fmt;

use comfy_table::{
    CellAlignment, ColumnConstraint, ContentArrangement, ContentLineStyle, LineStyle, Table, TableStyle, Width,
};

/// Rules above, under the header and below; nothing between the rows.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::new('─', '─', '─', '─'))
    .header_lines(ContentLineStyle::new(' ', ' ', ' '))
    .header_separator(LineStyle::new('─', '─', '─', '─'))
    .content_lines(ContentLineStyle::new(' ', ' ', ' '))
    .bottom_border(LineStyle::new('─', '─', '─', '─'));

/// A table of text, no wider than the terminal it is printed to, as far as the words allow.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    text: Vec<usize>,
}

/// Creates an empty table in the program's style. Columns are aligned right, as numbers are, except for those whose
/// positions are in `text`.
pub fn table(header: &[&str], text: &[usize]) -> TextTable {
    let header = header.iter().map(|name| (*name).to_owned()).collect();
    TextTable { rows: vec![header], text: text.to_vec() }
}

impl TextTable {
    /// Adds a row; omitted cells are empty.
    pub fn add_row<T: ToString>(&mut self, cells: impl IntoIterator<Item = T>) {
        // An error is kept on the line of its number.
        self.rows.push(cells.into_iter().map(|cell| cell.to_string().replace(" ± ", "\u{a0}±\u{a0}")).collect());
    }

    fn drawn(&self, width: Option<u16>) -> String {
        let mut table = Table::new();
        table.load_style(STYLE);
        if let Some(width) = width {
            table.set_width(width).set_content_arrangement(ContentArrangement::Dynamic);
        }
        let mut rows = self.rows.iter();
        if let Some(header) = rows.next().filter(|header| header.iter().any(|heading| !heading.is_empty())) {
            table.set_header(header);
        }
        rows.for_each(|row| {
            table.add_row(row);
        });
        for (place, column) in table.column_iter_mut().enumerate() {
            let words = self.rows.iter().filter_map(|row| row.get(place)).flat_map(|cell| cell.split(' '));
            let longest = words.map(|word| word.chars().count()).max().unwrap_or(0);
            let padded = longest as u16 + column.padding_width();
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(padded)));
            if !self.text.contains(&place) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        table.to_string().replace('\u{a0}', " ")
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Terminals without a screen, such as those of mpirun, have no width.
        f.write_str(&self.drawn(Table::new().width().filter(|width| *width > 0)))
    }
}
