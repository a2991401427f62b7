//! A journal of sums: one checkpoint, which the next one replaces as a whole.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::{Journal, JournalError, format, lock, refuse_no_file, with_ending};
use crate::binary::Binary;
use crate::run::Sums;

/// A journal of sums, open for checkpoints; no other process has it open at the same time. Its size does not grow with
/// the run, and whatever ends the program leaves the checkpoint before or the one after.
#[derive(Debug)]
pub struct Checkpoint {
    path: PathBuf,
    /// The header, as bytes.
    header: Vec<u8>,
    /// The file that is at the path, which is locked.
    file: Mutex<File>,
}

impl Checkpoint {
    /// Begins a journal at `path` with `header` and `sums`, in place of a file that is there.
    ///
    /// # Errors
    /// [`JournalError`] if the file cannot be written, or another run is writing it.
    pub fn create(path: &Path, header: &Value, sums: &Sums) -> Result<Self, JournalError> {
        let checkpoint = Journal::create(path, header)?.into_checkpoint(header);
        let mut bytes = Vec::new();
        sums.write(&mut bytes);
        checkpoint.write(&bytes).map_err(|source| JournalError::unwritable(path, source))?;
        Ok(checkpoint)
    }

    pub(super) fn new(path: &Path, file: File, header: &Value) -> Self {
        let mut bytes = Vec::new();
        format::write_sums_header(&mut bytes, header);
        Self { path: path.to_owned(), header: bytes, file: Mutex::new(file) }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Replaces the sums on record by `sums`, the bytes of [`Sums`].
    ///
    /// # Errors
    /// What the operating system says; the sums before are then still there.
    pub(crate) fn write(&self, sums: &[u8]) -> std::io::Result<()> {
        let mut locked = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let next = with_ending(&self.path, ".new");
        refuse_no_file(&next).map_err(std::io::Error::other)?;
        // Neither emptied nor removed unless the lock is held: the file may be another run's.
        let mut file = OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&next)?;
        lock(&next, &file).map_err(std::io::Error::other)?;
        let written = (|| {
            file.set_len(0)?;
            let mut bytes = self.header.clone();
            format::write_sums(&mut bytes, sums);
            file.write_all(&bytes)?;
            file.sync_data()?;
            std::fs::rename(&next, &self.path)
        })();
        match written {
            Ok(()) => *locked = file,
            // What stays behind is overwritten by the next checkpoint.
            Err(_) => drop(std::fs::remove_file(&next)),
        }
        written
    }
}
