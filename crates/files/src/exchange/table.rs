//! A table of inputs and outputs, from any source.

use apportion::given::{Column, TextColumn};
use apportion_base::names::{did_you_mean, nearest};

use super::counter::{is_called_counter, places as places_of_rows};
use super::error::{TableError, place_in_words, refused};
use super::rows::{ColumnKind, RowReader};

/// What to do with rows without a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Missing {
    /// Refuse the table at the first such row.
    #[default]
    Refuse,
    /// Drop the rows and count them.
    Drop,
}

/// Which columns of a table are used, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection<'a> {
    /// Names of the outputs.
    pub outputs: &'a [String],
    /// Names of the inputs; empty for all columns of numbers that are not outputs.
    pub inputs: &'a [String],
    /// What to do with rows without a value in one of these columns.
    pub missing: Missing,
    /// Columns that hold labels, or may hold them: those of the factors of a study.
    pub kinds: &'a [ColumnKind],
}

/// Rows that were dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DroppedRows {
    /// Their number.
    pub rows: u64,
    /// Line of the first of them in the file, from 1; its row in the table if the file has no lines.
    pub first_line: u64,
}

/// A table as columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The inputs, in the requested order, or in that of the file.
    pub inputs: Vec<Column>,
    /// The outputs, in the requested order.
    pub outputs: Vec<Column>,
    /// Rows dropped for missing values.
    pub dropped: Option<DroppedRows>,
    /// The text columns, which are not inputs.
    pub skipped: Vec<TextColumn>,
    /// The column that numbers the rows, which is no input either: the rows are in its order.
    pub counter: Option<String>,
}

/// Rows from which numbers from 0 or 1 without repetition are no values by chance.
const MIN_NUMBERED: usize = 30;

/// Rows read at a time.
const BLOCK: usize = 1 << 12;

/// Reads a table of numbers. Columns that are not selected may hold anything; if the inputs are not named, text columns
/// are not inputs.
///
/// A value is missing if its cell is empty or is `nan`, `na`, `n/a`, `null`, `none`, `.` or `-` in any case, or is an
/// error of a spreadsheet such as `#N/A`, or if it is one of the [numbers](super::ReadOptions::missing) that mean so.
///
/// # Errors
/// [`TableError`] with the place of the first error.
pub fn read_table(reader: &mut dyn RowReader, selection: &Selection<'_>) -> Result<Table, TableError> {
    let Some(names) = reader.names().map(<[String]>::to_vec) else {
        let width = reader.width();
        return refused(format!("its {width} columns have no names: name them in their order (--names)"));
    };
    let (mut inputs, outputs) = places(&names, selection)?;
    let (mut skipped, remedy) = (Vec::new(), TextColumn::REMEDY);
    if selection.inputs.is_empty() {
        for (place, example) in reader.text_columns()? {
            let name = &names[place];
            if inputs.contains(&place) && selection.kinds.iter().all(|kind| kind.name != *name) {
                inputs.retain(|input| *input != place);
                skipped.push(TextColumn { name: name.clone(), example: Some(example) });
            }
        }
    }
    if inputs.is_empty() {
        let why: String = skipped.iter().map(|column| format!("; {}", column.reason())).collect();
        let names = names.join(", ");
        return refused(format!("no column of numbers is left as an input{why}; the columns are {names}; {remedy}"));
    }
    let chosen: Vec<usize> = inputs.iter().chain(&outputs).copied().collect();
    let (mut wanted, mut columns) = (Vec::new(), Vec::new());
    for &place in &chosen {
        let kind = selection.kinds.iter().find(|kind| kind.name == names[place]).cloned();
        wanted.push((place, kind.unwrap_or_else(|| ColumnKind::numbers(&names[place]))));
        columns.push(Column { name: names[place].clone(), values: Vec::new() });
    }
    // Columns that are inputs because no inputs are named.
    let defaults = if selection.inputs.is_empty() { &inputs[..] } else { &[] };
    let (mut dropped, mut cells, mut before): (Option<DroppedRows>, _, u64) = (None, vec![Vec::new(); wanted.len()], 0);
    loop {
        let count = reader.read(&wanted, BLOCK, &mut cells).map_err(|error| match error {
            TableError::WrongCell { row, line, column, found, .. } => {
                let place = place_in_words(line, row);
                not_a_number(&place, column, &names[column - 1], &found, defaults.contains(&(column - 1)))
            }
            error => error,
        })?;
        if count == 0 {
            break;
        }
        for row in 0..count {
            let (line, number) = (reader.line(row), before + row as u64 + 1);
            let Some(first) = cells.iter().position(|column| !column[row].is_finite()) else {
                for (column, cells) in columns.iter_mut().zip(&cells) {
                    column.values.push(cells[row]);
                }
                continue;
            };
            let place = place_in_words(line, number);
            if selection.missing == Missing::Refuse {
                let (column, name) = (chosen[first] + 1, &names[chosen[first]]);
                let what = match cells[first][row] {
                    value if value.is_nan() => "the value is missing".to_owned(),
                    value => format!("{value} is no finite number"),
                };
                return refused(format!(
                    "{place}: column {column} (`{name}`): {what}; --drop-missing leaves such rows out"
                ));
            }
            let first_line = line.unwrap_or(number);
            dropped.get_or_insert(DroppedRows { rows: 0, first_line }).rows += 1;
        }
        before += count as u64;
    }
    let outputs = columns.split_off(inputs.len());
    let mut table = Table { inputs: columns, outputs, dropped, skipped, counter: None };
    if selection.inputs.is_empty() {
        table.sort_by_counter(before)?;
    }
    Ok(table)
}

