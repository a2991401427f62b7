//! What a program says on standard error: passed on, a few lines of it, and the last line kept for reasons.

use std::io::{Read, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::words::cut;

/// Lines that are passed on; the others are counted.
const MOST_LINES: u64 = 20;
/// Characters of a line that are passed on.
const MOST_LETTERS: usize = 400;

/// The standard error of all processes of a model, on its way to ours.
#[derive(Debug, Default)]
pub(super) struct Voice {
    lines: AtomicU64,
}

impl Voice {
    /// Passes on a line, unless there have been enough.
    pub(super) fn pass_on(&self, line: &str) {
        if self.lines.fetch_add(1, Ordering::Relaxed) < MOST_LINES {
            say(&format!("the program: {}", cut(line, MOST_LETTERS)));
        }
    }

    /// Reads what a process says until it ends, and leaves its last line in `last`.
    pub(super) fn listen(&self, mut from: impl Read, last: &Mutex<String>) {
        const LONGEST: usize = 4096;
        let (mut line, mut bytes) = (Vec::new(), [0; 4096]);
        loop {
            let count = match from.read(&mut bytes) {
                Ok(count) => count,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
                Err(_) => 0,
            };
            for &byte in &bytes[..count] {
                match byte {
                    b'\n' => self.take(&mut line, last),
                    _ if line.len() < LONGEST => line.push(byte),
                    // The rest of a long line is left out.
                    _ => (),
                }
            }
            if count == 0 {
                return self.take(&mut line, last);
            }
        }
    }

    fn take(&self, line: &mut Vec<u8>, last: &Mutex<String>) {
        let text = String::from_utf8_lossy(line).into_owned();
        line.clear();
        if !text.trim().is_empty() {
            self.pass_on(&text);
            text.trim().clone_into(&mut last.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }
}

impl Drop for Voice {
    fn drop(&mut self) {
        let left_out = self.lines.load(Ordering::Relaxed).saturating_sub(MOST_LINES);
        if left_out > 0 {
            let lines = if left_out == 1 { "line" } else { "lines" };
            say(&format!("the program: {left_out} more {lines} on standard error left out"));
        }
    }
}

/// A line on our standard error; there is nowhere to complain if that fails.
pub(super) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_line_with_words_is_kept() {
        let (voice, last) = (Voice::default(), Mutex::new(String::new()));
        voice.listen(&b"Traceback:\n  x\nValueError: \xff no\n\n  "[..], &last);
        assert_eq!(*last.lock().unwrap(), "ValueError: \u{fffd} no");
        assert_eq!(voice.lines.load(Ordering::Relaxed), 3);
    }

    #[test]
    fn a_flood_without_lines_takes_little_memory() {
        let (voice, last) = (Voice::default(), Mutex::new(String::new()));
        voice.listen(std::io::repeat(b'x').take(10_000_000), &last);
        assert_eq!(last.lock().unwrap().len(), 4096);
    }
}
