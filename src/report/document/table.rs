//! Tables: cells as they are printed, with the exact values behind them for CSV.

use std::borrow::Borrow;

use crate::report::csv::{Csv, Field, Value};
use crate::report::format::give_or_take;

use super::Link;
use crate::uncertainty::Estimate;

/// A table. Pages and terminals print its cells; a file of CSV has the values behind them.
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
    /// A last row that is printed and stands in no file; may be empty.
    pub sums: Vec<Cell>,
    /// What becomes of it where a page is too narrow.
    pub on_phone: OnPhone,
    /// The file of CSV that its rows stand in; may be empty. Tables of the same columns may share one.
    pub file: String,
}

/// A column of a [`Table`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// What is printed above it; a column without is in the file alone.
    heading: Option<String>,
    /// Whether it holds numbers, which are set to the right.
    numeric: bool,
    /// Its names in the file; a column without is printed alone.
    field: Option<Field>,
}

/// How a table is set on a phone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnPhone {
    /// As it is, to be scrolled sideways inside its frame: for numbers.
    #[default]
    Scroll,
    /// Every row as a block of its cells, one below the other: for sentences that need no heading.
    Stack,
    /// The same, each cell under the heading of its column.
    StackLabelled,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    /// Its text.
    pub text: String,
    /// The value behind the text, for files.
    pub value: Value,
    /// How it is set off.
    pub mark: Mark,
    /// Where its text leads, if anywhere.
    pub to: Option<String>,
    /// What is said below it in small letters; may be empty.
    pub note: String,
    /// Further links, below the note.
    pub links: Vec<Link>,
}

/// How a cell is set off; never by colour alone.
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
    /// An empty table.
    pub fn new(caption: impl Into<String>, columns: impl IntoIterator<Item = Column>) -> Self {
        Self { caption: caption.into(), columns: columns.into_iter().collect(), ..Self::default() }
    }

    /// The table with `rows`.
    pub fn with_rows(self, rows: impl IntoIterator<Item = Vec<Cell>>) -> Self {
        Self { rows: rows.into_iter().collect(), ..self }
    }

    /// A table of `rows`, whose columns are added one after the other.
    ///
    /// ```
    /// use apportion::report::document::Table;
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

    /// A table of labels and texts without headings.
    pub fn pairs<L: Into<String>>(caption: &str, rows: impl IntoIterator<Item = (L, String)>) -> Self {
        let rows = rows.into_iter().map(|(label, text)| vec![label.into().into(), text.into()]);
        Self::new(caption, [Column::text(""), Column::text("")]).with_rows(rows)
    }

    /// The rows as CSV.
    pub fn csv(&self) -> String {
        csv([self])
    }

    /// Whether a file has some of its columns.
    pub(super) fn has_fields(&self) -> bool {
        self.columns.iter().any(|column| column.field.is_some())
    }

    /// The columns that are printed, with their headings and whether they hold numbers.
    pub(super) fn printed_columns(&self) -> Vec<(usize, &str, bool)> {
        let columns = self.columns.iter().enumerate();
        columns.filter_map(|(place, column)| Some((place, column.heading.as_deref()?, column.numeric))).collect()
    }

    /// The rows that are printed, with the cells of the printed columns.
    pub(super) fn printed_rows(&self) -> Vec<Vec<&Cell>> {
        let columns = self.printed_columns();
        let cells = |row: &'_ Vec<Cell>| -> Vec<usize> {
            columns.iter().map(|(place, ..)| *place).filter(|place| *place < row.len()).collect()
        };
        let rows: Vec<&Vec<Cell>> = match &self.printed {
            None => self.rows.iter().collect(),
            Some(places) => places.iter().map(|&place| &self.rows[place]).collect(),
        };
        let sums = Some(&self.sums).filter(|sums| !sums.is_empty());
        rows.into_iter().chain(sums).map(|row| cells(row).into_iter().map(|place| &row[place]).collect()).collect()
    }
}

/// The rows of `tables`, which have the same columns, as CSV; nothing without any.
pub(crate) fn csv<T: Borrow<Table>>(tables: impl IntoIterator<Item = T>) -> String {
    let mut tables = tables.into_iter().peekable();
    let Some(first) = tables.peek() else { return String::new() };
    let mut csv = Csv::new(first.borrow().columns.iter().filter_map(|column| column.field.clone()));
    for table in tables {
        let table = table.borrow();
        for row in &table.rows {
            let in_file = table.columns.iter().zip(row).filter(|(column, _)| column.field.is_some());
            csv.row(in_file.map(|(_, cell)| match &cell.value {
                Value::Printed => Value::Text(cell.text.clone()),
                value => value.clone(),
            }));
        }
    }
    csv.text()
}

