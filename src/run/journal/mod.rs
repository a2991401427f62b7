//! The journal of a run: a file of finished pieces with checksums, that survives whatever ends the run.
//!
//! A journal is a header, which says of which study it is, and records, which are only ever appended, each by one write. A
//! record that was cut short or damaged ends what is read: it and all after it are evaluated again. The format is
//! described in `docs/journal-format.md`.
//!
//! The pieces of a journal go into a [`Store`](super::Store), and those that a run adds to the store into the journal
//! (`keep` of [`Running`](crate::Running)); `examples/interrupted.rs` is a program that does so. In short:
//!
//! ```
//! use std::path::Path;
//! use apportion::run::journal::Journal;
//! use apportion::run::{Piece, Store};
//! use apportion::study::Study;
//! use apportion::{Running, analyse_with};
//! use serde_json::json;
//!
//! let study = Study::parse("model = \"ishigami\"", Path::new("a.toml"), &["design.base_samples=256".to_owned()])?;
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("a.journal");
//!
//! let store = Store::new(&study.design, study.model().as_ref());
//! let journal = Journal::create(&path, &json!({ "identity": study.identity() }))?;
//! let keep = |piece: &Piece| journal.append(piece);
//! let first = analyse_with(&study, Running { store: Some(&store), keep: Some(&keep), ..Running::on(0) })?;
//! drop(journal);
//!
//! let (_journal, contents) = Journal::resume(&path)?;
//! let store = Store::new(&study.design, study.model().as_ref());
//! for piece in &contents.pieces {
//!     store.insert(piece);
//! }
//! // Nothing is evaluated.
//! let second = analyse_with(&study, Running { store: Some(&store), ..Running::on(0) })?;
//! assert_eq!(first.outputs, second.outputs);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod format;
mod identity;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

pub use error::JournalError;
pub use format::{Contents, Stretch, read_journal};
pub use identity::differences;

use super::Piece;
use crate::files::{read_opened, read_whole};

/// Time between forced writes to the disk: what a power cut may cost, at most. (The death of the program alone costs
/// nothing that was appended.)
const SYNC_INTERVAL: Duration = Duration::from_secs(1);

/// How long is waited for a lock that somebody else has.
const LOCK_PATIENCE: Duration = Duration::from_millis(500);

/// A journal open for appending; no other process has it open at the same time.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    writer: Mutex<Writer>,
}

#[derive(Debug)]
struct Writer {
    file: File,
    /// Bytes of whole records.
    length: u64,
    synced: Instant,
    buffer: Vec<u8>,
}

impl Journal {
    /// Begins a journal at `path` with `header`, in place of a file that is there.
    ///
    /// # Errors
    /// [`JournalError`] if the file cannot be written, or another run is writing it.
    pub fn create(path: &Path, header: &Value) -> Result<Self, JournalError> {
        refuse_no_file(path)?;
        // Truncated only once the lock is held: the file may be another run's.
        let file = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(path);
        let file = file.map_err(|source| JournalError::unwritable(path, source))?;
        lock(path, &file)?;
        let journal = Self::writing(path, file, 0);
        let mut buffer = Vec::new();
        format::write_header(&mut buffer, header);
        journal
            .write(&buffer)
            .and_then(|()| journal.sync())
            .map_err(|source| JournalError::unwritable(path, source))?;
        Ok(journal)
    }

    /// Opens the journal at `path` to go on with it: returns it with what it holds. What follows the last whole record is
    /// cut off.
    ///
    /// # Errors
    /// [`JournalError`] if the file cannot be read or written, is no journal, or another run is writing it.
    pub fn resume(path: &Path) -> Result<(Self, Contents), JournalError> {
        refuse_no_file(path)?;
        let file = OpenOptions::new().read(true).write(true).open(path);
        let mut file = file.map_err(|source| JournalError::unreadable(path, source))?;
        lock(path, &file)?;
        let bytes = read_opened(&mut file).map_err(|source| JournalError::unreadable(path, source))?;
        let contents = read_journal(path, &bytes)?;
        Ok((Self::writing(path, file, contents.length), contents))
    }

    fn writing(path: &Path, file: File, length: u64) -> Self {
        let writer = Writer { file, length, synced: Instant::now(), buffer: Vec::new() };
        Self { path: path.to_owned(), writer: Mutex::new(writer) }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a piece, by one write: when this returns, the death of the program does not lose it.
    ///
    /// # Errors
    /// What the operating system says; the journal then ends with the record before.
    pub fn append(&self, piece: &Piece) -> std::io::Result<()> {
        self.append_record(|buffer| format::write_record(buffer, piece))
    }

    /// Appends that the pieces from here on are evaluated with `files` of the model (path: digest).
    ///
    /// # Errors
    /// As for [`append`](Self::append).
    pub fn append_files(&self, files: &Value) -> std::io::Result<()> {
        self.append_record(|buffer| format::write_files(buffer, files))
    }

    fn append_record(&self, write: impl FnOnce(&mut Vec<u8>)) -> std::io::Result<()> {
        let mut writer = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        let mut buffer = std::mem::take(&mut writer.buffer);
        buffer.clear();
        write(&mut buffer);
        let written = writer.append(&buffer);
        writer.buffer = buffer;
        written
    }

    fn write(&self, bytes: &[u8]) -> std::io::Result<()> {
        let mut writer = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        writer.append(bytes)
    }

    /// Forces all that was appended to the disk.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn sync(&self) -> std::io::Result<()> {
        self.writer.lock().unwrap_or_else(PoisonError::into_inner).file.sync_data()
    }
}

impl Writer {
    fn append(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        // The first write of a resumed journal goes over what was cut off.
        if self.file.metadata()?.len() != self.length {
            self.file.set_len(self.length)?;
        }
        self.file.seek(SeekFrom::Start(self.length))?;
        if let Err(error) = self.file.write_all(bytes) {
            // If this fails too, the reader cuts the rest off.
            let _ = self.file.set_len(self.length);
            return Err(error);
        }
        self.length += bytes.len() as u64;
        if self.synced.elapsed() >= SYNC_INTERVAL {
            self.file.sync_data()?;
            self.synced = Instant::now();
        }
        Ok(())
    }
}

/// Opening a pipe waits for somebody at its other end, and a device keeps nothing.
fn refuse_no_file(path: &Path) -> Result<(), JournalError> {
    match std::fs::metadata(path) {
        Ok(there) if !there.is_file() => Err(JournalError::NoFile { path: path.to_owned() }),
        _ => Ok(()),
    }
}

/// Reads the journal at `path` without locking it.
///
/// # Errors
/// [`JournalError`] if the file cannot be read, or is no journal.
pub fn read_journal_file(path: &Path) -> Result<Contents, JournalError> {
    refuse_no_file(path)?;
    let bytes = read_whole(path).map_err(|source| JournalError::unreadable(path, source))?;
    read_journal(path, &bytes)
}

fn lock(path: &Path, file: &File) -> Result<(), JournalError> {
    let begin = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(()),
            // A child of the process that had it holds it too, between its birth and the program that it becomes.
            Err(TryLockError::WouldBlock) if begin.elapsed() < LOCK_PATIENCE => thread::sleep(LOCK_PATIENCE / 50),
            Err(TryLockError::WouldBlock) => return Err(JournalError::InUse { path: path.to_owned() }),
            // File systems without locks have none to respect.
            Err(TryLockError::Error(_)) => return Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
