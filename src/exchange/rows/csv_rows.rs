//! Rows as CSV.

use std::io::{BufWriter, Read, Write};

use super::{ColumnKind, RowReader, RowWriter, RowsError, check_names};
use crate::exchange::points::PlainLines;
use crate::report::csv_field;

/// Reads CSV: a byte-order mark and spaces around cells are ignored, empty lines are skipped.
pub(super) struct CsvRows<R: Read> {
    csv: csv::Reader<PlainLines<R>>,
    names: Vec<String>,
    record: csv::StringRecord,
    /// Rows read.
    rows: u64,
}

impl<R: Read> CsvRows<R> {
    pub(super) fn new(reader: R) -> Result<Self, RowsError> {
        let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(PlainLines::new(reader));
        let header = csv.headers().map_err(|source| wrong_record(source, 1))?;
        let names: Vec<String> =
            header.iter().map(|name| name.trim_start_matches('\u{feff}').trim().to_owned()).collect();
        if let [name] = &names[..]
            && let Some(separator) = [';', '\t'].into_iter().find(|separator| name.contains(*separator))
        {
            return Err(RowsError::OtherSeparator { name: name.clone(), separator });
        }
        check_names(&names)?;
        Ok(Self { csv, names, record: csv::StringRecord::new(), rows: 0 })
    }
}

impl<R: Read> RowReader for CsvRows<R> {
    fn names(&self) -> Option<&[String]> {
        Some(&self.names)
    }

    fn width(&self) -> usize {
        self.names.len()
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError> {
        into.iter_mut().for_each(Vec::clear);
        for row in 0..rows {
            let read = self.csv.read_record(&mut self.record);
            // The reader stands at the start of the next line.
            let line = self.csv.position().line().saturating_sub(1);
            if !read.map_err(|source| wrong_record(source, line))? {
                return Ok(row);
            }
            self.rows += 1;
            for ((place, kind), column) in wanted.iter().zip(&mut *into) {
                let cell = &self.record[*place];
                let value = kind.value(cell).ok_or_else(|| RowsError::WrongCell {
                    row: self.rows,
                    name: self.names[*place].clone(),
                    expected: kind.expected(),
                    found: cell.to_owned(),
                })?;
                column.push(value);
            }
        }
        Ok(rows)
    }
}

fn wrong_record(source: csv::Error, line: u64) -> RowsError {
    match source.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            RowsError::WrongLength { line, expected: *expected_len, found: *len }
        }
        _ => RowsError::NoCsv { line, source },
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
