//! Tables: cells as printed, with the exact values behind them for CSV.

use std::borrow::Borrow;

use apportion::uncertainty::Estimate;
use apportion_base::text::inert;

use super::Link;
use crate::csv::{Value, lines};
use crate::format::give_or_take;

/// A table. Pages and terminals print its cells; a CSV file holds the values behind them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What it shows, in one sentence.
    pub caption: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
    /// Which rows are printed, in this order; all of them if this is `None`. A file has all rows.
    pub printed: Option<Vec<usize>>,
    /// A last row that is printed and is in no file; may be empty.
    pub sums: Vec<Cell>,
    /// Its layout on a narrow page.
    pub on_phone: OnPhone,
    /// The CSV file of its rows; may be empty. Tables of the same columns may share one.
    pub file: String,
}

/// A column of a [`Table`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// The printed header; a column without one is only in the file.
    heading: Option<String>,
    /// Whether it holds numbers, which are aligned right.
    numeric: bool,
    /// Its names in the file, three of an estimate; a column without them is only printed.
    names: Vec<String>,
}

/// The layout of a table on a phone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnPhone {
    /// Unchanged, scrolled sideways inside its frame: for numbers.
    #[default]
    Scroll,
    /// Every row as a block of its cells, one below the other: for sentences that need no heading.
    Stack,
    /// Like `Stack`, with each cell under the heading of its column.
    StackLabelled,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    /// Its text.
    pub text: String,
    /// The value behind the text, for files.
    pub value: Value,
    /// How it is emphasised.
    pub mark: Mark,
    /// The target of its link, if any.
    pub to: Option<String>,
    /// A note below it in small letters; may be empty.
    pub note: String,
    /// Further links, below the note.
    pub links: Vec<Link>,
}

/// How a cell is emphasised; never by colour alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Not at all.
    #[default]
    Plain,
    /// In strong letters.
    Strong,
    /// As a badge of good news.
    Good,
    /// As a badge of mixed news.
    Mixed,
    /// As a badge of bad news.
    Bad,
}

impl Table {
    /// Starts a table of `rows`, whose columns are added one by one.
    ///
    /// ```
    /// use apportion_report::document::Table;
    ///
    /// let table: Table = Table::from_rows("Two factors.", &[("length", 0.25), ("width", 0.5)])
    ///     .text("factor", |row| row.0)
    ///     .named("factor")
    ///     .number("S_T", |row| format!("{:.2}", row.1))
    ///     .value("total", |row| row.1)
    ///     .into();
    /// assert_eq!(table.csv(), "factor,total\nlength,0.25\nwidth,0.5\n");
    /// ```
    pub fn from_rows<R: Copy>(caption: impl Into<String>, rows: impl IntoIterator<Item = R>) -> Rows<R> {
        let rows: Vec<R> = rows.into_iter().collect();
        let table = Self { caption: caption.into(), rows: vec![Vec::new(); rows.len()], ..Self::default() };
        Rows { rows, table }
    }

    /// Creates a table of labels and texts without headings.
    pub fn pairs<L: Into<String>>(caption: &str, rows: impl IntoIterator<Item = (L, String)>) -> Self {
        let rows: Vec<(String, String)> = rows.into_iter().map(|(label, text)| (label.into(), text)).collect();
        Self::from_rows(caption, &rows).text("", |(label, _)| label).text("", |(_, text)| text).into()
    }

    /// Formats the rows as CSV.
    pub fn csv(&self) -> String {
        csv([self])
    }

    /// Returns the cells of its rows in a file.
    fn file_rows(&self) -> Vec<Vec<String>> {
        let mut rows = Vec::new();
        for row in &self.rows {
            let cells = self.columns.iter().zip(row).filter(|(column, _)| !column.names.is_empty());
            rows.push(cells.flat_map(|(_, cell)| cell.value.0.clone()).collect());
        }
        rows
    }

    /// Returns whether any of its columns is in a file.
    pub(super) fn has_fields(&self) -> bool {
        self.columns.iter().any(|column| !column.names.is_empty())
    }

    /// Returns the printed columns, with their headings and whether they hold numbers.
    pub(super) fn printed_columns(&self) -> Vec<(usize, &str, bool)> {
        let columns = self.columns.iter().enumerate();
        columns.filter_map(|(place, column)| Some((place, column.heading.as_deref()?, column.numeric))).collect()
    }

    /// Returns the printed rows, with the cells of the printed columns.
    pub(super) fn printed_rows(&self) -> Vec<Vec<&Cell>> {
        let columns = self.printed_columns();
        let rows: Vec<&Vec<Cell>> = match &self.printed {
            None => self.rows.iter().collect(),
            Some(places) => places.iter().map(|&place| &self.rows[place]).collect(),
        };
        let sums = Some(&self.sums).filter(|sums| !sums.is_empty());
        rows.into_iter().chain(sums).map(|row| columns.iter().map(|(place, ..)| &row[*place]).collect()).collect()
    }
}

/// Formats the rows of `tables`, which have the same columns, as CSV; empty without any.
pub(crate) fn csv<T: Borrow<Table>>(tables: impl IntoIterator<Item = T>) -> String {
    let mut tables = tables.into_iter().peekable();
    let Some(first) = tables.peek() else { return String::new() };
    let header: Vec<String> = first.borrow().columns.iter().flat_map(|column| column.names.clone()).collect();
    lines(std::iter::once(header).chain(tables.flat_map(|table| table.borrow().file_rows())))
}

/// Says how many of how many are shown; empty if all are.
pub(crate) fn largest(shown: usize, all: usize, what: &str) -> String {
    if shown < all { format!(" The {shown} largest of {all} {what}.") } else { String::new() }
}