impl Table {
    /// Removes an input that numbers the `rows` rows of the file, and puts the rows in its order.
    fn sort_by_counter(&mut self, rows: u64) -> Result<(), TableError> {
        let of_inputs = self.inputs.iter().map(|input| places_of_rows(&input.values, rows));
        let of_inputs: Vec<Option<Vec<usize>>> = of_inputs.collect();
        let is_only_kind = of_inputs.iter().all(Option::is_some);
        let can_be_one = of_inputs.iter().flatten().any(|places| places.len() >= MIN_NUMBERED) && !is_only_kind;
        let found = (0..self.inputs.len())
            .find(|place| of_inputs[*place].is_some() && (can_be_one || is_called_counter(&self.inputs[*place].name)));
        let Some((place, places)) = found.and_then(|place| Some((place, of_inputs[place].as_ref()?))) else {
            return Ok(());
        };
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_unstable_by_key(|row| places[*row]);
        let name = self.inputs.remove(place).name;
        if self.inputs.is_empty() {
            return refused(format!(
                "the only input is `{name}`, which numbers the rows: add the columns of the inputs, or analyse the outputs of a \
                 design with `apportion analyze --design`"
            ));
        }
        for column in self.inputs.iter_mut().chain(&mut self.outputs) {
            column.values = order.iter().map(|row| column.values[*row]).collect();
        }
        self.counter = Some(name);
        Ok(())
    }
}

/// Returns the error of a cell; `is_default` says that its column is an input because no inputs are named.
fn not_a_number(place: &str, column: usize, name: &str, found: &str, is_default: bool) -> TableError {
    let (remedy, advice) = (TextColumn::REMEDY, "; if the column is not an input, name the inputs (--inputs)");
    let advice = if is_default { advice } else { "" };
    TableError::Refused(format!(
        "{place}: column {column} (`{name}`): expected a finite number, not {found:?}{advice}; {remedy}"
    ))
}

/// Returns the position of the column of that name.
pub(super) fn column_of(names: &[String], name: &str) -> Result<usize, TableError> {
    if let Some(place) = names.iter().position(|other| other == name) {
        return Ok(place);
    }
    let hint = did_you_mean(&nearest(name, names.iter().map(String::as_str)));
    refused(format!("no column is called `{name}`{hint}; the columns are {}", names.join(", ")))
}

/// Returns the positions of the inputs and of the outputs in the header.
fn places(names: &[String], selection: &Selection<'_>) -> Result<(Vec<usize>, Vec<usize>), TableError> {
    let chosen: Vec<&String> = selection.outputs.iter().chain(selection.inputs).collect();
    if let Some(k) = (1..chosen.len()).find(|&k| chosen[..k].contains(&chosen[k])) {
        return refused(format!("`{}` is listed twice: each column can be one input or one output", chosen[k]));
    }
    let mut outputs = chosen.into_iter().map(|name| column_of(names, name)).collect::<Result<Vec<_>, _>>()?;
    let mut inputs = outputs.split_off(selection.outputs.len());
    if inputs.is_empty() {
        inputs = (0..names.len()).filter(|place| !outputs.contains(place)).collect();
    }
    Ok((inputs, outputs))
}
