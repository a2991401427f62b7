//! Files that are either the old one or the new one, never half of one.

use std::io::Write;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file could not be written.
#[derive(Debug, Error)]
#[error("cannot write {path}: {source}", path = path.display())]
pub struct WriteError {
    /// The file or folder.
    pub path: PathBuf,
    /// What the operating system said.
    pub source: std::io::Error,
}

/// Writes `bytes` to `path`: into a temporary file in the same folder, synced, then renamed over the target.
///
/// A link is followed, so that it stays one; a file that exists keeps its permissions; and what is no file but a device
/// or a pipe is written to as it is, since nothing must take its place.
///
/// # Errors
/// [`WriteError`]; the target is then what it was before.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    stream_atomically(path, |file| file.write_all(bytes))
}

/// Like [`write_atomically`], for content that `write` produces piece by piece.
///
/// # Errors
/// [`WriteError`]; the target is then what it was before.
pub fn stream_atomically(
    path: &Path,
    write: impl FnOnce(&mut (dyn Write + Send)) -> std::io::Result<()>,
) -> Result<(), WriteError> {
    let attempt = || {
        let target = followed(path)?;
        let existing = std::fs::metadata(&target).ok();
        if existing.as_ref().is_some_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return write(&mut std::fs::OpenOptions::new().write(true).open(&target)?);
        }
        let mut file = temporary_in(folder_of(&target))?;
        write(file.as_file_mut())?;
        if let Some(metadata) = existing {
            file.as_file().set_permissions(metadata.permissions())?;
        }
        file.as_file().sync_all()?;
        file.persist(&target).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Makes the folder and checks that files can be created in it, so that a run fails in its first second and not in its
/// last.
///
/// # Errors
/// [`WriteError`] if the folder cannot be made or written to.
pub fn prepare_folder(folder: &Path) -> Result<(), WriteError> {
    let attempt = || {
        std::fs::create_dir_all(folder)?;
        temporary_in(folder)?.close()
    };
    attempt().map_err(|source| WriteError { path: folder.to_owned(), source })
}

/// Checks that `path` can be written: a file can be created beside it, its name is one the system takes, and it is no
/// folder.
///
/// # Errors
/// [`WriteError`] with the reason.
pub fn prepare_file(path: &Path) -> Result<(), WriteError> {
    if path.is_dir() {
        let source = std::io::Error::from(std::io::ErrorKind::IsADirectory);
        return Err(WriteError { path: path.to_owned(), source });
    }
    let attempt = || {
        let target = followed(path)?;
        match std::fs::metadata(&target) {
            Ok(metadata) if !metadata.is_file() => Ok(()),
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
            _ => temporary_in(folder_of(&target))?.close(),
        }
    };
    attempt().map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Where `path` leads: the end of a chain of links, or `path` itself.
fn followed(path: &Path) -> std::io::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&target) {
            Ok(link) => target = folder_of(&target).join(link),
            Err(_) => return Ok(target),
        }
    }
    Err(std::io::Error::other("too many links follow one another"))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file that becomes a result: readable by others as far as the user's mask allows, which the private
/// files of `tempfile` are not by default.
fn temporary_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".apportion-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(|error| {
        // `tempfile` adds the name of the temporary file, which the user has never heard of.
        let text = error.to_string();
        let reason = text.split_once(" at path ").map_or(text.as_str(), |(reason, _)| reason);
        std::io::Error::new(error.kind(), reason)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.json");
        write_atomically(&path, b"old").unwrap();
        let error = stream_atomically(&path, |file| {
            file.write_all(b"half of the ne")?;
            Err(std::io::Error::other("disk full"))
        });
        assert!(error.unwrap_err().to_string().ends_with("result.json: disk full"));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn folders_are_made_and_tried() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        prepare_folder(&deep).unwrap();
        assert_eq!(std::fs::read_dir(&deep).unwrap().count(), 0);
        write_atomically(&deep.join("f"), b"").unwrap();
        assert!(prepare_folder(&deep.join("f")).is_err());
        assert!(prepare_file(&deep).is_err());
        assert!(prepare_file(&deep.join("f")).is_ok());
        let nowhere = prepare_file(&folder.path().join("none/f")).unwrap_err().to_string();
        assert!(nowhere.ends_with("none/f: No such file or directory (os error 2)"), "{nowhere}");
        assert!(prepare_file(&folder.path().join("n".repeat(300))).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_files_keep_their_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        std::fs::write(&target, "old").unwrap();
        std::fs::set_permissions(&target, std::fs::Permissions::from_mode(0o600)).unwrap();
        symlink("target", &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&target).unwrap(), b"new");
        assert_eq!(std::fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o600);
        symlink("loop", folder.path().join("loop")).unwrap();
        assert!(write_atomically(&folder.path().join("loop"), b"").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_written_to_and_stays_a_pipe() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read(pipe).unwrap()
        });
        prepare_file(&pipe).unwrap();
        write_atomically(&pipe, b"through").unwrap();
        assert_eq!(reader.join().unwrap(), b"through");
        assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo());
    }
}
