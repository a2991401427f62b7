//! The engine in a web page. A page says in JSON what it wants ([`Request`]) and is answered in JSON: what a study is, the
//! result of a run, the sections of its document, the text of the study as it was changed.
//!
//! There is one export for calls and one for memory, both of whole numbers: no tool has to write the other side of the
//! border, which is some thirty lines of script (`crates/cli/templates/live/worker.js`). Strings travel in a buffer that belongs to this
//! side. The module asks nothing of its surroundings: it has no imports.

mod answer;

use std::cell::RefCell;

pub use answer::{Answer, Request, answer};

thread_local! {
    /// What is asked, then what is answered.
    static BUFFER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Room for `length` bytes of a request, and where it is.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    BUFFER.with_borrow_mut(|buffer| {
        buffer.clear();
        buffer.resize(length, 0);
        buffer.as_mut_ptr()
    })
}

/// Answers the request in the buffer; the length of the answer, which is where [`answered`] says.
#[unsafe(no_mangle)]
pub extern "C" fn call() -> usize {
    let request = BUFFER.take();
    let text = answer(&request);
    BUFFER.with_borrow_mut(|buffer| {
        *buffer = text.into_bytes();
        buffer.len()
    })
}

/// Where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    BUFFER.with_borrow(|buffer| buffer.as_ptr())
}
