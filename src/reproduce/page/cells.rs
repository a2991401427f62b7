//! Cells of tables.

use apportion::report::page::{Cell, Mark};

pub(super) fn plain(text: impl Into<String>) -> Cell {
    Cell::plain(text)
}

pub(super) fn strong(text: &str) -> Cell {
    Cell::marked(text, Mark::Strong)
}
