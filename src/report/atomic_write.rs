//! Files that are either the old one or the new one, never half of one.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

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
        let (mut file, _known) = Unfinished::create(folder_of(&target))?;
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

/// Writes `bytes` to the file called `name` in `folder`, and gives its path.
///
/// # Errors
/// [`WriteError`] as for [`write_atomically`]; if `name` is that of a file elsewhere, or stands for something else than a
/// file.
#[cfg(feature = "page")]
pub(super) fn write_in(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, WriteError> {
    let path = path_in(folder, name)?;
    write_atomically(&path, bytes)?;
    Ok(path)
}

/// Checks that [`write_in`] can write the file called `name` in `folder`.
///
/// # Errors
/// [`WriteError`] with the reason.
#[cfg(feature = "page")]
pub(super) fn prepare_in(folder: &Path, name: &str) -> Result<(), WriteError> {
    prepare_file(&path_in(folder, name)?)
}

/// The path of the file called `name` in `folder`. Nothing is ever written outside of it, whatever the name; and nobody
/// has asked for a pipe or a device there, so it is refused: writing to it may wait forever.
#[cfg(feature = "page")]
fn path_in(folder: &Path, name: &str) -> Result<PathBuf, WriteError> {
    let path = folder.join(name);
    let refused = |why: &str| {
        let source = std::io::Error::new(std::io::ErrorKind::InvalidInput, why);
        Err(WriteError { path: path.clone(), source })
    };
    let mut parts = Path::new(name).components();
    if !matches!((parts.next(), parts.next()), (Some(std::path::Component::Normal(part)), None) if part == name) {
        return refused("the name leads out of the folder");
    }
    match std::fs::metadata(&path) {
        Ok(there) if !there.is_file() && !there.is_dir() => {
            refused("a pipe or a device is in the place of the file: remove it, or give another folder")
        }
        _ => Ok(path),
    }
}

/// Makes the folder and checks that files can be created in it, so that a run fails in its first second and not in its
/// last. What runs that were killed have left behind half written is removed.
///
/// # Errors
/// [`WriteError`] if the folder cannot be made or written to.
pub fn prepare_folder(folder: &Path) -> Result<(), WriteError> {
    let attempt = || {
        if let Some(file) = folder.ancestors().find(|part| part.exists()).filter(|part| !part.is_dir()) {
            return Err(no_folder(format!("{} is a file, and a folder is needed", file.display())));
        }
        std::fs::create_dir_all(folder)?;
        remove_left_overs(folder);
        temporary_in(folder)?.close()
    };
    attempt().map_err(|source| WriteError { path: folder.to_owned(), source })
}

/// Checks that `path` can be written: a file can be created beside it, its name is one the system takes, and it is no
/// folder. What runs that were killed have left behind half written is removed.
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
        let folder = folder_of(&target);
        if !folder.exists() {
            return Err(no_folder(format!("the folder {} does not exist", folder.display())));
        }
        match std::fs::metadata(&target) {
            Ok(metadata) if !metadata.is_file() => Ok(()),
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
            _ => {
                remove_left_overs(folder);
                temporary_in(folder)?.close()
            }
        }
    };
    attempt().map_err(|source| WriteError { path: path.to_owned(), source })
}

/// What the user has named as a folder, or as one of a file, is none.
fn no_folder(why: String) -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::NotADirectory, why)
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

/// What the names of temporary files begin with.
const TEMPORARY: &str = ".apportion-";

/// A file that has been left alone for so long, and is not locked, is nobody's: between its birth and its lock lie some
/// microseconds.
const ABANDONED: Duration = Duration::from_secs(1);

