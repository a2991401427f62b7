//! What the reader of Parquet does not check of damaged files: counts of values before it allocates for them (of 2^50 in a page it
//! would ask for as much memory, and a failed allocation ends the program), and the end of the file where it skips over fields
//! of a header (a list of 2^31 numbers in a file that ends there would be skipped one by one).

use std::io::{self, Read};

use bytes::Bytes;
use parquet::basic::Encoding;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};

/// A file whose end is an error to whoever reads on.
pub(super) struct Ending<R>(pub R);

impl<R: Length> Length for Ending<R> {
    fn len(&self) -> u64 {
        self.0.len()
    }
}

impl<R: ChunkReader> ChunkReader for Ending<R> {
    type T = Ending<R::T>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        Ok(Ending(self.0.get_read(start)?))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        self.0.get_bytes(start, length)
    }
}

impl<R: Read> Read for Ending<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self.0.read(into)? {
            0 if !into.is_empty() => Err(io::ErrorKind::UnexpectedEof.into()),
            count => Ok(count),
        }
    }
}

/// The pages of a column, none of which claims more values than it can have.
pub(super) struct CheckedPages {
    pub pages: Box<dyn PageReader>,
    /// Whether a cell may be null, so that the values come after definition levels.
    pub has_levels: bool,
}

impl Iterator for CheckedPages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Result<Page>> {
        self.get_next_page().transpose()
    }
}

impl PageReader for CheckedPages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        match page.as_ref().is_none_or(|page| is_sound(page, self.has_levels)) {
            true => Ok(page),
            false => Err(ParquetError::General("a page claims more values than it can have".to_owned())),
        }
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }
}

fn is_sound(page: &Page, has_levels: bool) -> bool {
    let (values, encoding, count) = match page {
        // Each value of a dictionary takes four bytes or more.
        Page::DictionaryPage { buf, num_values, .. } => return *num_values as usize <= buf.len() / 4,
        Page::DataPage { buf, num_values, encoding, def_level_encoding, .. } => {
            let levels = match (has_levels, def_level_encoding) {
                (false, _) => Some(0),
                // A length in four bytes stands before them.
                (true, Encoding::RLE) => {
                    let length = buf.first_chunk().map(|length| u32::from_le_bytes(*length) as usize);
                    length.and_then(|length| length.checked_add(4))
                }
                (true, _) => Some(num_values.div_ceil(8) as usize),
            };
            (levels.and_then(|levels| buf.get(levels..)), encoding, num_values)
        }
        Page::DataPageV2 { buf, num_values, encoding, def_levels_byte_len, rep_levels_byte_len, .. } => {
            let levels = def_levels_byte_len.checked_add(*rep_levels_byte_len);
            (levels.and_then(|levels| buf.get(levels as usize..)), encoding, num_values)
        }
    };
    let Some(values) = values else { return false };
    match encoding {
        Encoding::DELTA_BINARY_PACKED | Encoding::DELTA_LENGTH_BYTE_ARRAY => behind_deltas(values, *count).is_some(),
        // The lengths of what is shared with the value before, and then those of the rest.
        Encoding::DELTA_BYTE_ARRAY => {
            behind_deltas(values, *count).is_some_and(|rest| behind_deltas(rest, *count).is_some())
        }
        _ => true,
    }
}

/// What follows integers in the encoding DELTA_BINARY_PACKED, of which there are at most `most`.
fn behind_deltas(mut bytes: &[u8], most: u32) -> Option<&[u8]> {
    let [block, blocks, count, _first] =
        [(); 4].map(|()| number(&mut bytes)).into_iter().collect::<Option<Vec<u64>>>()?.try_into().ok()?;
    if count > u64::from(most) {
        return None;
    }
    let (blocks, in_each) = (usize::try_from(blocks).ok()?, block.checked_div(blocks)?);
    let mut left = count.saturating_sub(1);
    while left > 0 {
        if in_each == 0 {
            return None;
        }
        number(&mut bytes)?;
        let (widths, mut rest) = bytes.split_at_checked(blocks)?;
        for width in widths {
            if left == 0 {
                // Behind the last value widths say nothing.
                break;
            }
            let length = u64::from(*width).checked_mul(in_each)? / 8;
            rest = rest.get(usize::try_from(length).ok()?..)?;
            left = left.saturating_sub(in_each);
        }
        bytes = rest;
    }
    Some(bytes)
}

/// An unsigned number of seven bits a byte (LEB128); those with a sign take as many bytes.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for place in 0..10 {
        let (byte, rest) = bytes.split_first()?;
        *bytes = rest;
        value |= u64::from(byte & 0x7f).checked_shl(7 * place)?;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}
