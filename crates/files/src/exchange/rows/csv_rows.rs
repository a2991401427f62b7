//! Rows as CSV: with commas, semicolons, tabs or blanks between the cells.

use std::collections::VecDeque;
use std::io::{Read, Write};

use apportion_base::quantity::Unit;
use apportion_base::text::{csv_field, plain_field};

use super::lines::Lines;
use super::{ColumnKind, ReadOptions, RowReader, check_names, expanded, is_error_word, names_of_columns, number};
use crate::exchange::error::{TableError, refused};

/// Number of rows that are examined to distinguish text columns from number columns.
const AHEAD: usize = 100;

/// The beginning of a table of NetLogo's BehaviorSpace, which has six lines before its header.
pub(super) const NETLOGO: &str = "BehaviorSpace results";

/// Reads CSV: spaces around cells are ignored, empty lines and comments (`#`) are skipped.
pub(super) struct CsvRows {
    csv: csv::Reader<Lines>,
    names: Option<Vec<String>>,
    width: usize,
    /// Numbers that mean a missing value.
    missing: Vec<f64>,
    record: csv::StringRecord,
    /// Rows examined before they are read, each with its line.
    ahead: VecDeque<(csv::StringRecord, u64)>,
    /// Lines of the rows of the last block.
    lines: Vec<u64>,
    /// Number of rows read.
    rows: u64,
}

impl CsvRows {
    pub(super) fn new(text: Box<dyn Read>, options: &ReadOptions) -> Result<Self, TableError> {
        let lines = Lines::new(text)?;
        let mut builder = csv::ReaderBuilder::new();
        builder.trim(csv::Trim::All).delimiter(lines.separator).has_headers(false).flexible(true);
        let mut rows = Self {
            csv: builder.from_reader(lines),
            names: None,
            width: 0,
            missing: options.missing.clone(),
            record: csv::StringRecord::new(),
            ahead: VecDeque::new(),
            lines: Vec::new(),
            rows: 0,
        };
        rows.read_header(options)?;
        Ok(rows)
    }

    /// Reads the names of the columns, or examines the first row of a table without names.
    fn read_header(&mut self, options: &ReadOptions) -> Result<(), TableError> {
        let mut comment = Vec::new();
        let first = loop {
            match self.next_record()? {
                Some((record, 1)) if record[0].to_lowercase().starts_with("sep=") => (),
                // Version, model, experiment, date, and the names and values of the size of the world.
                Some((record, 1)) if record[0].starts_with(NETLOGO) => {
                    for _ in 1..6 {
                        self.next_record()?;
                    }
                }
                Some((record, _)) if record[0].starts_with('#') && !is_error_word(&record[0]) => {
                    let cells = record.iter().map(|cell| cell.trim_start_matches('#').trim());
                    // A single mark is a cell if blanks separate cells.
                    comment = cells.skip(usize::from(&record[0] == "#")).map(str::to_owned).collect();
                }
                first => break first,
            }
        };
        let Some((record, line)) = first else {
            return self.set_names(if options.names.is_empty() { &comment } else { &options.names });
        };
        let numbers = record.iter().filter_map(number).collect::<Vec<f64>>();
        let (has_numbers, of_numbers) = (!numbers.is_empty(), numbers.len() == record.len());
        let is_row = options.no_header || has_numbers && (!options.names.is_empty() || comment.len() == record.len());
        if !is_row {
            // Whole numbers may be names among others, such as years.
            if of_numbers || numbers.iter().any(|value| value.fract() != 0.0) {
                return refused(format!(
                    "line {line} has numbers where the names of the columns are expected: if the file has no header, add \
                     --no-header (and --names for the names of the columns in their order)"
                ));
            }
            let cells: Vec<String> = record.iter().map(|cell| plain_field(cell).to_owned()).collect();
            if !options.names.is_empty() {
                let known = cells.join(", ");
                return refused(format!(
                    "its header names the columns ({known}): leave --names out, or add --no-header if the first line is a row"
                ));
            }
            self.set_names(&cells)?;
            return self.skip_units();
        }
        let names = if options.names.is_empty() && !options.no_header { comment } else { options.names.clone() };
        self.width = record.len();
        self.names = names_of_columns(&names, self.width)?;
        self.ahead.push_back((record, line));
        Ok(())
    }

    /// Sets the names of all columns.
    fn set_names(&mut self, names: &[String]) -> Result<(), TableError> {
        let mut names = expanded(names);
        // The index of pandas and R has no name.
        if names.len() > 1 && names[0].is_empty() && !names[1..].iter().any(|name| name.is_empty() || name == "index") {
            "index".clone_into(&mut names[0]);
        }
        check_names(&names)?;
        (self.width, self.names) = (names.len(), Some(names));
        Ok(())
    }

    /// Leaves out a line of units under the header: text over numbers, some of it units or in brackets.
    fn skip_units(&mut self) -> Result<(), TableError> {
        let (first, second) = (self.next_row()?, self.next_row()?);
        let is_units = first.iter().zip(&second).any(|((units, _), (row, _))| {
            let mut pairs = units.iter().zip(row).filter(|(_, value)| number(value).is_some());
            units.iter().all(|unit| number(unit).is_none()) && pairs.any(|(unit, _)| is_unit(unit))
        });
        self.ahead.extend(first.filter(|_| !is_units).into_iter().chain(second));
        Ok(())
    }

