//! The files of a command: what it reads, what it writes, and which existing files it may replace.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use apportion_base::digest::sha256_of_file;
use apportion_base::files::real_path;
use thiserror::Error;

use super::ArtefactError;
use super::atomic_write::{WriteError, prepare_file};

/// A file that may not be written, and why.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Refusal {
    /// The command reads it, or writes it already.
    #[error("{}: this is an input file or another output of the command: choose another name or folder", .0.display())]
    Taken(PathBuf),
    /// It exists, and the list of its folder does not have it with this content.
    #[error("{}: this file exists, and it is not an unchanged result: choose another name or folder", .0.display())]
    Exists(PathBuf),
}

/// Checks that no output of a command is one of its inputs, or another output, or an existing file that it may not
/// replace. Links are followed; empty files, devices and pipes hold nothing to lose.
///
/// # Errors
/// [`Refusal`] for the first such output.
pub(super) fn check_outputs(
    inputs: &[PathBuf],
    outputs: &[PathBuf],
    replaces: &dyn Fn(&Path) -> bool,
) -> Result<(), Refusal> {
    let mut taken: Vec<PathBuf> = inputs.iter().map(|input| comparable(input)).collect();
    for path in outputs {
        let (real, existing) = (comparable(path), std::fs::metadata(path).ok());
        if existing.as_ref().is_some_and(|existing| !existing.is_file()) {
            continue;
        }
        if taken.contains(&real) {
            return Err(Refusal::Taken(path.clone()));
        }
        if existing.is_some_and(|existing| existing.len() > 0) && !replaces(path) {
            return Err(Refusal::Exists(path.clone()));
        }
        taken.push(real);
    }
    Ok(())
}

/// Does the same for files that must also be writable: see [`prepare_file`].
///
/// # Errors
/// [`ArtefactError`] with the reason.
pub fn prepare_outputs(inputs: &[PathBuf], outputs: &[PathBuf], replaces: bool) -> Result<(), ArtefactError> {
    check_outputs(inputs, outputs, &|_| replaces)?;
    Ok(outputs.iter().try_for_each(|output| prepare_file(output))?)
}

/// Returns the path by which a file is compared with others.
fn comparable(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    real_path(&absolute).unwrap_or(absolute)
}

/// The list of the files that commands have written for one result, a hidden file in its folder: a line for each content
/// that a file has had, with its SHA-256. It is locked while they are written, so that the files of two runs are not
/// mixed.
pub struct FileList {
    folder: PathBuf,
    /// The list, once it is open.
    file: Option<File>,
    text: String,
}

impl FileList {
    /// Reads the list of the result called `name` in `folder`; a missing one is empty.
    pub fn read(folder: &Path, name: &str) -> Self {
        let text = std::fs::read_to_string(list_path(folder, name)).unwrap_or_default();
        Self { folder: comparable(folder), file: None, text }
    }

    /// Opens it to add files, once no other process has it open.
    ///
    /// # Errors
    /// [`WriteError`] if it cannot be written.
    pub fn open(folder: &Path, name: &str) -> Result<Self, WriteError> {
        let path = list_path(folder, name);
        let file = File::options().create(true).append(true).open(&path);
        let file = file.map_err(|source| WriteError { path, source })?;
        // Some file systems have no locks.
        let _ = file.lock();
        Ok(Self { file: Some(file), ..Self::read(folder, name) })
    }

    /// Returns whether the file at `path` is listed with its present content.
    pub fn contains(&self, path: &Path) -> bool {
        sha256_of_file(path).is_ok_and(|digest| self.text.contains(&self.line(path, &digest)))
    }

    /// Adds a file that is about to have this digest.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn add(&self, path: &Path, digest: &str) -> std::io::Result<()> {
        let line = self.line(path, digest);
        let file = self.file.as_ref().filter(|_| !self.text.contains(&line));
        // By one write: files are added by several threads.
        file.map_or(Ok(()), |mut file| file.write_all(line.as_bytes()))
    }

    fn line(&self, path: &Path, digest: &str) -> String {
        let real = comparable(path);
        format!("{digest}  {}\n", real.strip_prefix(&self.folder).unwrap_or(&real).display())
    }
}

fn list_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!(".{name}.written"))
}
