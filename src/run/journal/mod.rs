//! The journal of a run: a file of finished blocks with checksums that survives an abrupt end of the run.
//!
//! A journal is a header, which identifies the study, and records, which are only appended, each by one write. Reading
//! stops at a record that was cut short or damaged: it and all after it are evaluated again. The format is described in
//! `docs/reference/journal-format.md`.
//!
//! [`Runner::journal`](crate::Runner::journal) writes and resumes a journal; see `examples/interrupted.rs`.

mod error;
mod format;
mod identity;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

pub use error::{JournalError, JournalProblem};
pub use format::{Contents, read_journal};
pub(super) use format::{Reader, record, write_record};
pub(crate) use identity::differences;
use serde_json::Value;

use super::model_files::ModelFiles;
use super::{RowBlock, RunError};
use apportion_base::clock::Instant;
use apportion_base::files::{read_opened, read_whole};

/// Time between forced writes to the disk, the most that a power cut can lose (the death of the program loses none).
const SYNC_INTERVAL: Duration = Duration::from_secs(1);

/// How long to wait for a lock that another process holds.
const LOCK_PATIENCE: Duration = Duration::from_millis(500);

/// A journal open for appending, by one process at a time.
#[derive(Debug)]
pub(crate) struct Journal {
    writer: Mutex<Writer>,
    /// The model whose outputs are appended.
    files: Arc<ModelFiles>,
}

#[derive(Debug)]
struct Writer {
    file: File,
    /// Number of bytes in complete records.
    length: u64,
    synced: Instant,
}

impl Journal {
    /// Creates a journal at `path` with `header`, replacing an existing file.
    ///
    /// # Errors
    /// [`JournalError`] if the file cannot be written, or another run is writing it.
    pub fn create(path: &Path, header: &Value) -> Result<Self, JournalError> {
        refuse_no_file(path)?;
        // Truncate only once the lock is held: the file may belong to another run.
        let file = open_locked(path, true)?;
        let mut writer = Writer { file, length: 0, synced: Instant::now() };
        let mut buffer = Vec::new();
        format::write_header(&mut buffer, header);
        let written = writer.append(&buffer).and_then(|()| writer.file.sync_data());
        written.map_err(|error| JournalProblem::Unwritable(error).at(path))?;
        Ok(Self { writer: Mutex::new(writer), files: Arc::default() })
    }

    /// Opens the journal at `path` to resume it, and returns it with its contents. Anything after the last complete
    /// record is cut off.
    ///
    /// # Errors
    /// [`JournalError`] if the file cannot be read or written, is no journal, or another run is writing it.
    pub fn resume(path: &Path) -> Result<(Self, Contents), JournalError> {
        refuse_no_file(path)?;
        let mut file = open_locked(path, false)?;
        let bytes = read_opened(&mut file).map_err(|error| JournalProblem::Unreadable(error).at(path))?;
        let contents = read_journal(path, &bytes)?;
        let writer = Writer { file, length: contents.length, synced: Instant::now() };
        Ok((Self { writer: Mutex::new(writer), files: Arc::default() }, contents))
    }

    /// Returns a journal at `path`, an empty file, to which nothing can be written.
    #[cfg(test)]
    pub(super) fn read_only(path: &Path) -> Self {
        let file = File::open(path).expect("an empty file");
        Self { writer: Mutex::new(Writer { file, length: 0, synced: Instant::now() }), files: Arc::default() }
    }

    /// Sets the files of the model whose outputs are appended.
    pub fn with_files(self, files: &Arc<ModelFiles>) -> Self {
        Self { files: Arc::clone(files), ..self }
    }

    /// Appends a block, by one write: when this returns, the block survives the death of the program.
    ///
    /// # Errors
    /// [`RunError`] if the files of the model have changed, or the block cannot be written; the journal then ends with
    /// the previous record.
    pub fn append(&self, block: &RowBlock) -> Result<(), RunError> {
        self.files.check()?;
        let mut record = Vec::new();
        format::write_record(&mut record, block);
        let appended = self.writer.lock().unwrap_or_else(PoisonError::into_inner).append(&record);
        appended.map_err(|source| RunError::NotKept { source })
    }

    /// Forces all appended records to the disk.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn sync(&self) -> std::io::Result<()> {
        self.writer.lock().unwrap_or_else(PoisonError::into_inner).file.sync_data()
    }
}

impl Writer {
    fn append(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let about = self.file.metadata()?;
        #[cfg(unix)]
        let is_removed = std::os::unix::fs::MetadataExt::nlink(&about) == 0;
        #[cfg(not(unix))]
        let is_removed = false;
        if about.len() < self.length || is_removed {
            return Err(std::io::Error::other("another program has cut off or removed the journal"));
        }
        // The first write of a resumed journal overwrites the damaged end.
        if about.len() > self.length {
            self.file.set_len(self.length)?;
        }
        self.file.seek(SeekFrom::Start(self.length))?;
        if let Err(error) = self.file.write_all(bytes) {
            // If this fails too, the reader cuts off the rest.
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

/// Returns the path with `ending` after its full name, so that different journals get different companion files.
pub(crate) fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}

/// Refuses anything but a regular file: opening a pipe waits for its other end, and a device stores nothing.
fn refuse_no_file(path: &Path) -> Result<(), JournalError> {
    match std::fs::metadata(path) {
        Ok(there) if !there.is_file() => Err(JournalProblem::NoFile.at(path)),
        _ => Ok(()),
    }
}

/// Reads the journal at `path` without locking it.
///
/// # Errors
/// [`JournalError`] if the file cannot be read, or is no journal.
pub(crate) fn read_journal_file(path: &Path) -> Result<Contents, JournalError> {
    refuse_no_file(path)?;
    let bytes = read_whole(path).map_err(|error| JournalProblem::Unreadable(error).at(path))?;
    read_journal(path, &bytes)
}

/// Opens the journal at `path` and locks it; creates it if it is missing and `creates`.
fn open_locked(path: &Path, creates: bool) -> Result<File, JournalError> {
    let file = OpenOptions::new().create(creates).truncate(false).read(true).write(true).open(path);
    let problem = if creates { JournalProblem::Unwritable } else { JournalProblem::Unreadable };
    let file = file.map_err(|error| problem(error).at(path))?;
    lock(path, &file)?;
    Ok(file)
}

fn lock(path: &Path, file: &File) -> Result<(), JournalError> {
    let begin = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(()),
            // A child of the process that held the lock also holds it between fork and exec.
            Err(TryLockError::WouldBlock) if begin.elapsed() < LOCK_PATIENCE => thread::sleep(LOCK_PATIENCE / 50),
            Err(TryLockError::WouldBlock) => return Err(JournalProblem::InUse.at(path)),
            // Some file systems do not support locks.
            Err(TryLockError::Error(_)) => return Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