/// Removes the temporary files in `folder` of runs that were killed; those that are being written are locked. What cannot
/// be looked at or removed stays.
fn remove_left_overs(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_one = entry.file_name().to_str().is_some_and(|name| name.starts_with(TEMPORARY));
        if !is_one || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let Ok(file) = std::fs::File::open(entry.path()) else { continue };
        let age = file.metadata().and_then(|about| about.modified()).ok().and_then(|time| time.elapsed().ok());
        if age.is_some_and(|age| age >= ABANDONED) && file.try_lock().is_ok() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// The temporary files of this process that are being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the files that are being written and are not whole yet: for a process that is about to end at once. No other can be
/// begun after that: the threads that would write them wait for the end.
pub fn remove_unfinished() {
    let Ok(files) = UNFINISHED.lock() else { return };
    for file in &*files {
        // It may have become a result in the meantime.
        let _ = std::fs::remove_file(file);
    }
    std::mem::forget(files);
}

/// A file noted as being written, as long as this lives.
struct Unfinished(PathBuf);

impl Unfinished {
    /// A new file in `folder`, and the note of it: both or none for [`remove_unfinished`].
    fn create(folder: &Path) -> std::io::Result<(tempfile::NamedTempFile, Self)> {
        let mut files = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        let file = temporary_in(folder)?;
        files.push(file.path().to_owned());
        let noted = Self(file.path().to_owned());
        Ok((file, noted))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Ok(mut files) = UNFINISHED.lock() {
            files.retain(|file| *file != self.0);
        }
    }
}

/// A temporary file that becomes a result: readable by others as far as the user's mask allows, which the private
/// files of `tempfile` are not by default.
fn temporary_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let made = builder.tempfile_in(folder).map_err(|error| {
        // `tempfile` adds the name of the temporary file, which the user has never heard of.
        let text = error.to_string();
        let reason = text.split_once(" at path ").map_or(text.as_str(), |(reason, _)| reason);
        std::io::Error::new(error.kind(), reason)
    })?;
    // Says to other runs that it is being written; a file system without locks has none to say it with.
    let _ = made.as_file().try_lock();
    Ok(made)
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
        let file = prepare_folder(&deep.join("f/g")).unwrap_err().to_string();
        assert!(file.ends_with("a/b/f is a file, and a folder is needed"), "{file}");
        assert!(prepare_file(&deep).is_err());
        assert!(prepare_file(&deep.join("f")).is_ok());
        let nowhere = prepare_file(&folder.path().join("none/f")).unwrap_err().to_string();
        assert!(nowhere.contains("none/f: the folder ") && nowhere.ends_with("none does not exist"), "{nowhere}");
        assert!(prepare_file(&folder.path().join("n".repeat(300))).is_err());
    }

    #[test]
    fn no_name_leads_out_of_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        prepare_folder(&inner).unwrap();
        for name in ["../evil", "a/../../evil", "/tmp/evil", "..", ".", "", "a/", "a/b", "./a"] {
            let error = write_in(&inner, name, b"evil").unwrap_err().to_string();
            assert!(error.ends_with("the name leads out of the folder"), "{name:?}: {error}");
            assert!(prepare_in(&inner, name).is_err());
        }
        assert_eq!(write_in(&inner, "..a", b"x").unwrap(), inner.join("..a"));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn files_of_runs_that_were_killed_are_removed_and_those_being_written_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let old = |name: &str| {
            let file = std::fs::File::create(folder.path().join(name)).unwrap();
            file.set_modified(std::time::SystemTime::now() - Duration::from_secs(60)).unwrap();
            file
        };
        let being_written = old(".apportion-aaaaaa");
        being_written.lock().unwrap();
        drop((old(".apportion-bbbbbb"), old("apportion-c"), old(".apportion")));
        std::fs::write(folder.path().join(".apportion-young"), "").unwrap();
        prepare_folder(folder.path()).unwrap();
        let mut left: Vec<String> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        left.sort();
        assert_eq!(left, [".apportion", ".apportion-aaaaaa", ".apportion-young", "apportion-c"]);
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
        // Where nobody has named it, it is in the way.
        let refused = prepare_in(folder.path(), "pipe").unwrap_err().to_string();
        assert!(refused.contains("a pipe or a device is in the place of the file"), "{refused}");
        assert!(write_in(folder.path(), "pipe", b"").is_err());
    }
}
