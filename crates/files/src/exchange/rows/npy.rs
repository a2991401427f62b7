//! Rows as NPY, the array file of NumPy: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.
//!
//! Written: version 1.0, little-endian doubles, two dimensions, C order. Read: versions 1 to 3, one or two dimensions,
//! C or Fortran order, doubles, floats, integers and booleans of either byte order.

use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};

use super::{ColumnKind, ReadOptions, RowReader, names_of_columns};
use crate::exchange::error::TableError;

/// The first bytes of such a file.
pub(super) const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// The header's length is a multiple of this, as in NumPy.
const ALIGNMENT: usize = 64;

/// Maximum length of a header that is read: some hundred bytes are usual.
const MAX_HEADER: usize = 1 << 16;

/// The type of the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Element {
    big_endian: bool,
    /// `f`, `i`, `u` or `b`.
    kind: u8,
    /// Number of bytes.
    size: usize,
}

impl Element {
    /// Parses a description such as `<f8`.
    fn parse(text: &str) -> Option<Self> {
        let [order, kind, size] = *text.as_bytes() else { return None };
        let is_read =
            matches!((kind, size), (b'f', b'4' | b'8') | (b'i' | b'u', b'1' | b'2' | b'4' | b'8') | (b'b', b'1'));
        let size = usize::from(size.checked_sub(b'0')?);
        (is_read && b"<>|=".contains(&order)).then_some(Self { big_endian: order == b'>', kind, size })
    }

    fn value(self, bytes: &[u8]) -> f64 {
        let mut wide = [0; 8];
        for (place, byte) in bytes.iter().enumerate() {
            // Little-endian from here on.
            wide[if self.big_endian { self.size - 1 - place } else { place }] = *byte;
        }
        let unsigned = u64::from_le_bytes(wide);
        match (self.kind, self.size) {
            (b'f', 4) => f64::from(f32::from_bits(unsigned as u32)),
            (b'f', _) => f64::from_bits(unsigned),
            (b'i', size) => {
                let unused = 64 - 8 * size as u32;
                ((unsigned << unused) as i64 >> unused) as f64
            }
            _ => unsigned as f64,
        }
    }
}

pub(super) struct NpyRows<R> {
    reader: R,
    names: Option<Vec<String>>,
    /// Numbers that mean a missing value.
    missing: Vec<f64>,
    element: Element,
    fortran: bool,
    rows: u64,
    width: usize,
    /// Position of the first number.
    start: u64,
    /// Number of rows read.
    read: u64,
    bytes: Vec<u8>,
}

fn refused(reason: impl std::fmt::Display) -> TableError {
    TableError::Refused(format!("not an NPY file that can be read: {reason}"))
}

impl<R: Read + Seek> NpyRows<R> {
    pub(super) fn new(mut reader: R, options: &ReadOptions) -> Result<Self, TableError> {
        let length = reader.seek(SeekFrom::End(0))?;
        reader.rewind()?;
        let version = header_bytes(&mut reader, MAGIC.len() + 2)?[MAGIC.len()];
        // Two bytes of the size of the header in the first version, four in the others.
        let bytes = header_bytes(&mut reader, if version == 1 { 2 } else { 4 })?;
        let size = bytes.iter().rev().fold(0, |size, byte| size << 8 | usize::from(*byte));
        if !(1..=3).contains(&version) || size > MAX_HEADER {
            return Err(refused(format!("its version is {version}, and its header has {size} bytes")));
        }
        let start = (MAGIC.len() + 2 + bytes.len() + size) as u64;
        let header = header_bytes(&mut reader, size)?;
        let header = String::from_utf8(header).map_err(|_| refused("its header is not text"))?;
        let (element, fortran, shape) = parse_header(&header)?;
        let (rows, width) = match shape[..] {
            [rows] => (rows, 1),
            [rows, width] => (rows, width),
            _ => return Err(refused(format!("it has {} dimensions: expected rows and columns", shape.len()))),
        };
        let needed = rows.checked_mul(width).and_then(|n| n.checked_mul(element.size as u64));
        let rest = length - start;
        if needed != Some(rest) || width == 0 {
            let size = element.size;
            return Err(refused(format!(
                "{rows} rows of {width} numbers of {size} bytes should follow the header, but {rest} bytes do"
            )));
        }
        let width = usize::try_from(width).map_err(|_| refused("it has too many columns"))?;
        let (names, missing) = (names_of_columns(&options.names, width)?, options.missing.clone());
        Ok(Self { reader, names, missing, element, fortran, rows, width, start, read: 0, bytes: Vec::new() })
    }

