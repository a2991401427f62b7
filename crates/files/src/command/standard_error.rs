//! The standard error of a program: passed on as messages, with the last line kept for reasons of failure.

use std::io::Read;
use std::sync::{Mutex, PoisonError};

use apportion::model::Messages;
use apportion::text::cut;

/// Maximum number of characters of a line that are passed on.
const MAX_LETTERS: usize = 400;

/// Passes on the standard error of a process until it ends, and stores its last line in `last`.
pub(super) fn listen(messages: &Messages, mut from: impl Read, last: &Mutex<String>) {
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
                b'\n' => take(messages, &mut line, last),
                _ if line.len() < LONGEST => line.push(byte),
                // The rest of a long line is dropped.
                _ => (),
            }
        }
        if count == 0 {
            return take(messages, &mut line, last);
        }
    }
}

fn take(messages: &Messages, line: &mut Vec<u8>, last: &Mutex<String>) {
    let text = String::from_utf8_lossy(line).into_owned();
    line.clear();
    if !text.trim().is_empty() {
        messages.send_printed(&format!("the program: {}", cut(&text, MAX_LETTERS)));
        text.trim().clone_into(&mut last.lock().unwrap_or_else(PoisonError::into_inner));
    }
}