/// A builder of a table. Each column is defined once: its header, the printed text of a row, and the name and value of
/// the row in the CSV file.
#[derive(Clone, Debug)]
pub struct Rows<R> {
    rows: Vec<R>,
    table: Table,
}

impl<R: Copy> Rows<R> {
    /// Adds a column of texts.
    pub fn text<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(R) -> C) -> Self {
        self.column(Column { heading: Some(heading.into()), ..Column::default() }, cell)
    }

    /// Adds a column of numbers.
    pub fn number<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(R) -> C) -> Self {
        self.column(Column { heading: Some(heading.into()), numeric: true, names: Vec::new() }, cell)
    }

    /// Adds a column of estimates, printed with their errors, and with their bounds in the file.
    pub fn index(
        self,
        heading: impl Into<String>,
        name: impl Into<String>,
        value: impl Fn(R) -> Option<Estimate>,
    ) -> Self {
        self.number(heading, &value).estimate(name, value)
    }

    /// Adds a column that is only in the file.
    pub fn file<V: Into<Value>>(self, name: impl Into<String>, value: impl Fn(R) -> V) -> Self {
        self.column(Column::default(), |_| "").value(name, value)
    }

    /// Adds an estimate and its bounds, three columns that are only in the file.
    pub fn file_estimate(self, name: impl Into<String>, value: impl Fn(R) -> Option<Estimate>) -> Self {
        self.column(Column::default(), |_| "").estimate(name, value)
    }

    /// Writes the last column to the file under `name`, as printed.
    pub fn named(self, name: impl Into<String>) -> Self {
        self.in_file(vec![inert(name.into())], |cell, _| cell.text.as_str().into())
    }

    /// Writes the last column to the file under `name`, with this value.
    pub fn value<V: Into<Value>>(self, name: impl Into<String>, value: impl Fn(R) -> V) -> Self {
        self.in_file(vec![inert(name.into())], |_, row| value(row).into())
    }

    /// Writes the last column to the file as an estimate with its bounds.
    pub fn estimate(self, name: impl Into<String>, value: impl Fn(R) -> Option<Estimate>) -> Self {
        let name = name.into();
        self.in_file(["", "_low", "_high"].map(|suffix| inert(format!("{name}{suffix}"))).to_vec(), |_, row| {
            value(row).into()
        })
    }

    /// Prints the last column only `if_shown`.
    pub fn shown(mut self, if_shown: bool) -> Self {
        if let Some(column) = self.table.columns.last_mut().filter(|_| !if_shown) {
            column.heading = None;
        }
        self
    }

    /// Prints the first `max_rows` of the rows in this order; the caption then says how many of `what` there are.
    pub fn largest(mut self, order: impl IntoIterator<Item = usize>, max_rows: usize, what: &str) -> Self {
        let mut order: Vec<usize> = order.into_iter().collect();
        self.table.caption.push_str(&largest(order.len().min(max_rows), order.len(), what));
        order.truncate(max_rows);
        self.table.printed = Some(order);
        self
    }

    /// Prints the first `max_rows` of the rows in their own order.
    pub fn first(self, max_rows: usize, what: &str) -> Self {
        let all = 0..self.rows.len();
        self.largest(all, max_rows, what)
    }

    /// Sets the cell of the last column in the row of sums.
    pub fn sum(mut self, cell: impl Into<Cell>) -> Self {
        self.table.sums.resize_with(self.table.columns.len() - 1, Cell::default);
        self.sums([cell.into()])
    }

    /// Sets the cells of the next columns in the row of sums.
    pub fn sums(mut self, cells: impl IntoIterator<Item = Cell>) -> Self {
        self.table.sums.extend(cells);
        self
    }

    /// Formats the rows as CSV.
    pub fn csv(&self) -> String {
        self.table.csv()
    }

    fn column<C: Into<Cell>>(mut self, column: Column, cell: impl Fn(R) -> C) -> Self {
        self.table.columns.push(column);
        for (cells, row) in self.table.rows.iter_mut().zip(&self.rows) {
            cells.push(cell(*row).into());
        }
        self
    }

    fn in_file(mut self, names: Vec<String>, value: impl Fn(&Cell, R) -> Value) -> Self {
        if let Some(column) = self.table.columns.last_mut() {
            column.names = names;
        }
        for (cell, row) in self.table.rows.iter_mut().filter_map(|cells| cells.last_mut()).zip(&self.rows) {
            cell.value = value(cell, *row);
        }
        self
    }
}

impl<R> From<Rows<R>> for Table {
    fn from(mut rows: Rows<R>) -> Self {
        if !rows.table.sums.is_empty() {
            rows.table.sums.resize_with(rows.table.columns.len(), Cell::default);
        }
        rows.table
    }
}

impl<R> From<Rows<R>> for super::Part {
    fn from(rows: Rows<R>) -> Self {
        Self::Table(rows.into())
    }
}

impl Cell {
    /// Creates a cell emphasised by `mark`.
    pub fn marked(text: impl Into<String>, mark: Mark) -> Self {
        Self { text: text.into(), mark, ..Self::default() }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { text, ..Self::default() }
    }
}

impl From<&String> for Cell {
    fn from(text: &String) -> Self {
        text.clone().into()
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

/// Formats an index with the half width of its interval, a dash for `None`.
impl From<Option<Estimate>> for Cell {
    fn from(estimate: Option<Estimate>) -> Self {
        estimate.map_or_else(|| "–".to_owned(), give_or_take).into()
    }
}

impl From<Estimate> for Cell {
    fn from(estimate: Estimate) -> Self {
        Some(estimate).into()
    }
}
