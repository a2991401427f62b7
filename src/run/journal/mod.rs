//! The journal of a run: a file of finished pieces with checksums, that survives whatever ends the run.
//!
//! A journal is a header, which says of which study it is, and records, which are only ever appended, each by one write. A
//! record that was cut short or damaged ends what is read: it and all after it are evaluated again. The format is
//! described in `docs/journal-format.md`.
//!
//! [`Runner::journal`](crate::Runner::journal) keeps a journal, and goes on with one; `examples/interrupted.rs` is a program
//! that does so.

mod error;
mod format;
mod identity;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

pub use error::JournalError;
pub use format::{Contents, read_journal};
pub(super) use format::{record, write_record};
pub use identity::differences;
use serde_json::Value;

use super::Piece;
use crate::clock::Instant;
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
        let file = open_locked(path, true)?;
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
        let mut file = open_locked(path, false)?;
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
        let mut writer = self.writer.lock().unwrap_or_else(PoisonError::into_inner);
        let mut buffer = std::mem::take(&mut writer.buffer);
        buffer.clear();
        format::write_record(&mut buffer, piece);
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

/// The path with `ending` behind its whole name: journals whose names differ have others beside them whose names differ.
pub(crate) fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
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

/// Opens the journal at `path` and locks it; a new one if it is not there and `creates`.
fn open_locked(path: &Path, creates: bool) -> Result<File, JournalError> {
    let file = OpenOptions::new().create(creates).truncate(false).read(true).write(true).open(path);
    let wrong = if creates { JournalError::unwritable } else { JournalError::unreadable };
    let file = file.map_err(|source| wrong(path, source))?;
    lock(path, &file)?;
    Ok(file)
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
