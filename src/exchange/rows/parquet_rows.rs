//! Rows as Parquet: flat columns of numbers or text.

use std::cell::Cell;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Once};

use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnDescriptor, Type};

use super::parquet_pages::{CheckedPages, Ending};
use super::{ColumnKind, RowReader, RowWriter, RowsError, check_names};

/// Rows of a row group that is written: some megabytes of a dozen columns.
const GROUP: usize = 1 << 16;

impl From<ParquetError> for RowsError {
    fn from(error: ParquetError) -> Self {
        Self::NoParquet(error.to_string())
    }
}

thread_local! {
    /// Whether this thread reads a file whose reader may panic.
    static READING: Cell<bool> = const { Cell::new(false) };
}

/// What `read` returns; the reader's panics over damaged files, of which it has some, as an error without their text on the
/// terminal. Panics of other threads are told as ever.
fn guarded<T>(read: impl FnOnce() -> Result<T, RowsError>) -> Result<T, RowsError> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let others = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            // The thread may be at its end.
            if !READING.try_with(Cell::get).unwrap_or(false) {
                others(panic);
            }
        }));
    });
    let before = READING.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(read));
    READING.set(before);
    outcome.unwrap_or_else(|_| Err(RowsError::NoParquet("it is damaged".to_owned())))
}

/// Reads Parquet, row group by row group.
pub(super) struct ParquetRows {
    file: Box<dyn FileReader>,
    names: Vec<String>,
    /// The next row group.
    group: usize,
    /// Readers of the wanted columns in the current row group, and its rows that are left.
    current: Option<(Vec<ColumnReader>, u64)>,
    /// Rows read.
    rows: u64,
}

impl ParquetRows {
    pub(super) fn new<R: ChunkReader + 'static>(file: R) -> Result<Self, RowsError> {
        guarded(|| {
            let file: Box<dyn FileReader> = Box::new(SerializedFileReader::new(Ending(file))?);
            let schema = file.metadata().file_metadata().schema_descr();
            let names: Vec<String> = schema.columns().iter().map(|column| column.path().parts().join(".")).collect();
            check_names(&names)?;
            Ok(Self { names, group: 0, current: None, rows: 0, file })
        })
    }

    /// Moves on to the next row group with rows; `false` at the end.
    fn next_group(&mut self, wanted: &[(usize, ColumnKind)]) -> Result<bool, RowsError> {
        while self.current.as_ref().is_none_or(|(_, left)| *left == 0) {
            if self.group == self.file.num_row_groups() {
                return Ok(false);
            }
            let group = self.file.get_row_group(self.group)?;
            self.group += 1;
            let rows = u64::try_from(group.metadata().num_rows())
                .map_err(|_| RowsError::NoParquet("a row group has less than no rows".to_owned()))?;
            let readers = wanted.iter().map(|(place, _)| {
                supported(&group.metadata().schema_descr().column(*place), &self.names[*place])?;
                let compression = group.metadata().column(*place).compression();
                if !matches!(compression, Compression::UNCOMPRESSED | Compression::SNAPPY) {
                    // The level in brackets is of no matter.
                    let name = compression.to_string().to_lowercase();
                    let name = name.split('(').next().unwrap_or_default();
                    return Err(RowsError::NoParquet(format!(
                        "it is compressed by {name}: write it uncompressed or with snappy"
                    )));
                }
                let column = group.metadata().schema_descr().column(*place);
                let has_levels = column.max_def_level() > 0;
                let pages = CheckedPages { pages: group.get_column_page_reader(*place)?, has_levels };
                Ok(get_column_reader(column, Box::new(pages)))
            });
            self.current = Some((readers.collect::<Result<_, RowsError>>()?, rows));
        }
        Ok(true)
    }

    fn read_block(
        &mut self,
        wanted: &[(usize, ColumnKind)],
        rows: usize,
        into: &mut [Vec<f64>],
    ) -> Result<usize, RowsError> {
        into.iter_mut().for_each(Vec::clear);
        let mut done = 0;
        while done < rows && self.next_group(wanted)? {
            let Some((readers, left)) = &mut self.current else { break };
            let count = (rows - done).min(usize::try_from(*left).unwrap_or(usize::MAX));
            for (((place, kind), reader), column) in wanted.iter().zip(readers).zip(&mut *into) {
                let (name, first) = (&self.names[*place], self.rows + done as u64);
                let place = Place { column: *place, name, first, kind };
                read_cells(reader, count, place, column)?;
            }
            *left -= count as u64;
            done += count;
        }
        self.rows += done as u64;
        Ok(done)
    }
}

