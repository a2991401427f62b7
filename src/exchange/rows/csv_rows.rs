//! Rows as CSV: with commas, semicolons or tabs between the cells.

use std::collections::VecDeque;
use std::io::{BufWriter, Cursor, Read, Write};

use super::plain_lines::PlainLines;
use super::{ColumnKind, RowReader, RowWriter, RowsError, check_names, expanded};
use crate::text::{csv_field, plain_field};

/// Rows that are looked at to tell columns of text from those of numbers.
const AHEAD: usize = 100;

/// Most bytes of the first line that are looked at for what separates its cells.
const FIRST_LINE: usize = 1 << 16;

/// A text with its beginning read already.
type Begun<R> = std::io::Chain<Cursor<Vec<u8>>, R>;

/// Reads CSV: a byte-order mark and spaces around cells are ignored, empty lines are skipped.
pub(super) struct CsvRows<R: Read> {
    csv: csv::Reader<PlainLines<Begun<R>>>,
    names: Vec<String>,
    record: csv::StringRecord,
    /// Rows looked at before they are asked for, each with its line.
    ahead: VecDeque<(csv::StringRecord, u64)>,
    /// Lines of the rows of the last block.
    lines: Vec<u64>,
    /// Rows read.
    rows: u64,
}

impl<R: Read> CsvRows<R> {
    /// A table with a header, or one of columns with these names.
    pub(super) fn new(mut reader: R, names: &[String]) -> Result<Self, RowsError> {
        let begin = first_line(&mut reader)?;
        let delimiter = separator(&begin);
        let text = PlainLines::new(Cursor::new(begin).chain(reader));
        let mut builder = csv::ReaderBuilder::new();
        // A cell of the header may stand for several columns: how long rows must be is known when it has been read.
        builder.trim(csv::Trim::All).delimiter(delimiter).has_headers(names.is_empty()).flexible(true);
        let mut csv = builder.from_reader(text);
        let named = if names.is_empty() {
            let header = csv.headers().map_err(|source| wrong_record(source, 1))?;
            let name = |name: &str| plain_field(name.trim_start_matches('\u{feff}').trim()).to_owned();
            expanded(header.iter().map(name))
        } else {
            expanded(names.iter().cloned())
        };
        check_names(&named)?;
        let (record, ahead, lines) = Default::default();
        let mut rows = Self { csv, names: named, record, ahead, lines, rows: 0 };
        if !names.is_empty() {
            rows.check_width()?;
        }
        Ok(rows)
    }

    /// Whether the first row of a table without a header has a cell for every name.
    fn check_width(&mut self) -> Result<(), RowsError> {
        let Some((mut first, line)) = self.record_as_it_is()? else { return Ok(()) };
        if first.len() != self.names.len() {
            return Err(RowsError::OtherWidth { width: first.len(), names: self.names.len() });
        }
        // The mark would be part of the first number.
        if let Some(cell) = first.get(0).and_then(|cell| cell.strip_prefix('\u{feff}')) {
            let cells: Vec<&str> = std::iter::once(cell).chain(first.iter().skip(1)).collect();
            first = csv::StringRecord::from(cells);
        }
        self.ahead.push_back((first, line));
        Ok(())
    }

    /// The next row with its line, from the text: a cell for every name.
    fn next_record(&mut self) -> Result<Option<(csv::StringRecord, u64)>, RowsError> {
        let next = self.record_as_it_is()?;
        let (expected, found) = (self.names.len() as u64, |record: &csv::StringRecord| record.len() as u64);
        match next {
            Some((record, line)) if found(&record) != expected => {
                Err(RowsError::WrongLength { line, expected, found: found(&record) })
            }
            next => Ok(next),
        }
    }

    fn record_as_it_is(&mut self) -> Result<Option<(csv::StringRecord, u64)>, RowsError> {
        let read = self.csv.read_record(&mut self.record);
        // The reader stands at the start of the next line.
        let line = self.csv.position().line().saturating_sub(1);
        let is_one = read.map_err(|source| wrong_record(source, line))?;
        Ok(is_one.then(|| (std::mem::take(&mut self.record), line)))
    }
}

/// The beginning of a text up to the end of its first line, and maybe beyond.
fn first_line(reader: &mut impl Read) -> std::io::Result<Vec<u8>> {
    let (mut begin, mut part) = (Vec::new(), [0; 4096]);
    while begin.len() < FIRST_LINE && !begin.contains(&b'\n') {
        match reader.read(&mut part) {
            Ok(0) => break,
            Ok(count) => begin.extend_from_slice(&part[..count]),
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => (),
            Err(error) => return Err(error),
        }
    }
    Ok(begin)
}

