//! Lines of text as the reader of CSV counts them.

use std::io::Read;

/// Most bytes of a line of CSV.
const LONGEST_LINE: usize = 16 << 20;

/// A text with `\n` for every end of line, also after the last one: what it takes for the reader of CSV to know which
/// line it has come to.
/// A line may have [`LONGEST_LINE`] bytes, so that a file without ends of lines takes no memory without end.
pub(super) struct PlainLines<R: Read> {
    bytes: std::iter::Peekable<std::io::Bytes<std::io::BufReader<R>>>,
    last: u8,
    /// Bytes of the line so far.
    length: usize,
    /// Whether the text ended without an end of line.
    unended: bool,
}

impl<R: Read> PlainLines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { bytes: std::io::BufReader::new(reader).bytes().peekable(), last: b'\n', length: 0, unended: false }
    }

    /// Whether the text, read to its end, lacks the end of its last line: it may have been cut short, within a number too.
    pub(super) fn is_unended(&self) -> bool {
        self.unended
    }

    fn next(&mut self) -> Option<std::io::Result<u8>> {
        match self.bytes.next() {
            Some(Ok(b'\r')) if matches!(self.bytes.peek(), Some(Ok(b'\n'))) => self.bytes.next(),
            None if self.last != b'\n' => {
                self.unended = true;
                Some(Ok(b'\n'))
            }
            next => next,
        }
    }
}

impl<R: Read> Read for PlainLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        for (filled, slot) in buffer.iter_mut().enumerate() {
            match self.next() {
                Some(byte) => {
                    *slot = byte?;
                    self.last = *slot;
                    self.length = if *slot == b'\n' { 0 } else { self.length + 1 };
                    if self.length > LONGEST_LINE {
                        let message = format!("a line of more than {} MiB", LONGEST_LINE >> 20);
                        return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, message));
                    }
                }
                None => return Ok(filled),
            }
        }
        Ok(buffer.len())
    }
}