/// Whether a column holds plain numbers or text.
fn supported(column: &ColumnDescriptor, name: &str) -> Result<(), RowsError> {
    let wrong = |found: &str| Err(RowsError::WrongColumn { name: name.to_owned(), found: found.to_owned() });
    if column.max_rep_level() > 0 || column.max_def_level() > 1 {
        return wrong("nested");
    }
    let logical = column.logical_type_ref();
    let plain = match logical {
        None => matches!(
            column.converted_type(),
            ConvertedType::NONE
                | ConvertedType::UTF8
                | ConvertedType::ENUM
                | ConvertedType::INT_8
                | ConvertedType::INT_16
                | ConvertedType::INT_32
                | ConvertedType::INT_64
                | ConvertedType::UINT_8
                | ConvertedType::UINT_16
        ),
        Some(LogicalType::String | LogicalType::Enum) => true,
        Some(LogicalType::Integer(integer)) => integer.is_signed || integer.bit_width < 32,
        Some(_) => false,
    };
    if !plain {
        return wrong(&logical.map_or_else(|| column.converted_type().to_string(), |logical| format!("{logical:?}")));
    }
    match column.physical_type() {
        Physical::INT96 => wrong("a time"),
        Physical::FIXED_LEN_BYTE_ARRAY => wrong("of bytes"),
        _ => Ok(()),
    }
}

/// Where cells stand, for messages, and what they are.
#[derive(Clone, Copy)]
struct Place<'a> {
    column: usize,
    name: &'a str,
    /// Row of the first one, from 0.
    first: u64,
    kind: &'a ColumnKind,
}

fn read_cells(reader: &mut ColumnReader, count: usize, place: Place<'_>, into: &mut Vec<f64>) -> Result<(), RowsError> {
    let cell = |row: usize, found: String| RowsError::WrongCell {
        row: place.first + row as u64 + 1,
        line: None,
        column: place.column + 1,
        name: place.name.to_owned(),
        expected: place.kind.expected(),
        found,
    };
    let number = |row: usize, value: f64| match place.kind.labels.is_empty() || place.kind.label(value).is_some() {
        true => Ok(value),
        false => Err(cell(row, value.to_string())),
    };
    match reader {
        ColumnReader::DoubleColumnReader(reader) => cells(reader, count, into, |row, value| number(row, *value)),
        ColumnReader::FloatColumnReader(reader) => {
            cells(reader, count, into, |row, value| number(row, (*value).into()))
        }
        ColumnReader::Int32ColumnReader(reader) => {
            cells(reader, count, into, |row, value| number(row, (*value).into()))
        }
        ColumnReader::Int64ColumnReader(reader) => cells(reader, count, into, |row, value| number(row, *value as f64)),
        ColumnReader::BoolColumnReader(reader) => cells(reader, count, into, |row, value| {
            let by_label = place.kind.value_of(if *value { "true" } else { "false" });
            by_label.map_or_else(|| number(row, f64::from(u8::from(*value))), Ok)
        }),
        ColumnReader::ByteArrayColumnReader(reader) => cells(reader, count, into, |row, value| {
            let text = value.as_utf8().map_err(|_| cell(row, "bytes that are no text".to_owned()))?;
            place.kind.value(text.trim()).ok_or_else(|| cell(row, text.to_owned()))
        }),
        _ => Err(RowsError::WrongColumn { name: place.name.to_owned(), found: "of bytes".to_owned() }),
    }
}