    /// Returns the next row of the text with its line.
    fn next_row(&mut self) -> Result<Option<(csv::StringRecord, u64)>, TableError> {
        while let Some((record, line)) = self.next_record()? {
            if record.len() == self.width && !(record[0].starts_with("# ") || &record[0] == "#") {
                return Ok(Some((record, line)));
            }
            if !record[0].starts_with('#') || is_error_word(&record[0]) {
                let (width, cells) = (self.width, record.len());
                return refused(format!("line {line}: expected {width} cells as in the header, not {cells}"));
            }
        }
        Ok(None)
    }

    fn next_record(&mut self) -> Result<Option<(csv::StringRecord, u64)>, TableError> {
        let read = self.csv.read_record(&mut self.record);
        // The reader is at the start of the next line.
        let line = self.csv.position().line().saturating_sub(1);
        let is_one = read.map_err(|source| wrong_record(source, line))?;
        Ok(is_one.then(|| (std::mem::take(&mut self.record), line)))
    }

    fn name(&self, place: usize) -> String {
        self.names.as_ref().map_or_else(|| format!("number {}", place + 1), |names| names[place].clone())
    }
}

impl RowReader for CsvRows {
    fn names(&self) -> Option<&[String]> {
        self.names.as_deref()
    }

    fn width(&self) -> usize {
        self.width
    }

    fn text_columns(&mut self) -> Result<Vec<(usize, String)>, TableError> {
        while self.ahead.len() < AHEAD
            && let Some(next) = self.next_row()?
        {
            self.ahead.push_back(next);
        }
        let (kind, mut columns) = (ColumnKind::default(), Vec::new());
        for place in 0..self.width {
            let mut cells = self.ahead.iter().filter_map(|(record, _)| record.get(place));
            // The first cell with a value decides.
            let cell = cells.find(|cell| !kind.value(cell).is_some_and(f64::is_nan));
            columns.extend(cell.filter(|cell| kind.value(cell).is_none()).map(|cell| (place, cell.to_owned())));
        }
        Ok(columns)
    }

    fn line(&self, row: usize) -> Option<u64> {
        self.lines.get(row).copied()
    }

    fn is_unended(&self) -> bool {
        self.csv.get_ref().is_unended()
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, to: &mut [Vec<f64>]) -> Result<usize, TableError> {
        to.iter_mut().for_each(Vec::clear);
        self.lines.clear();
        for row in 0..rows {
            let next = match self.ahead.pop_front() {
                Some(next) => Some(next),
                None => self.next_row()?,
            };
            let Some((record, line)) = next else { return Ok(row) };
            self.rows += 1;
            self.lines.push(line);
            for ((place, kind), column) in wanted.iter().zip(&mut *to) {
                let cell = &record[*place];
                let value = kind.value(cell).or_else(|| kind.value(plain_field(cell))).ok_or_else(|| {
                    let decimal_comma = kind.labels.is_empty() && number(&cell.replacen(',', ".", 1)).is_some();
                    TableError::WrongCell {
                        row: self.rows,
                        line: Some(line),
                        column: place + 1,
                        name: self.name(*place),
                        expected: kind.expected() + if decimal_comma { " with a decimal point" } else { "" },
                        found: cell.to_owned(),
                    }
                })?;
                column.push(if self.missing.contains(&value) { f64::NAN } else { value });
            }
            // Its memory is reused for the next row.
            self.record = record;
        }
        Ok(rows)
    }
}

/// Returns whether a cell is a unit of physics, or any text in brackets.
fn is_unit(cell: &str) -> bool {
    let is_bracketed = cell.starts_with(['[', '(']) && cell.ends_with([']', ')']);
    is_bracketed || !cell.is_empty() && Unit::known(cell).is_some()
}

fn wrong_record(source: csv::Error, line: u64) -> TableError {
    // The reader counts records and bytes from its own start, which do not help the user.
    match source.kind() {
        csv::ErrorKind::Utf8 { .. } => {
            TableError::Refused(format!("line {line}: not text in UTF-8: save the file as UTF-8"))
        }
        _ => TableError::Refused(format!("line {line}: {source}")),
    }
}

/// Writes the names of the columns.
pub(super) fn write_header(out: &mut impl Write, columns: &[ColumnKind]) -> std::io::Result<()> {
    let names: Vec<String> = columns.iter().map(|column| csv_field(&column.name)).collect();
    writeln!(out, "{}", names.join(","))
}

/// Writes a row of values with their columns.
pub(super) fn write_row<'a>(
    out: &mut impl Write,
    row: impl ExactSizeIterator<Item = (f64, &'a ColumnKind)>,
) -> std::io::Result<()> {
    let is_single = row.len() == 1;
    for (number, (value, kind)) in row.enumerate() {
        if number > 0 {
            write!(out, ",")?;
        }
        match kind.label(value) {
            Some(label) => write!(out, "{}", csv_field(label))?,
            // A single empty cell would be an empty line, which readers skip.
            None if value.is_nan() && is_single => write!(out, "\"\"")?,
            None if value.is_nan() => (),
            None if kind.whole => write!(out, "{value}")?,
            None => write!(out, "{value:?}")?,
        }
    }
    writeln!(out)
}
