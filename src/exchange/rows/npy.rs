//! Rows as NPY, the array file of NumPy: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.
//!
//! Written: version 1.0, little-endian doubles, two dimensions, C order. Read: versions 1 to 3, one or two dimensions,
//! C or Fortran order, doubles, floats, integers and booleans of either byte order.

use std::io::{BufWriter, Read, Seek, SeekFrom, Write};

use super::{ColumnKind, RowReader, RowWriter, RowsError};

const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// The header's length is a multiple of this, as NumPy has it.
const ALIGNMENT: usize = 64;

/// Longest header that is read: some hundred bytes are usual.
const MOST_HEADER: usize = 1 << 16;

/// The type of the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Element {
    big_endian: bool,
    /// `f`, `i`, `u` or `b`.
    kind: u8,
    /// Bytes.
    size: usize,
}

impl Element {
    /// From a description such as `<f8`.
    fn parse(text: &str) -> Option<Self> {
        let [order, kind, size] = *text.as_bytes() else { return None };
        let size = usize::from(size.checked_sub(b'0')?);
        let known = match kind {
            b'f' => matches!(size, 4 | 8),
            b'i' | b'u' => matches!(size, 1 | 2 | 4 | 8),
            b'b' => size == 1,
            _ => false,
        };
        (known && matches!(order, b'<' | b'>' | b'|' | b'=')).then_some(Self { big_endian: order == b'>', kind, size })
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

/// Reads NPY.
pub(super) struct NpyRows<R> {
    reader: R,
    element: Element,
    fortran: bool,
    rows: u64,
    width: usize,
    /// Where the numbers begin.
    start: u64,
    /// Rows read.
    read: u64,
    bytes: Vec<u8>,
}

fn refused(reason: impl Into<String>) -> RowsError {
    RowsError::NoNpy(reason.into())
}

impl<R: Read + Seek> NpyRows<R> {
    pub(super) fn new(mut reader: R) -> Result<Self, RowsError> {
        let length = reader.seek(SeekFrom::End(0))?;
        reader.rewind()?;
        let mut exactly = |bytes: &mut [u8]| {
            reader.read_exact(bytes).map_err(|error| match error.kind() {
                std::io::ErrorKind::UnexpectedEof => refused("it ends within its header"),
                _ => error.into(),
            })
        };
        let mut preamble = [0; 8];
        exactly(&mut preamble)?;
        if !preamble.starts_with(MAGIC) {
            return Err(refused("it does not begin as one"));
        }
        let (size, lead) = match preamble[6] {
            1 => {
                let mut size = [0; 2];
                exactly(&mut size)?;
                (usize::from(u16::from_le_bytes(size)), 10)
            }
            2 | 3 => {
                let mut size = [0; 4];
                exactly(&mut size)?;
                (u32::from_le_bytes(size) as usize, 12)
            }
            version => return Err(refused(format!("version {version} of the format is not known here"))),
        };
        if size > MOST_HEADER {
            return Err(refused(format!("its header of {size} bytes is longer than {MOST_HEADER}")));
        }
        let mut header = vec![0; size];
        exactly(&mut header)?;
        let header = String::from_utf8(header).map_err(|_| refused("its header is no text"))?;
        let (element, fortran, shape) = parse_header(&header)?;
        let (rows, width) = match shape[..] {
            [rows] => (rows, 1),
            [rows, width] => (rows, width),
            _ => return Err(refused(format!("it has {} dimensions: expected rows and columns", shape.len()))),
        };
        let start = lead + size as u64;
        let needed = rows.checked_mul(width).and_then(|n| n.checked_mul(element.size as u64));
        let there = length - start;
        if needed != Some(there) || width == 0 {
            return Err(refused(format!(
                "{rows} rows of {width} numbers of {} bytes should follow the header, but {there} bytes do",
                element.size
            )));
        }
        let width = usize::try_from(width).map_err(|_| refused("it has too many columns"))?;
        Ok(Self { reader, element, fortran, rows, width, start, read: 0, bytes: Vec::new() })
    }

    /// The `count` numbers from number `first` on, as they lie in the file.
    fn numbers(&mut self, first: u64, count: usize) -> Result<(), RowsError> {
        self.bytes.resize(count * self.element.size, 0);
        self.reader.seek(SeekFrom::Start(self.start + first * self.element.size as u64))?;
        Ok(self.reader.read_exact(&mut self.bytes)?)
    }
}

/// Type of the numbers, whether columns lie together, and shape: from a Python dictionary of literals.
fn parse_header(header: &str) -> Result<(Element, bool, Vec<u64>), RowsError> {
    let after = |key: &str| {
        [format!("'{key}':"), format!("\"{key}\":")]
            .iter()
            .find_map(|quoted| header.split_once(quoted.as_str()))
            .map(|(_, rest)| rest.trim_start())
            .ok_or_else(|| refused(format!("its header says no {key}")))
    };
    let text = after("descr")?;
    let quote = text.chars().next().filter(|quote| matches!(quote, '\'' | '"'));
    let described = quote.and_then(|quote| text[1..].split(quote).next());
    let element = described.and_then(Element::parse).ok_or_else(|| {
        let found: String = described.unwrap_or(text).chars().take(40).collect();
        refused(format!("its numbers are {found:?}: doubles, floats, integers and booleans are read"))
    })?;
    let order = after("fortran_order")?;
    let fortran = order.starts_with("True");
    if !fortran && !order.starts_with("False") {
        return Err(refused("its header says neither C nor Fortran order"));
    }
    let shape = after("shape")?.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    let numbers = shape.map(|(inside, _)| {
        inside.split(',').map(str::trim).filter(|n| !n.is_empty()).map(str::parse).collect::<Result<Vec<u64>, _>>()
    });
    let Some(Ok(shape)) = numbers else { return Err(refused("its header says no shape")) };
    Ok((element, fortran, shape))
}

impl<R: Read + Seek> RowReader for NpyRows<R> {
    fn names(&self) -> Option<&[String]> {
        None
    }

    fn width(&self) -> usize {
        self.width
    }

    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, into: &mut [Vec<f64>]) -> Result<usize, RowsError> {
        into.iter_mut().for_each(Vec::clear);
        let rows = (self.rows - self.read).min(rows as u64) as usize;
        let (element, first) = (self.element, self.read);
        if self.fortran {
            for ((place, _), column) in wanted.iter().zip(&mut *into) {
                self.numbers(*place as u64 * self.rows + first, rows)?;
                column.extend(self.bytes.chunks_exact(element.size).map(|bytes| element.value(bytes)));
            }
        } else {
            self.numbers(first * self.width as u64, rows * self.width)?;
            for ((place, _), column) in wanted.iter().zip(&mut *into) {
                let cells = self.bytes.chunks_exact(element.size).skip(*place).step_by(self.width);
                column.extend(cells.map(|bytes| element.value(bytes)));
            }
        }
        for ((place, kind), column) in wanted.iter().zip(&*into) {
            let unknown = |value: &f64| !kind.labels.is_empty() && !value.is_nan() && kind.label(*value).is_none();
            if let Some(row) = column.iter().position(unknown) {
                let numbers: Vec<String> = kind.labels.iter().map(|(label, n)| format!("{n} ({label})")).collect();
                return Err(RowsError::WrongCell {
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

/// Writes NPY.
pub(super) struct NpyWriter<'a> {
    out: BufWriter<&'a mut (dyn Write + Send)>,
    /// Rows still to come.
    left: u64,
}

impl<'a> NpyWriter<'a> {
    pub(super) fn new(out: &'a mut (dyn Write + Send), (rows, width): (u64, usize)) -> std::io::Result<Self> {
        let mut out = BufWriter::new(out);
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {width}), }}");
        let lead = MAGIC.len() + 4;
        let padded = (lead + header.len() + 1).next_multiple_of(ALIGNMENT) - lead - 1;
        header.push_str(&" ".repeat(padded - header.len()));
        header.push('\n');
        out.write_all(MAGIC)?;
        out.write_all(&[1, 0])?;
        out.write_all(&(header.len() as u16).to_le_bytes())?;
        out.write_all(header.as_bytes())?;
        Ok(Self { out, left: rows })
    }
}

impl RowWriter for NpyWriter<'_> {
    fn write(&mut self, columns: &[&[f64]]) -> std::io::Result<()> {
        let rows = columns.first().map_or(0, |column| column.len());
        for row in 0..rows {
            for column in columns {
                self.out.write_all(&column[row].to_le_bytes())?;
            }
        }
        self.left =
            self.left.checked_sub(rows as u64).ok_or_else(|| std::io::Error::other("more rows than announced"))?;
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> std::io::Result<()> {
        if self.left > 0 {
            return Err(std::io::Error::other("fewer rows than announced"));
        }
        self.out.flush()
    }
}