/// Exactly `count` cells; NaN for a null.
fn cells<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    count: usize,
    into: &mut Vec<f64>,
    value_of: impl Fn(usize, &T::T) -> Result<f64, RowsError>,
) -> Result<(), RowsError> {
    let (mut present, mut values) = (Vec::new(), Vec::new());
    let (records, read, _) = reader.read_records(count, Some(&mut present), None, &mut values)?;
    if records != count {
        return Err(RowsError::NoParquet(format!("a column ends {} rows early", count - records)));
    }
    // A column that requires values has no levels.
    let all_present = present.is_empty() && read == values.len();
    let mut next = values.iter();
    for row in 0..count {
        let value = if all_present || present.get(row) == Some(&1) {
            let value = next.next().ok_or_else(|| RowsError::NoParquet("a column lacks values".to_owned()))?;
            value_of(row, value)?
        } else {
            f64::NAN
        };
        into.push(value);
    }
    Ok(())
}

impl RowReader for ParquetRows {
    fn names(&self) -> Option<&[String]> {
        Some(&self.names)
    }

    fn width(&self) -> usize {
        self.names.len()
    }

    fn text_columns(&mut self) -> Result<Vec<usize>, RowsError> {
        guarded(|| {
            let schema = self.file.metadata().file_metadata().schema_descr();
            let is_text = |place: &usize| {
                let column = schema.column(*place);
                column.physical_type() == Physical::BYTE_ARRAY || supported(&column, &self.names[*place]).is_err()
            };
            Ok((0..self.names.len()).filter(is_text).collect())
        })
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError> {
        guarded(|| self.read_block(wanted, rows, into))
    }
}

/// Writes Parquet: doubles, or text for labels.
pub(super) struct ParquetWriter<'a> {
    file: SerializedFileWriter<&'a mut (dyn Write + Send)>,
    columns: Vec<ColumnKind>,
    /// Rows of the row group to come.
    waiting: Vec<Vec<f64>>,
}

impl<'a> ParquetWriter<'a> {
    pub(super) fn new(out: &'a mut (dyn Write + Send), columns: Vec<ColumnKind>) -> std::io::Result<Self> {
        let fields: Result<Vec<Arc<Type>>, ParquetError> = columns.iter().map(field).collect();
        let schema = Type::group_type_builder("schema").with_fields(fields?).build()?;
        let properties = WriterProperties::builder().build();
        let file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
        Ok(Self { file, waiting: vec![Vec::new(); columns.len()], columns })
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for (kind, values) in self.columns.iter().zip(&mut self.waiting) {
            let Some(mut column) = group.next_column()? else { break };
            let levels: Vec<i16> = values.iter().map(|value| i16::from(!value.is_nan())).collect();
            let levels = kind.optional.then_some(&levels[..]);
            let present = values.iter().filter(|value| !kind.optional || !value.is_nan());
            match column.untyped() {
                ColumnWriter::ByteArrayColumnWriter(_) => {
                    let text = |value: &f64| kind.label(*value).map_or_else(|| value.to_string(), str::to_owned);
                    let texts: Vec<ByteArray> = present.map(|value| text(value).into_bytes().into()).collect();
                    column.typed::<ByteArrayType>().write_batch(&texts, levels, None)?;
                }
                _ => {
                    let numbers: Vec<f64> = present.copied().collect();
                    column.typed::<DoubleType>().write_batch(&numbers, levels, None)?;
                }
            }
            column.close()?;
            values.clear();
        }
        group.close()?;
        Ok(())
    }
}

fn field(column: &ColumnKind) -> Result<Arc<Type>, ParquetError> {
    let (physical, logical) = match column.labels.is_empty() {
        true => (Physical::DOUBLE, None),
        false => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.optional { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let field = Type::primitive_type_builder(&column.name, physical).with_repetition(repetition);
    Ok(Arc::new(field.with_logical_type(logical).build()?))
}

impl RowWriter for ParquetWriter<'_> {
    fn write(&mut self, columns: &[&[f64]]) -> std::io::Result<()> {
        for (waiting, values) in self.waiting.iter_mut().zip(columns) {
            waiting.extend_from_slice(values);
        }
        if self.waiting.first().is_some_and(|column| column.len() >= GROUP) {
            self.write_group()?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> std::io::Result<()> {
        if self.waiting.first().is_some_and(|column| !column.is_empty()) {
            self.write_group()?;
        }
        self.file.finish()?;
        Ok(())
    }
}
