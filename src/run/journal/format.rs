//! The bytes of a journal. All numbers are little-endian.
//!
//! Header: `apportion journal` (17 bytes), version (u32), length of the JSON text (u32), its CRC-32 (u32), the text. Records
//! follow: length of the body (u32), CRC-32 of those four bytes and the body (u32), the body.

use std::path::Path;

use serde_json::Value;

use super::error::{JournalError, JournalProblem};
use crate::model::{CounterKind, Counts, RowFailure};
use crate::run::RowBlock;

const MAGIC: &[u8] = b"apportion journal";
const VERSION: u32 = 1;

/// Bytes that remain to be read.
pub(in crate::run) struct Reader<'a> {
    pub bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Returns the next `count` bytes, or `None` if fewer remain.
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(taken)
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn u64(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }
}

/// The contents of a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents {
    /// The identity of its study.
    pub header: Value,
    /// Its blocks, in the order in which they were written: later ones replace earlier ones.
    pub blocks: Vec<RowBlock>,
    /// Bytes up to the end of the last complete record.
    pub length: u64,
    /// Bytes after it: a record that was cut short or damaged, and everything that follows.
    pub cut_off: u64,
}

pub(super) fn write_header(out: &mut Vec<u8>, header: &Value) {
    let text = header.to_string();
    out.extend_from_slice(MAGIC);
    for number in [VERSION, text.len() as u32, crc32fast::hash(text.as_bytes())] {
        out.extend_from_slice(&number.to_le_bytes());
    }
    out.extend_from_slice(text.as_bytes());
}

/// Appends a block as a record.
pub(in crate::run) fn write_record(out: &mut Vec<u8>, block: &RowBlock) {
    let begin = out.len();
    out.extend_from_slice(&[0; 8]);
    for number in [block.replicate, block.first, block.values.len() as u64] {
        out.extend_from_slice(&number.to_le_bytes());
    }
    block.values.iter().for_each(|value| out.extend_from_slice(&value.to_bits().to_le_bytes()));
    out.extend_from_slice(&(block.failures.len() as u32).to_le_bytes());
    for (row, output, why) in &block.failures {
        let why = why.to_string();
        for number in [*row, *output, why.len() as u32] {
            out.extend_from_slice(&number.to_le_bytes());
        }
        out.extend_from_slice(why.as_bytes());
    }
    out.extend_from_slice(&(block.flags.len() as u32).to_le_bytes());
    block.flags.iter().for_each(|raised| out.extend_from_slice(&raised.to_le_bytes()));
    out.extend_from_slice(&(block.counts.0.len() as u64).to_le_bytes());
    for (kind, value) in &block.counts.0 {
        out.push(u8::from(*kind == CounterKind::Maximum));
        out.extend_from_slice(&value.to_le_bytes());
    }
    let length = ((out.len() - begin - 8) as u32).to_le_bytes();
    out[begin..begin + 4].copy_from_slice(&length);
    let checksum = checksum(&length, &out[begin + 8..]).to_le_bytes();
    out[begin + 4..begin + 8].copy_from_slice(&checksum);
}

/// Computes the checksum. It covers the length: zeros, which some file systems leave after a power cut, are invalid.
fn checksum(length: &[u8], body: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(length);
    hasher.update(body);
    hasher.finalize()
}

/// Reads the bytes of a journal; `path` is for messages.
///
/// # Errors
/// [`JournalError`] if it is no journal, or of another version. Damaged records are cut off.
pub fn read_journal(path: &Path, bytes: &[u8]) -> Result<Contents, JournalError> {
    let mut reader = Reader { bytes };
    let header = header(&mut reader).map_err(|problem| problem.at(path))?;
    let mut blocks = Vec::new();
    let mut cut_off = reader.bytes.len();
    while let Some(block) = record(&mut reader) {
        blocks.push(block);
        cut_off = reader.bytes.len();
    }
    Ok(Contents { header, blocks, length: (bytes.len() - cut_off) as u64, cut_off: cut_off as u64 })
}

fn header(reader: &mut Reader<'_>) -> Result<Value, JournalProblem> {
    const CUT_SHORT: &str = "its header is cut short";
    if reader.bytes.is_empty() {
        return Err(JournalProblem::invalid("the file is empty"));
    }
    if reader.take(MAGIC.len()) != Some(MAGIC) {
        return Err(JournalProblem::invalid("it does not begin like a journal"));
    }
    match reader.u32() {
        Some(VERSION) => (),
        Some(version) => return Err(JournalProblem::OtherFormat(version)),
        None => return Err(JournalProblem::invalid(CUT_SHORT)),
    }
    let Some((checksum, text)) = header_text(reader) else { return Err(JournalProblem::invalid(CUT_SHORT)) };
    if crc32fast::hash(text) != checksum {
        return Err(JournalProblem::invalid("its header is damaged"));
    }
    serde_json::from_slice(text).map_err(|error| JournalProblem::invalid(&error.to_string()))
}

/// Returns the checksum and the text of the header.
fn header_text<'a>(reader: &mut Reader<'a>) -> Option<(u32, &'a [u8])> {
    let (length, checksum) = (reader.u32()?, reader.u32()?);
    Some((checksum, reader.take(length as usize)?))
}

/// Reads the next record, if it is complete.
pub(in crate::run) fn record(reader: &mut Reader<'_>) -> Option<RowBlock> {
    let (length, expected) = (reader.u32()?, reader.u32()?);
    let body = reader.take(length as usize)?;
    if checksum(&length.to_le_bytes(), body) != expected {
        return None;
    }
    let mut reader = Reader { bytes: body };
    let block = block(&mut reader)?;
    reader.bytes.is_empty().then_some(block)
}

/// Maximum number of rows in a replicate of a journal: more than any design has, and too few to overflow sums.
const MAX_ROWS: u64 = 1 << 60;

fn block(reader: &mut Reader<'_>) -> Option<RowBlock> {
    let (replicate, first, count) = (reader.u64()?, reader.u64()?, reader.u64()?);
    if first > MAX_ROWS {
        return None;
    }
    let values = reader.take(usize::try_from(count).ok()?.checked_mul(8)?)?;
    let values = values.as_chunks().0.iter().map(|bytes| f64::from_bits(u64::from_le_bytes(*bytes))).collect();
    let mut failures = Vec::new();
    for _ in 0..reader.u32()? {
        let (row, output, length) = (reader.u32()?, reader.u32()?, reader.u32()?);
        let why = std::str::from_utf8(reader.take(length as usize)?).ok()?;
        failures.push((row, output, RowFailure::new(why)));
    }
    let flags = (0..reader.u32()?).map(|_| reader.u64()).collect::<Option<_>>()?;
    let mut counts = Vec::new();
    for _ in 0..reader.u64()? {
        let kind = match reader.take(1)? {
            [0] => CounterKind::Sum,
            [1] => CounterKind::Maximum,
            _ => return None,
        };
        counts.push((kind, f64::from_bits(reader.u64()?)));
    }
    Some(RowBlock { replicate, first, values, failures, flags, counts: Counts(counts) })
}
