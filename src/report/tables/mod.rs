//! Results as text for a terminal and as CSV for a spreadsheet.

mod csv;
mod extras;
mod number;
mod summary;

use comfy_table::{CellAlignment, ContentArrangement, ContentLineStyle, LineStyle, Table, TableStyle};

pub use csv::{convergence_csv, estimators_csv, indices_csv, second_order_csv};
pub(crate) use csv::{csv_field, inert, plain_field};
pub(super) use number::{chance, give_or_take};
pub use number::{estimate, fixed, share, share_of_runs, significant, two_digits, with_unit};
pub use summary::summary;

/// Rules above, under the header and below; nothing between the rows.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::new('─', '─', '─', '─'))
    .header_lines(ContentLineStyle::new(' ', ' ', ' '))
    .header_separator(LineStyle::new('─', '─', '─', '─'))
    .content_lines(ContentLineStyle::new(' ', ' ', ' '))
    .bottom_border(LineStyle::new('─', '─', '─', '─'));

/// An empty table in the program's one style, as wide as the terminal allows. Columns stand to the right, as numbers
/// do, but for those whose places are in `text`.
pub fn table(header: &[&str], text: &[usize]) -> Table {
    let mut table = Table::new();
    table.load_style(STYLE).set_content_arrangement(ContentArrangement::Dynamic).set_header(header);
    for (place, column) in table.column_iter_mut().enumerate() {
        if !text.contains(&place) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}
