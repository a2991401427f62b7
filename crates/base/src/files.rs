//! Reading files, with a limit on the size of streams, and removing temporary ones.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Maximum number of bytes read from anything but a regular file, such as a pipe: 256 MiB. Regular files have no limit.
pub const MAX_STREAM_BYTES: u64 = 256 << 20;

/// Reads all bytes of the file at `path`; a pipe or a device such as `/dev/stdin` is read up to [`MAX_STREAM_BYTES`].
///
/// # Errors
/// The error of the operating system; [`ErrorKind::FileTooLarge`] for a stream that has more bytes, or no end.
pub fn read_whole(path: &Path) -> Result<Vec<u8>> {
    read_opened(&mut File::open(path)?)
}

/// Reads the file at `path` as [`read_whole`] does, as UTF-8 text.
///
/// # Errors
/// As for [`read_whole`], and [`ErrorKind::InvalidData`] if the bytes are not UTF-8.
pub fn read_text(path: &Path) -> Result<String> {
    String::from_utf8(read_whole(path)?).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|byte| **byte == b'\n').count();
        Error::new(ErrorKind::InvalidData, format!("line {line} is not text in UTF-8: save it as UTF-8"))
    })
}

/// Reads an open file from its current position to the end, with the limit of [`read_whole`].
///
/// # Errors
/// As for [`read_whole`].
pub fn read_opened(file: &mut File) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let about = file.metadata()?;
    if about.is_file() {
        let length = usize::try_from(about.len()).unwrap_or(usize::MAX);
        bytes.try_reserve_exact(length).map_err(|_| Error::from(ErrorKind::OutOfMemory))?;
        file.read_to_end(&mut bytes)?;
    } else {
        read_at_most(file, MAX_STREAM_BYTES, &mut bytes)?;
    }
    Ok(bytes)
}

/// Returns the path without links; for a missing file, that of its future folder. `None` if this is unknown.
pub fn real_path(path: &Path) -> Option<PathBuf> {
    if let Ok(real) = path.canonicalize() {
        return Some(real);
    }
    // A link to a missing file.
    if path.symlink_metadata().is_ok() {
        return None;
    }
    // Neither has a path that ends in "..".
    Some(real_path(path.parent()?)?.join(path.file_name()?))
}

fn read_at_most(reader: &mut impl Read, most: u64, bytes: &mut Vec<u8>) -> Result<()> {
    if reader.take(most + 1).read_to_end(bytes)? as u64 > most {
        let mebibytes = most >> 20;
        let message =
            format!("it is not a regular file and exceeds {mebibytes} MiB or has no end: save it to a file first");
        return Err(Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(())
}

/// Names of temporary files and folders: the first text, so many letters and digits, the last text. Those of the user
/// have other names.
pub const TEMPORARY: (&str, &str, usize) = (".apportion-", ".partial", 16);

/// Age from which an unlocked temporary file belongs to a killed run: a file is locked some microseconds after its
/// creation.
const ABANDONED: Duration = Duration::from_secs(1);

/// Removes the temporary files and folders in `folder` that no process has locked.
pub fn remove_left_overs(folder: &Path) {
    let (prefix, suffix, length) = TEMPORARY;
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let (name, path) = (entry.file_name(), entry.path());
        let random = name.to_str().and_then(|name| name.strip_prefix(prefix)?.strip_suffix(suffix));
        let age = entry.metadata().and_then(|about| about.modified()).ok().and_then(|time| time.elapsed().ok());
        if random.is_some_and(|random| random.len() == length && random.chars().all(|c| c.is_ascii_alphanumeric()))
            && age.is_some_and(|age| age >= ABANDONED)
            && File::open(&path).is_ok_and(|file| file.try_lock().is_ok())
        {
            let _ = std::fs::remove_file(&path).or_else(|_| std::fs::remove_dir_all(&path));
        }
    }
}

#[cfg(test)]
#[path = "tests/files.rs"]
mod tests;