impl Column {
    /// A column of texts.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: Some(heading.into()), ..Self::default() }
    }

    /// A column of numbers.
    pub fn number(heading: impl Into<String>) -> Self {
        Self { numeric: true, ..Self::text(heading) }
    }

    /// A column that is in the file alone.
    pub fn in_file(field: Field) -> Self {
        Self { field: Some(field), ..Self::default() }
    }

    /// The column as it is called in the file.
    pub fn named(self, field: Field) -> Self {
        Self { field: Some(field), ..self }
    }

    /// Columns of which the first `texts` are texts and the others numbers.
    pub fn list(texts: usize, headings: &[&str]) -> Vec<Self> {
        let column = |(place, heading): (usize, &&str)| {
            if place < texts { Self::text(*heading) } else { Self::number(*heading) }
        };
        headings.iter().enumerate().map(column).collect()
    }
}

/// A table in the making: of every column it is said once what stands above it, what is printed in a row, and under which
/// name and with which value the row stands in the file of CSV.
#[derive(Clone, Debug)]
pub struct Rows<R> {
    rows: Vec<R>,
    table: Table,
}

impl<R: Copy> Rows<R> {
    /// Adds a column of texts.
    pub fn text<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(R) -> C) -> Self {
        self.column(Column::text(heading), cell)
    }

    /// Adds a column of numbers.
    pub fn number<C: Into<Cell>>(self, heading: impl Into<String>, cell: impl Fn(R) -> C) -> Self {
        self.column(Column::number(heading), cell)
    }

    /// Adds a column that is in the file alone.
    pub fn file<V: Into<Value>>(self, name: impl Into<String>, value: impl Fn(R) -> V) -> Self {
        self.column(Column::default(), |_| "").value(name, value)
    }

    /// Adds an estimate and its bounds, three columns that are in the file alone.
    pub fn file_estimate(self, name: impl Into<String>, value: impl Fn(R) -> Option<Estimate>) -> Self {
        self.column(Column::default(), |_| "").estimate(name, value)
    }

    /// The last column stands in the file under `name`, as it is printed.
    pub fn named(self, name: impl Into<String>) -> Self {
        self.value(name, |_| Value::Printed)
    }

    /// The last column stands in the file under `name`, with this value.
    pub fn value<V: Into<Value>>(self, name: impl Into<String>, value: impl Fn(R) -> V) -> Self {
        self.field(Field::new(name), value)
    }

    /// The last column stands in the file as an estimate with its bounds.
    pub fn estimate(self, name: impl Into<String>, value: impl Fn(R) -> Option<Estimate>) -> Self {
        self.field(Field::estimate(name), value)
    }

    /// The last column is printed only `if_shown`.
    pub fn shown(mut self, if_shown: bool) -> Self {
        self.table.columns.last_mut().filter(|_| !if_shown).into_iter().for_each(|column| column.heading = None);
        self
    }

    /// What stands in the last column of the row of sums.
    pub fn sum(mut self, cell: impl Into<Cell>) -> Self {
        self.table.sums.resize_with(self.table.columns.len(), Cell::default);
        self.table.sums.pop();
        self.table.sums.push(cell.into());
        self
    }

    /// The rows as CSV.
    pub fn csv(&self) -> String {
        self.table.csv()
    }

    fn column<C: Into<Cell>>(mut self, column: Column, cell: impl Fn(R) -> C) -> Self {
        self.table.columns.push(column);
        self.table.rows.iter_mut().zip(&self.rows).for_each(|(cells, row)| cells.push(cell(*row).into()));
        self
    }

    fn field<V: Into<Value>>(mut self, field: Field, value: impl Fn(R) -> V) -> Self {
        self.table.columns.last_mut().into_iter().for_each(|column| column.field = Some(field.clone()));
        let cells = self.table.rows.iter_mut().filter_map(|cells| cells.last_mut());
        cells.zip(&self.rows).for_each(|(cell, row)| cell.value = value(*row).into());
        self
    }
}

impl<R> From<Rows<R>> for Table {
    fn from(rows: Rows<R>) -> Self {
        rows.table
    }
}

impl<R> From<Rows<R>> for super::Part {
    fn from(rows: Rows<R>) -> Self {
        rows.table.into()
    }
}

impl Cell {
    /// A cell set off by `mark`.
    pub fn marked(text: impl Into<String>, mark: Mark) -> Self {
        Self { text: text.into(), mark, ..Self::default() }
    }

    /// A cell that prints `text` where a file has `value`.
    pub fn valued(text: impl Into<String>, value: Value) -> Self {
        Self { text: text.into(), value, ..Self::default() }
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

/// An index with the half width of its interval, a dash without one.
impl From<Option<Estimate>> for Cell {
    fn from(estimate: Option<Estimate>) -> Self {
        Self::valued(estimate.map_or_else(|| "–".to_owned(), give_or_take), Value::Estimate(estimate))
    }
}

impl From<Estimate> for Cell {
    fn from(estimate: Estimate) -> Self {
        Some(estimate).into()
    }
}
