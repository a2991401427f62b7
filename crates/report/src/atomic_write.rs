//! Atomic file writes: a reader sees the old file or the new one, never a part of one.

use std::io::ErrorKind::{IsADirectory, NotADirectory};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use apportion_base::files::{TEMPORARY, remove_left_overs};
use tempfile::NamedTempFile;
use thiserror::Error;

/// Why a file could not be written.
#[derive(Debug, Error)]
#[error("cannot write {path}: {source}", path = path.display())]
pub struct WriteError {
    /// The file or folder.
    pub path: PathBuf,
    /// The error of the operating system.
    pub source: io::Error,
}

/// Writes `bytes` to `path`: into a temporary file in the same folder, synced, then renamed over the target.
///
/// Symbolic links are followed, so they stay links; an existing file keeps its permissions. A device or a pipe is
/// written directly, since it must not be replaced.
///
/// # Errors
/// [`WriteError`]; the target is unchanged.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    stream_atomically(path, |file| file.write_all(bytes))
}

/// Like [`write_atomically`], for content that `write` produces piece by piece; returns what `write` returns.
///
/// # Errors
/// [`WriteError`]; the target is unchanged.
pub fn stream_atomically<T>(
    path: &Path,
    write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<T>,
) -> Result<T, WriteError> {
    let attempt = || {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let existing = std::fs::metadata(&target).ok();
        if existing.as_ref().is_some_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return write(&mut std::fs::OpenOptions::new().write(true).open(&target)?);
        }
        let mut file = temporary_in(folder_of(&target))?;
        let answer = write(file.as_file_mut())?;
        if let Some(metadata) = existing {
            file.as_file().set_permissions(metadata.permissions())?;
        }
        file.as_file().sync_all()?;
        file.persist(&target).map_err(|error| error.error)?;
        Ok(answer)
    };
    attempt().map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Creates the folder and checks that files can be created in it, so that a run fails in its first second and not in
/// its last. Removes the partial files of killed runs.
///
/// # Errors
/// [`WriteError`] if the folder cannot be made or written to.
pub fn prepare_folder(folder: &Path) -> Result<(), WriteError> {
    let attempt = || {
        if let Some(file) = folder.ancestors().find(|part| part.exists()).filter(|part| !part.is_dir()) {
            return Err(io::Error::new(NotADirectory, format!("{} is a file, and a folder is needed", file.display())));
        }
        std::fs::create_dir_all(folder)?;
        remove_left_overs(folder);
        temporary_in(folder)?.close()
    };
    attempt().map_err(|source| WriteError { path: folder.to_owned(), source })
}

/// Checks that `path` can be written: a file can be created in its folder, and it is not a folder. Removes the partial
/// files of killed runs there.
///
/// # Errors
/// [`WriteError`] with the reason.
pub fn prepare_file(path: &Path) -> Result<(), WriteError> {
    let attempt = || match std::fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => Err(IsADirectory.into()),
        Ok(metadata) if !metadata.is_file() => Ok(()),
        _ => {
            let folder = folder_of(path);
            if !folder.exists() {
                return Err(io::Error::new(NotADirectory, format!("the folder {} does not exist", folder.display())));
            }
            remove_left_overs(folder);
            temporary_in(folder)?.close()
        }
    };
    attempt().map_err(|source| WriteError { path: path.to_owned(), source })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Creates a temporary file that becomes a result: readable by others as far as the user's mask allows, which the
/// private files of `tempfile` are not by default.
fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    let (prefix, suffix, random) = TEMPORARY;
    builder.prefix(prefix).suffix(suffix).rand_bytes(random);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let made = builder.tempfile_in(folder).map_err(|error| {
        // `tempfile` adds the name of the temporary file, which means nothing to the user.
        let text = error.to_string();
        let reason = text.split_once(" at path ").map_or(text.as_str(), |(reason, _)| reason);
        io::Error::new(error.kind(), reason)
    })?;
    // The lock tells other runs that the file is being written; some file systems have no locks.
    let _ = made.as_file().try_lock();
    Ok(made)
}
