//! Text prepared for the CSV reader: in UTF-8, with one kind of line end, and one separator of cells.

use std::io::{BufRead, BufReader, Cursor, Error, ErrorKind, Read, Result};

use apportion_base::files::MAX_STREAM_BYTES;

use super::csv_rows::NETLOGO;

/// Maximum number of bytes of a line, so that a file without line ends does not exhaust the memory.
const LONGEST_LINE: usize = 16 << 20;

/// Maximum number of bytes at the beginning of a text that are examined to find the separator of its cells.
const LONGEST_BEGINNING: usize = 1 << 16;

/// A text with `\n` at the end of every line, also after the last one.
pub(super) struct Lines {
    reader: BufReader<Box<dyn Read>>,
    /// The separator of the cells in the returned lines.
    pub separator: u8,
    /// Whether any number of blanks separates cells; they become one tab.
    blanks: bool,
    line: Vec<u8>,
    /// Number of bytes of the line that have been returned.
    given: usize,
    /// Whether the text ended without a line end.
    unended: bool,
}

impl Lines {
    /// Creates the lines of a text in UTF-8, or in UTF-16 with a byte-order mark.
    pub(super) fn new(mut reader: Box<dyn Read>) -> Result<Self> {
        let mut begin = beginning(&mut reader)?;
        if begin.starts_with(b"\xff\xfe") || begin.starts_with(b"\xfe\xff") {
            reader = Box::new(Cursor::new(utf16(begin, reader)?));
            begin = beginning(&mut reader)?;
        }
        if begin.starts_with(b"\xef\xbb\xbf") {
            begin.drain(..3);
        }
        let separator = separator(&begin);
        let reader: Box<dyn Read> = Box::new(Cursor::new(begin).chain(reader));
        Ok(Self {
            reader: BufReader::new(reader),
            separator: if separator == b' ' { b'\t' } else { separator },
            blanks: separator == b' ',
            line: Vec::new(),
            given: 0,
            unended: false,
        })
    }

    /// Returns whether the last line of the text, read to its end, has no line end: it may have been cut short.
    pub(super) fn is_unended(&self) -> bool {
        self.unended
    }

    fn next_line(&mut self) -> Result<()> {
        self.line.clear();
        self.given = 0;
        let count = (&mut self.reader).take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut self.line)?;
        if count > LONGEST_LINE {
            let message = format!("a line of more than {} MiB", LONGEST_LINE >> 20);
            return Err(Error::new(ErrorKind::InvalidData, message));
        }
        if self.line.ends_with(b"\r\n") {
            self.line.truncate(count - 2);
            self.line.push(b'\n');
        } else if count > 0 && !self.line.ends_with(b"\n") {
            self.unended = true;
            self.line.push(b'\n');
        }
        if self.blanks {
            let cells = self.line.split(|byte| matches!(byte, b' ' | b'\t' | b'\n'));
            let mut line = cells.filter(|cell| !cell.is_empty()).collect::<Vec<_>>().join(&b'\t');
            line.extend((count > 0).then_some(b'\n'));
            self.line = line;
        }
        Ok(())
    }
}

impl Read for Lines {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        if self.given == self.line.len() {
            self.next_line()?;
        }
        let count = buffer.len().min(self.line.len() - self.given);
        buffer[..count].copy_from_slice(&self.line[self.given..][..count]);
        self.given += count;
        Ok(count)
    }
}

/// Reads the beginning of a text, at least to the end of its second line that is not a comment.
fn beginning(reader: &mut dyn Read) -> Result<Vec<u8>> {
    let (mut begin, mut part) = (Vec::new(), [0; 4096]);
    while begin.len() < LONGEST_BEGINNING && plain_lines(&begin).count() < 3 {
        match reader.read(&mut part) {
            Ok(0) => break,
            Ok(count) => begin.extend_from_slice(&part[..count]),
            Err(error) if error.kind() == ErrorKind::Interrupted => (),
            Err(error) => return Err(error),
        }
    }
    Ok(begin)
}

/// Iterates over the lines that are neither empty nor comments.
fn plain_lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty() && !line.starts_with(b"#"))
}

/// Detects the separator of the cells from the beginning of a text: that of `sep=` in the first line, as in
/// spreadsheets; else a comma, a semicolon or a tab outside quotes; else blanks, if the first two lines have equally
/// many. NetLogo's tables have commas, which their first lines do not show.
fn separator(begin: &[u8]) -> u8 {
    let mut lines = plain_lines(begin);
    let first = lines.next().unwrap_or_default();
    // After `sep=` a tab is trimmed.
    if let [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', rest @ ..] = first
        && rest.len() < 2
    {
        return rest.first().copied().unwrap_or(b'\t');
    }
    if first.trim_ascii_start().strip_prefix(b"\"").unwrap_or(first).starts_with(NETLOGO.as_bytes()) {
        return b',';
    }
    let mut quoted = false;
    let mut outside = first.iter().filter(|byte| {
        quoted ^= **byte == b'"';
        !quoted
    });
    let separators: Vec<u8> = outside.by_ref().copied().filter(|byte| matches!(byte, b',' | b';' | b'\t')).collect();
    if let Some(first) = separators.iter().find(|byte| **byte == b',').or(separators.first()) {
        return *first;
    }
    let second = lines.next().filter(|second| !second.contains(&b','));
    let has_blanks = cell_count(first) > 1 && second.is_none_or(|second| cell_count(second) == cell_count(first));
    let is_text = second.is_none() && first.iter().any(u8::is_ascii_alphabetic);
    if has_blanks && !is_text { b' ' } else { b',' }
}

/// Returns the number of cells of a line if blanks separate them.
fn cell_count(line: &[u8]) -> usize {
    line.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty()).count()
}

/// Converts a text in UTF-16 with this beginning to bytes of UTF-8.
fn utf16(begin: Vec<u8>, rest: Box<dyn Read>) -> Result<Vec<u8>> {
    let mut bytes = begin;
    rest.take(MAX_STREAM_BYTES).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_STREAM_BYTES {
        let message = format!("a text in UTF-16 of more than {} MiB: save it as UTF-8", MAX_STREAM_BYTES >> 20);
        return Err(Error::new(ErrorKind::InvalidData, message));
    }
    let of_pair = if bytes[0] == 0xff { u16::from_le_bytes } else { u16::from_be_bytes };
    let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| of_pair([pair[0], pair[1]])).collect();
    String::from_utf16(&units).map(String::into_bytes).map_err(|_| {
        let message = "its first bytes say UTF-16, but it is not text in UTF-16: save it as UTF-8";
        Error::new(ErrorKind::InvalidData, message)
    })
}