    /// Reads `count` numbers from number `first` on, in the order of the file.
    fn numbers(&mut self, first: u64, count: usize) -> Result<(), TableError> {
        self.bytes.resize(count * self.element.size, 0);
        self.reader.seek(SeekFrom::Start(self.start + first * self.element.size as u64))?;
        Ok(self.reader.read_exact(&mut self.bytes)?)
    }
}

fn header_bytes(reader: &mut impl Read, count: usize) -> Result<Vec<u8>, TableError> {
    let mut bytes = vec![0; count];
    match reader.read_exact(&mut bytes) {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Err(refused("it ends within its header")),
        read => Ok(read.map(|()| bytes)?),
    }
}

/// Returns the text after a key of the header.
fn after<'a>(header: &'a str, key: &str) -> Result<&'a str, TableError> {
    let rest = header.split_once(&format!("'{key}':")).map(|(_, rest)| rest.trim_start());
    rest.ok_or_else(|| refused(format!("its header has no `{key}`")))
}

/// Parses the type of the numbers, whether columns are contiguous, and the shape, from a Python dictionary of literals.
fn parse_header(header: &str) -> Result<(Element, bool, Vec<u64>), TableError> {
    let header = header.replace('"', "'");
    let described =
        after(&header, "descr")?.strip_prefix('\'').and_then(|text| text.split('\'').next()).unwrap_or_default();
    let element = Element::parse(described).ok_or_else(|| {
        let described: String = described.chars().take(40).collect();
        refused(format!("its numbers are {described:?}: doubles, floats, integers and booleans are read"))
    })?;
    let fortran = after(&header, "fortran_order")?.starts_with("True");
    let shape =
        after(&header, "shape")?.strip_prefix('(').and_then(|rest| rest.split_once(')')).map(|(inside, _)| inside);
    let numbers = shape.unwrap_or_default().split(',').map(str::trim).filter(|n| !n.is_empty());
    let shape: Result<Vec<u64>, _> = numbers.map(str::parse).collect();
    Ok((element, fortran, shape.map_err(|_| refused("its header has no `shape`"))?))
}

impl<R: Read + Seek> RowReader for NpyRows<R> {
    fn names(&self) -> Option<&[String]> {
        self.names.as_deref()
    }

    fn width(&self) -> usize {
        self.width
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, to: &mut [Vec<f64>]) -> Result<usize, TableError> {
        to.iter_mut().for_each(Vec::clear);
        let rows = (self.rows - self.read).min(rows as u64) as usize;
        let (element, first) = (self.element, self.read);
        if !self.fortran {
            self.numbers(first * self.width as u64, rows * self.width)?;
        }
        for ((place, kind), column) in wanted.iter().zip(to) {
            let (skipped, step) = if self.fortran { (0, 1) } else { (*place, self.width) };
            if self.fortran {
                self.numbers(*place as u64 * self.rows + first, rows)?;
            }
            let cells = self.bytes.chunks_exact(element.size).skip(skipped).step_by(step);
            let values = cells.map(|bytes| element.value(bytes));
            column.extend(values.map(|value| if self.missing.contains(&value) { f64::NAN } else { value }));
            if kind.labels.is_empty() {
                continue;
            }
            if let Some(row) = column.iter().position(|value| !value.is_nan() && kind.label(*value).is_none()) {
                let numbers: Vec<String> = kind.labels.iter().map(|(label, n)| format!("{n} ({label})")).collect();
                return Err(TableError::WrongCell {
                    row: first + row as u64 + 1,
                    line: None,
                    column: place + 1,
                    name: format!("number {}", place + 1),
                    expected: format!("one of {}", numbers.join(", ")),
                    found: column[row].to_string(),
                });
            }
        }
        self.read += rows as u64;
        Ok(rows)
    }
}

/// Writes what precedes the numbers.
pub(super) fn write_header(out: &mut impl Write, rows: u64, width: usize) -> std::io::Result<()> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {width}), }}");
    let lead = MAGIC.len() + 4;
    let padded = (lead + header.len() + 1).next_multiple_of(ALIGNMENT) - lead - 1;
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(padded as u16 + 1).to_le_bytes())?;
    writeln!(out, "{header:<padded$}")
}