/// What separates the cells of a first line: a comma if there is one outside of quotes, else a semicolon or a tab.
fn separator(begin: &[u8]) -> u8 {
    let (mut quoted, mut found) = (false, None);
    for byte in begin {
        match byte {
            b'"' => quoted = !quoted,
            b'\n' if !quoted => break,
            b',' if !quoted => return b',',
            b';' | b'\t' if !quoted => found = found.or(Some(*byte)),
            _ => (),
        }
    }
    found.unwrap_or(b',')
}

impl<R: Read> RowReader for CsvRows<R> {
    fn names(&self) -> Option<&[String]> {
        Some(&self.names)
    }

    fn width(&self) -> usize {
        self.names.len()
    }

    fn text_columns(&mut self) -> Result<Vec<usize>, RowsError> {
        while self.ahead.len() < AHEAD
            && let Some(next) = self.next_record()?
        {
            self.ahead.push_back(next);
        }
        let number = ColumnKind::default();
        let is_text = |place: &usize| {
            let cells = self.ahead.iter().filter_map(|(record, _)| record.get(*place));
            let mut values = cells.map(|cell| number.value(cell)).filter(|value| !value.is_some_and(f64::is_nan));
            values.next().is_some_and(|value| value.is_none())
        };
        Ok((0..self.names.len()).filter(is_text).collect())
    }

    fn text_example(&self, place: usize) -> Option<String> {
        let number = ColumnKind::default();
        let mut cells = self.ahead.iter().filter_map(|(record, _)| record.get(place));
        cells.find(|cell| number.value(cell).is_none()).map(str::to_owned)
    }

    fn line(&self, row: usize) -> Option<u64> {
        self.lines.get(row).copied()
    }

    fn is_unended(&self) -> bool {
        self.csv.get_ref().is_unended()
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError> {
        into.iter_mut().for_each(Vec::clear);
        self.lines.clear();
        for row in 0..rows {
            let next = match self.ahead.pop_front() {
                Some(next) => Some(next),
                None => self.next_record()?,
            };
            let Some((record, line)) = next else { return Ok(row) };
            self.rows += 1;
            self.lines.push(line);
            for ((place, kind), column) in wanted.iter().zip(&mut *into) {
                let cell = &record[*place];
                let value = kind.value(cell).or_else(|| kind.value(plain_field(cell))).ok_or_else(|| {
                    let decimal_comma = kind.labels.is_empty() && cell.replacen(',', ".", 1).parse::<f64>().is_ok();
                    RowsError::WrongCell {
                        row: self.rows,
                        line: Some(line),
                        column: place + 1,
                        name: self.names[*place].clone(),
                        expected: kind.expected() + if decimal_comma { " with a decimal point" } else { "" },
                        found: cell.to_owned(),
                    }
                })?;
                column.push(value);
            }
            // Its memory serves the next row.
            self.record = record;
        }
        Ok(rows)
    }
}

fn wrong_record(source: csv::Error, line: u64) -> RowsError {
    // The reader counts records and bytes from its own beginning, which are of no use to the user.
    match source.kind() {
        csv::ErrorKind::Utf8 { .. } => {
            RowsError::NoCsv { line, source: "it is not text in UTF-8: save the file as UTF-8".into() }
        }
        _ => RowsError::NoCsv { line, source: source.into() },
    }
}

/// Writes CSV, every number with as many digits as it takes to read the same bits back.
pub(super) struct CsvWriter<'a> {
    out: BufWriter<&'a mut (dyn Write + Send)>,
    columns: Vec<ColumnKind>,
}

impl<'a> CsvWriter<'a> {
    pub(super) fn new(out: &'a mut (dyn Write + Send), columns: Vec<ColumnKind>) -> std::io::Result<Self> {
        let mut out = BufWriter::new(out);
        let names: Vec<String> = columns.iter().map(|column| csv_field(&column.name)).collect();
        writeln!(out, "{}", names.join(","))?;
        Ok(Self { out, columns })
    }
}

impl RowWriter for CsvWriter<'_> {
    fn write(&mut self, columns: &[&[f64]]) -> std::io::Result<()> {
        let out = &mut self.out;
        for row in 0..columns.first().map_or(0, |column| column.len()) {
            for (number, (values, kind)) in columns.iter().zip(&self.columns).enumerate() {
                if number > 0 {
                    write!(out, ",")?;
                }
                let value = values[row];
                match kind.label(value) {
                    Some(label) => write!(out, "{}", csv_field(label))?,
                    // An empty cell by itself would be an empty line, which readers skip.
                    None if value.is_nan() && columns.len() == 1 => write!(out, "\"\"")?,
                    None if value.is_nan() => (),
                    None if kind.whole => write!(out, "{value}")?,
                    None => write!(out, "{value:?}")?,
                }
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> std::io::Result<()> {
        self.out.flush()
    }
}
